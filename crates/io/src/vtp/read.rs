//! The arrays of a .vtp file, in one pass over a file or a pipe.

use std::io::{BufRead, Read};

use quick_xml::Reader as XmlReader;
use quick_xml::events::{BytesStart, Event};

use super::arrays::Arrays;
use super::decode::{
    DAMAGED, Scalar, Values, array_bytes, base64_array, skip, truncated, unreadable,
};
use super::guard::Guarded;
use super::header::{Declared, Encoding, Format, Wanted, attribute, damaged, not_vtp};
use super::shape::{Counts, most_values};
use crate::diagnostic::{Diagnostic, Result};

/// A .vtp file whose header has been read.
pub struct Reader<'a> {
    input: &'a mut dyn BufRead,
    file: File<'a>,
    encoding: Appended,
}

impl<'a> Reader<'a> {
    /// Reads the header, with the fields and arrays that stand in it. `wanted` gives the shapes of
    /// the arrays that are used, by their sections and names.
    ///
    /// # Errors
    /// Damaged or cut off, compressed, wrong counts.
    pub fn open(input: &'a mut dyn BufRead, wanted: Wanted<'a>) -> Result<Self> {
        let mut file = File {
            wanted,
            encoding: None,
            arrays: Arrays::default(),
            appended: Vec::new(),
        };
        let mut xml = XmlReader::from_reader(Guarded::new(input));
        let encoding = read_xml(&mut xml, &mut file)?;
        Ok(Self {
            input: xml.into_inner().into_input(),
            file,
            encoding,
        })
    }

    /// What was read so far.
    pub fn arrays(&self) -> &Arrays {
        &self.file.arrays
    }

    /// Reads the file to its end.
    ///
    /// # Errors
    /// As [`Reader::open`].
    pub fn read(mut self) -> Result<Arrays> {
        match self.encoding {
            Appended::None => {}
            Appended::Raw => {
                read_raw(self.input, &mut self.file)?;
                check_raw_end(self.input)?;
            }
            Appended::Base64 => read_base64(self.input, &mut self.file)?,
        }
        Ok(self.file.arrays)
    }

    /// As [`Reader::read`], of a file as this program writes it, up to the last array that is used.
    ///
    /// # Errors
    /// As [`Reader::open`]; another encoding.
    pub fn read_used(mut self) -> Result<Arrays> {
        self.file.leave_out_last_unused();
        match self.encoding {
            Appended::Raw if self.file.appended.is_empty() => Ok(self.file.arrays),
            Appended::Raw => {
                read_raw(self.input, &mut self.file)?;
                Ok(self.file.arrays)
            }
            Appended::None | Appended::Base64 => self.read(),
        }
    }
}

/// The data after the XML header.
enum Appended {
    None,
    Raw,
    Base64,
}

/// What was read so far.
struct File<'a> {
    wanted: Wanted<'a>,
    encoding: Option<Encoding>,
    arrays: Arrays,
    /// Arrays whose values follow later, with their offset in the appended data.
    appended: Vec<(u64, Declared)>,
}

/// Reads the XML up to the appended data, or to its end if there are none.
fn read_xml(xml: &mut XmlReader<Guarded<'_>>, file: &mut File<'_>) -> Result<Appended> {
    let mut buffer = Vec::new();
    let mut open: Vec<String> = Vec::new();
    // The open array, and its text so far.
    let mut array: Option<(Declared, String)> = None;
    loop {
        buffer.clear();
        let event = xml
            .read_event_into(&mut buffer)
            .map_err(|error| match &error {
                quick_xml::Error::Io(error) => unreadable(error),
                _ if file.encoding.is_none() => not_vtp(),
                quick_xml::Error::Syntax(_) => truncated(),
                error => damaged(error),
            })?;
        match event {
            Event::Start(element) if element.name().as_ref() == "AppendedData" => {
                return match attribute(&element, "encoding")?.as_deref() {
                    Some("raw") => Ok(Appended::Raw),
                    Some("base64") => Ok(Appended::Base64),
                    _ => Err(Diagnostic::input(
                        "",
                        "the appended data have an unknown encoding",
                        DAMAGED,
                    )),
                };
            }
            Event::Start(element) => {
                let declared = file.element(&element, open.last())?;
                xml.get_mut().begin();
                if let Some(declared) = declared {
                    let most = file.most_values(&declared);
                    let is_decimal = declared.format == Format::Ascii;
                    xml.get_mut().expect_values(most, is_decimal);
                    array = Some((declared, String::new()));
                }
                open.push(element.name().as_ref().to_owned());
            }
            Event::Empty(element) => {
                if let Some(declared) = file.element(&element, open.last())? {
                    file.declared(declared, "")?;
                }
            }
            Event::Text(text) => {
                if let Some((_, values)) = &mut array
                    && open.last().is_some_and(|name| is_array(name))
                {
                    values.push_str(&text);
                }
            }
            Event::End(element) => {
                open.pop();
                if is_array(element.name().as_ref())
                    && let Some((declared, values)) = array.take()
                {
                    file.declared(declared, &values)?;
                }
                if open.is_empty() {
                    return Ok(Appended::None);
                }
            }
            Event::Eof => {
                return Err(if file.encoding.is_some() {
                    truncated()
                } else {
                    not_vtp()
                });
            }
            _ => {}
        }
        let in_values = array.is_some() && open.last().is_some_and(|name| is_array(name));
        xml.get_mut().set_in_values(in_values);
    }
}

fn is_array(element: &str) -> bool {
    matches!(element, "DataArray" | "Array")
}

impl File<'_> {
    /// Processes an element that begins inside `section`. If it is an array, it is returned.
    fn element(
        &mut self,
        element: &BytesStart<'_>,
        section: Option<&String>,
    ) -> Result<Option<Declared>> {
        let name = element.name();
        let name = name.as_ref();
        if name == "VTKFile" {
            self.encoding = Some(Encoding::declared(element)?);
        }
        let encoding = self.encoding.ok_or_else(not_vtp)?;
        if name == "Piece" {
            let counts = Counts::declared(element)?;
            if self.arrays.counts.replace(counts).is_some() {
                return Err(Diagnostic::input(
                    "",
                    "the body is in several pieces",
                    "save it as one piece",
                ));
            }
        }
        if !is_array(name) {
            return Ok(None);
        }
        let section = section.map_or("", String::as_str);
        let array = Declared::of(element, section, self.wanted)?;
        encoding.check(&array)?;
        if section == "PointData" {
            self.arrays.point_data.push(array.name.clone());
        }
        Ok(Some(array))
    }

    /// Processes an array whose values are `text`, or records where they will follow.
    fn declared(&mut self, array: Declared, text: &str) -> Result<()> {
        match array.format {
            Format::Ascii => self.arrays.fill(&array, Values::Text(text)),
            Format::Base64 => self.fill_base64(&array, text.as_bytes()),
            Format::Appended(offset) => {
                self.appended.push((offset, array));
                Ok(())
            }
        }
    }

    fn fill_base64(&mut self, array: &Declared, text: &[u8]) -> Result<()> {
        if array.shape.is_none() {
            return Ok(());
        }
        let bytes = base64_array(text, self.header_bytes()).map_err(|error| array.within(error))?;
        self.arrays.fill(
            array,
            Values::Bytes(&mut bytes.as_slice(), bytes.len() as u64),
        )
    }

    /// Largest number of bytes of an array.
    fn most_bytes(&self, array: &Declared) -> u64 {
        let of_value = array.scalar().map_or(8, Scalar::bytes);
        self.most_values(array).saturating_mul(of_value as u64)
    }

    fn most_values(&self, array: &Declared) -> u64 {
        most_values(array.shape, &self.arrays.counts())
    }

    /// Checks that an array can have this number of bytes.
    fn check_size(&self, array: &Declared, bytes: u64) -> Result<()> {
        let most = self.most_bytes(array);
        if bytes <= most {
            return Ok(());
        }
        let problem = format!("{bytes} bytes, but the header says {most}");
        Err(Diagnostic::input("", problem, DAMAGED))
    }

    fn header_bytes(&self) -> usize {
        self.encoding.map_or(8, |encoding| encoding.header_bytes)
    }

    /// Leaves out the arrays behind the last one that is used.
    fn leave_out_last_unused(&mut self) {
        let used = self
            .appended
            .iter()
            .filter(|(_, array)| array.shape.is_some());
        let last = used.map(|(offset, _)| *offset).max();
        self.appended.retain(|(offset, _)| Some(*offset) <= last);
    }

    /// The arrays of the appended data, in their order.
    fn take_appended(&mut self) -> Vec<(u64, Declared)> {
        let mut appended = std::mem::take(&mut self.appended);
        appended.sort_by_key(|(offset, _)| *offset);
        appended
    }
}

fn read_raw(input: &mut dyn BufRead, file: &mut File<'_>) -> Result<()> {
    to_appended_data(input)?;
    let mut at = 0_u64;
    for (offset, array) in file.take_appended() {
        let gap = offset.checked_sub(at).ok_or_else(|| {
            Diagnostic::input(
                "",
                format!("array '{}' begins inside another one", array.name),
                DAMAGED,
            )
        })?;
        skip(input, gap)?;
        let bytes = array_bytes(input, file.header_bytes()).map_err(|error| array.within(error))?;
        file.check_size(&array, bytes)
            .map_err(|error| array.within(error))?;
        if array.shape.is_none() {
            skip(input, bytes)?;
        } else {
            file.arrays.fill(&array, Values::Bytes(input, bytes))?;
        }
        at = offset
            .saturating_add(file.header_bytes() as u64)
            .saturating_add(bytes);
    }
    Ok(())
}

fn check_raw_end(input: &mut dyn BufRead) -> Result<()> {
    let mut end = Vec::new();
    input
        .take(1 << 16)
        .read_to_end(&mut end)
        .map_err(|error| unreadable(&error))?;
    check_end(&end)
}

fn read_base64(input: &mut dyn BufRead, file: &mut File<'_>) -> Result<()> {
    to_appended_data(input)?;
    let mut text = Vec::new();
    let arrays = file.appended.iter();
    let most = arrays.fold(1 << 16, |sum: u64, (_, array)| {
        sum.saturating_add(file.most_bytes(array).saturating_mul(2))
    });
    Read::take(&mut *input, most)
        .read_until(b'<', &mut text)
        .map_err(|error| unreadable(&error))?;
    if !text.ends_with(b"<") {
        return Err(truncated());
    }
    let end = text.len() - 1;
    Read::take(&mut *input, 1 << 16)
        .read_to_end(&mut text)
        .map_err(|error| unreadable(&error))?;
    check_end(&text[end..])?;
    for (offset, array) in file.take_appended() {
        let start = usize::try_from(offset).unwrap_or(end).min(end);
        file.fill_base64(&array, &text[start..end])?;
    }
    Ok(())
}

/// Reads up to the underscore before the appended data.
fn to_appended_data(input: &mut dyn BufRead) -> Result<()> {
    loop {
        let mut byte = [0];
        input
            .read_exact(&mut byte)
            .map_err(|error| unreadable(&error))?;
        match byte[0] {
            b'_' => return Ok(()),
            white if white.is_ascii_whitespace() => {}
            _ => {
                return Err(Diagnostic::input(
                    "",
                    "the appended data do not begin with '_'",
                    DAMAGED,
                ));
            }
        }
    }
}

/// The elements that are open at the appended data must be closed: at the latest, a truncated file
/// is detected here.
fn check_end(end: &[u8]) -> Result<()> {
    let closed = String::from_utf8_lossy(end)
        .split_ascii_whitespace()
        .collect::<String>();
    if closed.starts_with("</AppendedData></VTKFile>") {
        Ok(())
    } else {
        Err(truncated())
    }
}
