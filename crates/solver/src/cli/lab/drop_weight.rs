//! `dem-run lab --type drop-weight`: sheets of drop-weight tests to the law of breakage of an ore.

use std::path::{Path, PathBuf};

use dem_io::safe_write::write_file;
use dem_io::text::{counted, visible};
use dem_io::write_target::refuse_to_replace;
use dem_io::{Diagnostic, Result};
use dem_laboratory::drop_weight::{
    DropWeightSheets, FittedOre, fit_ore, ore_numbers, ore_page, ore_text, read_sheets,
};
use dem_terminal::program::today;
use dem_terminal::standard_output::{write_standard_json, write_standard_output};
use serde_json::json;

/// The type of these tests.
pub(super) const TYPE: &str = "drop-weight";

/// Sheets to read, and what to write.
pub(super) struct OreTask<'a> {
    pub(super) files: &'a [PathBuf],
    /// Name of the material. None: that of the output.
    pub(super) material: Option<&'a str>,
    pub(super) output: &'a Path,
    pub(super) page_file: &'a Path,
    pub(super) json: bool,
    pub(super) quiet: bool,
}

/// Reads the sheets, fits the law, writes the file that scenes include and its page, and prints a
/// summary.
pub(super) fn ore(task: &OreTask<'_>) -> Result<()> {
    let written = [task.output, task.page_file];
    refuse_to_replace(&written.map(Path::to_owned), task.files)?;
    let material = task.material()?;
    let sheets = read_sheets(task.files)?;
    let ore = fit_ore(&sheets)?;
    let program = format!("dem-run {}", env!("CARGO_PKG_VERSION"));
    let text = ore_text(&ore, &sheets, [&today(), &program], &material);
    let page = ore_page(&ore, &sheets, &material);
    write_file(task.page_file, |out| out.write_all(page.as_bytes()))?;
    write_file(task.output, |out| out.write_all(text.as_bytes()))?;
    if task.json {
        write_standard_json(&json!({ "material": material, "ore": ore, "notes": sheets.notes }))
    } else if task.quiet {
        Ok(())
    } else {
        print(&ore, &sheets, written)
    }
}

impl OreTask<'_> {
    /// The name of the material, which is a key of TOML.
    fn material(&self) -> Result<String> {
        let stem = self
            .output
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy();
        let material = self.material.unwrap_or(&stem);
        let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
        if material.is_empty() || !material.chars().all(is_plain) {
            let problem = format!(
                "'{}' is not the name of a material",
                material.escape_debug()
            );
            let remedy = "use letters, digits, - and _, such as --material ore";
            return Err(Diagnostic::input("--material", problem, remedy));
        }
        Ok(material.to_owned())
    }
}

fn print(ore: &FittedOre, sheets: &DropWeightSheets, written: [&Path; 2]) -> Result<()> {
    write_standard_output(|out| {
        let mut line = |name: &str, text: &str| writeln!(out, "{name:15}  {}", visible(text));
        for note in &sheets.notes {
            line("note", note)?;
        }
        for doubt in &ore.doubts {
            line("doubt", doubt)?;
        }
        let [rows, sizes] = [(ore.tests, "row"), (ore.by_size.len(), "size")]
            .map(|(count, what)| counted(count, what));
        line("tests", &format!("{rows} with a t10, {sizes}"))?;
        for one in ore_numbers(ore) {
            line(
                one.name,
                &format!("{:14}  95 %: {}", one.value, one.interval),
            )?;
        }
        let points = 100.0 * ore.rms;
        line(
            "residual",
            &format!("{points:.1} points of t10, root mean square"),
        )?;
        let [output, page] = written.map(|path| path.display().to_string());
        line("written", &format!("{output}, {page}"))
    })
}
