//! What the tests of the verification pages take.

use std::collections::BTreeMap;
use std::process::Command;

use serde_json::{Value, json};

use crate::bench::{Bench, Failed, keep, read, root};

const FILE: &str = "tests/verification/board-times.json";

/// The name of the processor, where the system tells it.
pub(crate) fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text
        .lines()
        .find_map(|line| line.strip_prefix("model name"));
    let name = name.and_then(|rest| rest.split_once(':'));
    name.map_or_else(
        || std::env::consts::ARCH.to_owned(),
        |(_, name)| name.trim().to_owned(),
    )
}

/// The verification pages that tests write, by the module of their tests.
pub(super) fn pages() -> Result<Vec<String>, Failed> {
    let mut pages = Vec::new();
    for entry in std::fs::read_dir(root().join("tests/tests/verification"))? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        pages.extend(name.strip_suffix(".md").map(str::to_owned));
    }
    pages.sort();
    Ok(pages)
}

/// Seconds of the test of a page, on one thread.
fn seconds(page: &str) -> Result<f64, Failed> {
    let module = format!("verification::{}", page.replace('-', "_"));
    let mut command = Command::new("cargo");
    command.args([
        "test",
        "--locked",
        "-p",
        "dem-tests",
        "--test",
        "main",
        "--",
    ]);
    let said = command.arg(&module).current_dir(root()).output()?;
    if !said.status.success() {
        return Err(String::from_utf8_lossy(&said.stdout).into());
    }
    let text = String::from_utf8_lossy(&said.stdout).into_owned();
    let after = text.split("finished in ").nth(1);
    let seconds = after.and_then(|rest| rest.split('s').next()?.parse().ok());
    seconds.ok_or_else(|| format!("{module}: no time in {text}").into())
}

pub(crate) fn measure(_: &Bench) -> Result<(), Failed> {
    let mut times = BTreeMap::new();
    for page in pages()? {
        times.insert(page.clone(), seconds(&page)?);
    }
    let file = root().join(FILE);
    keep(
        &file,
        &json!({ "processor": processor(), "seconds": times }),
    )
}

/// The processor and the time of a page's test.
pub(super) fn of(page: &str) -> [String; 2] {
    let stored = read(&root().join(FILE)).unwrap_or(Value::Null);
    let processor = stored["processor"].as_str().unwrap_or_default();
    let seconds = stored["seconds"][page].as_f64();
    let seconds = seconds.map_or(String::new(), |seconds| {
        format!("{seconds:.1} s, all of the page")
    });
    [processor.to_owned(), seconds]
}
