//! A body from a .vtp file, in one pass over a file or a pipe.

use std::io::{BufRead, Read};

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::contents::Contents;
use super::decode::{
    DAMAGED, Scalar, Values, array_bytes, base64_array, skip, truncated, unreadable,
};
use super::guard::Guarded;
use super::header::{Array, Counts, Encoding, Format, Layout, Role, attribute, damaged, not_vtp};
use crate::body::parts::Body;
use crate::body::stored_frame::StoredFrame;
use crate::body::stored_particles::StoredParticles;
use crate::body::stored_walls::StoredWalls;
use crate::diagnostic::{Diagnostic, Result};

/// Reads a body from a .vtp file, which ends with the input.
///
/// Files of other programs are read too, in any uncompressed encoding, if each line has two points
/// and there is point data `radius`. Without cell data `bond_radius` a bond has the radius of the
/// smaller of its particles; without `bond_initial_length` their distance as its length. Other
/// arrays are ignored.
///
/// # Errors
/// Damaged or cut off, a later version, compressed, wrong counts, or not a body by [`Body::check`].
pub fn read(input: &mut dyn BufRead) -> Result<Body> {
    contents(input, Layout::Body)?.into_body()
}

/// Reads the fragments of a frame of a run.
pub(crate) fn read_frame(input: &mut dyn BufRead) -> Result<StoredFrame> {
    contents(input, Layout::Frame)?.into_frame()
}

/// Reads the particles and bonds of a frame of any run.
pub(crate) fn read_particles(input: &mut dyn BufRead) -> Result<StoredParticles> {
    contents(input, Layout::Frame)?.into_particles()
}

/// Reads the walls of a frame of a run.
pub(crate) fn read_walls(input: &mut dyn BufRead) -> Result<StoredWalls> {
    contents(input, Layout::Walls)?.into_walls()
}

fn contents(input: &mut dyn BufRead, layout: Layout) -> Result<Contents> {
    let mut file = File {
        layout,
        ..File::default()
    };
    let mut xml = Reader::from_reader(Guarded::new(input));
    match read_xml(&mut xml, &mut file)? {
        Appended::None => {}
        Appended::Raw => read_raw(xml.into_inner().into_input(), &mut file)?,
        Appended::Base64 => read_base64(xml.into_inner().into_input(), &mut file)?,
    }
    Ok(file.contents)
}

/// The data after the XML header.
enum Appended {
    None,
    Raw,
    Base64,
}

/// The contents read so far.
#[derive(Default)]
struct File {
    layout: Layout,
    encoding: Option<Encoding>,
    contents: Contents,
    /// Arrays whose values follow later, with their offset in the appended data.
    appended: Vec<(u64, Array)>,
}

/// Reads the XML up to the appended data, or to its end if there are none.
fn read_xml(xml: &mut Reader<Guarded<'_>>, file: &mut File) -> Result<Appended> {
    let mut buffer = Vec::new();
    let mut open: Vec<String> = Vec::new();
    // The open array, and its text so far.
    let mut array: Option<(Array, String)> = None;
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
                    let most = file.contents.most_values(declared.role);
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

impl File {
    /// Processes an element that begins inside `section`. If it is an array, it is returned.
    fn element(
        &mut self,
        element: &BytesStart<'_>,
        section: Option<&String>,
    ) -> Result<Option<Array>> {
        let name = element.name();
        let name = name.as_ref();
        if name == "VTKFile" {
            self.encoding = Some(Encoding::declared(element)?);
        }
        let encoding = self.encoding.ok_or_else(not_vtp)?;
        if name == "Piece" {
            self.contents.set_counts(Counts::declared(element)?)?;
        }
        if !is_array(name) {
            return Ok(None);
        }
        let section = section.map_or("", String::as_str);
        let array = Array::declared(element, section, self.layout)?;
        encoding.check(&array)?;
        if section == "PointData" {
            self.contents.add_point_data(&array.name);
        }
        Ok(Some(array))
    }

    /// Processes an array whose values are `text`, or records where they will follow.
    fn declared(&mut self, array: Array, text: &str) -> Result<()> {
        match array.format {
            Format::Ascii => self.contents.fill(&array, Values::Text(text)),
            Format::Base64 => self.fill_base64(&array, text.as_bytes()),
            Format::Appended(offset) => {
                self.appended.push((offset, array));
                Ok(())
            }
        }
    }

    fn fill_base64(&mut self, array: &Array, text: &[u8]) -> Result<()> {
        if array.role == Role::Other {
            return Ok(());
        }
        let bytes = base64_array(text, self.header_bytes()).map_err(|error| array.within(error))?;
        self.contents.fill(
            array,
            Values::Bytes(&mut bytes.as_slice(), bytes.len() as u64),
        )
    }

    /// Largest number of bytes of an array.
    fn most_bytes(&self, array: &Array) -> u64 {
        let of_value = array.scalar().map_or(8, Scalar::bytes);
        let most = self.contents.most_values(array.role);
        most.saturating_mul(of_value as u64)
    }

    /// Checks that an array can have this number of bytes.
    fn check_size(&self, array: &Array, bytes: u64) -> Result<()> {
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

    /// The arrays of the appended data, in their order.
    fn take_appended(&mut self) -> Vec<(u64, Array)> {
        let mut appended = std::mem::take(&mut self.appended);
        appended.sort_by_key(|(offset, _)| *offset);
        appended
    }
}

fn read_raw(input: &mut dyn BufRead, file: &mut File) -> Result<()> {
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
        if array.role == Role::Other {
            skip(input, bytes)?;
        } else {
            file.contents.fill(&array, Values::Bytes(input, bytes))?;
        }
        at = offset
            .saturating_add(file.header_bytes() as u64)
            .saturating_add(bytes);
    }
    let mut end = Vec::new();
    input
        .take(1 << 16)
        .read_to_end(&mut end)
        .map_err(|error| unreadable(&error))?;
    check_end(&end)
}

fn read_base64(input: &mut dyn BufRead, file: &mut File) -> Result<()> {
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
