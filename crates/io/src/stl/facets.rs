//! The facets of a file, and definitions shared by its readers.

/// The remedy for a file that lost bytes.
pub(crate) const REMEDY_AGAIN: &str = "export or copy the file again";
/// The remedy for a file with a wrong value.
pub(crate) const REMEDY_REPAIR: &str = "repair or export the shape again";
/// The remedy for a file that is not truncated but of another type.
pub(crate) const REMEDY_OTHER: &str = "give an STL, OBJ, PLY or 3MF file";

/// The facets of a file, unchanged.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Facets {
    /// Three corners each, in units of the file; all finite. Normals are not kept: the order of the
    /// corners is more reliable.
    pub corners: Vec<[[f64; 3]; 3]>,
    /// Metres in one unit of the file, if it says so itself.
    pub unit_m: Option<f64>,
    /// One sentence for each harmless oddity of the file.
    pub warnings: Vec<String>,
}

/// White space, with the vertical tab.
pub(super) fn is_blank(byte: u8) -> bool {
    byte.is_ascii_whitespace() || byte == 0x0b
}
