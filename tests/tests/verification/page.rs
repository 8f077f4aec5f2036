//! Pages in `tests/verification`: a text with placeholders for tables, compared with the computed
//! values.

use std::fs;

use dem_testing::names_in;

use crate::root;

/// Inserts tables at their placeholders: `{name}`.
pub(crate) fn filled(text: &str, tables: &[(&str, String)]) -> String {
    let mut page = text.to_owned();
    for (name, table) in tables {
        let place = format!("{{{name}}}");
        assert!(page.contains(&place), "{place} has no place in the page");
        page = page.replace(&place, table.trim_end());
    }
    page
}

/// Compares files of `tests/verification`, names and contents, with the existing ones; with
/// `RENEW_VERIFICATION` set, writes them instead.
pub(crate) fn assert_shown(files: &[(String, String)]) {
    let folder = root().join("tests/verification");
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

/// Runs `work` on one worker thread: scenes here are too small for more, and handing each step to
/// another thread takes longer than the step.
pub(crate) fn on_one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(work)
}

/// Every page is linked from README.md next to it, and every DOI on it is in doc/references.md.
#[test]
fn pages_are_listed_and_so_are_their_sources() {
    let folder = root().join("tests/verification");
    let index = fs::read_to_string(folder.join("README.md")).unwrap();
    let sources = fs::read_to_string(root().join("doc/references.md")).unwrap();
    let names = names_in(&folder);
    let pages = names
        .iter()
        .filter(|name| name.ends_with(".md") && *name != "README.md");
    for name in pages {
        assert!(
            index.contains(&format!("]({name})")),
            "{name} is not in README.md"
        );
        let page = fs::read_to_string(folder.join(name)).unwrap();
        for after in page.split("](https://doi.org/").skip(1) {
            let doi = after.split(')').next().unwrap();
            assert!(
                sources.contains(doi),
                "{name}: {doi} is not in doc/references.md"
            );
        }
    }
}
