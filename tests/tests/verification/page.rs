//! Pages in `tests/verification`: a text with places for tables, held against what is computed.

use std::fs;
use std::path::Path;

/// Puts tables where a text names them: `{name}`.
pub(crate) fn filled(text: &str, tables: &[(&str, String)]) -> String {
    let mut page = text.to_owned();
    for (name, table) in tables {
        let place = format!("{{{name}}}");
        assert!(page.contains(&place), "{place} has no place in the page");
        page = page.replace(&place, table.trim_end());
    }
    page
}

/// Holds files of `tests/verification`, names and contents, against those that are there; with
/// `RENEW_VERIFICATION` set, writes them instead.
pub(crate) fn assert_shown(files: &[(String, String)]) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("verification");
    let renew = std::env::var_os("RENEW_VERIFICATION").is_some();
    let mut old = Vec::new();
    for (name, content) in files {
        let path = folder.join(name);
        if fs::read_to_string(&path).is_ok_and(|is| is == *content) {
            continue;
        }
        if renew {
            fs::write(&path, content).unwrap();
        } else {
            old.push(name.as_str());
        }
    }
    assert!(
        old.is_empty(),
        "tests/verification: {} no longer shows what is computed. If the change is meant, renew the pages, look at them and commit them:\n\
         RENEW_VERIFICATION=1 cargo test --locked -p dem-tests --test main verification",
        old.join(", ")
    );
}

/// On one worker thread: scenes here are too small for more, and handing each step to another
/// thread takes longer than the step.
pub(crate) fn on_one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(work)
}
