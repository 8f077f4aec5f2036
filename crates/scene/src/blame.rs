//! Which of several values that override a scene's is the one that an error is about.

use dem_io::diagnostic::Diagnostic;

/// The first of `count` values without which there is no error, or another one. None: the error is
/// there without any of them. `said`: the error with the first so many values.
pub(super) fn guilty(
    error: &Diagnostic,
    count: usize,
    said: &dyn Fn(usize) -> Option<Diagnostic>,
) -> Option<usize> {
    if said(0).as_ref() == Some(error) {
        return None;
    }
    (0..count).find(|&at| {
        said(at + 1).is_some_and(|now| now == *error) && said(at).is_none_or(|was| was != *error)
    })
}
