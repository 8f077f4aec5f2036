//! Words of text files.

/// A finite number, also with the exponent of Fortran: 1.5D+02.
///
/// # Errors
/// What is wrong with the word.
pub(crate) fn finite(word: &[u8]) -> Result<f64, String> {
    let text = std::str::from_utf8(word).unwrap_or("");
    let parsed = text.parse().ok();
    let value = parsed.or_else(|| text.replacen(['d', 'D'], "e", 1).parse().ok());
    match value {
        Some(value) if f64::is_finite(value) => Ok(value),
        Some(_) => Err(format!(
            "coordinate '{}' is not a finite number",
            shown(word)
        )),
        None => Err(format!("coordinate '{}' is not a number", shown(word))),
    }
}

/// A word for a message: cut short, control characters escaped.
pub(crate) fn shown(word: &[u8]) -> String {
    String::from_utf8_lossy(&word[..word.len().min(30)])
        .escape_debug()
        .collect()
}
