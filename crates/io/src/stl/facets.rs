//! The facets of a file, and definitions shared by its two forms.

/// The remedy for a file that lost bytes.
pub(super) const REMEDY_AGAIN: &str = "export or copy the file again";

/// The facets of an STL file, unchanged.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Facets {
    /// Three corners each, in units of the file; all finite. Normals are not kept: the order of the
    /// corners is more reliable.
    pub corners: Vec<[[f64; 3]; 3]>,
    /// One sentence for each harmless oddity of the file.
    pub warnings: Vec<String>,
}

/// White space, with the vertical tab.
pub(super) fn is_blank(byte: u8) -> bool {
    byte.is_ascii_whitespace() || byte == 0x0b
}
