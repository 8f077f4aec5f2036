//! Tables that a test computes and a page shows.

use std::path::Path;

/// Compares a table with what a page has between two markers; with `RENEW_VERIFICATION` set, writes
/// it there instead.
///
/// # Panics
/// They differ, or the page does not have the markers.
pub fn hold_table(page: &Path, [begin, end]: [&str; 2], table: &str) {
    let text = std::fs::read_to_string(page).unwrap();
    let (before, rest) = text.split_once(begin).unwrap();
    let (written, after) = rest.split_once(end).unwrap();
    if std::env::var_os("RENEW_VERIFICATION").is_some() {
        std::fs::write(page, format!("{before}{begin}{table}{end}{after}")).unwrap();
    } else {
        assert_eq!(written, table, "RENEW_VERIFICATION=1 writes it");
    }
}
