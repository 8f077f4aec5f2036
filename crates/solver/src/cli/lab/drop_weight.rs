//! `dem-run lab --type drop-weight`: sheets of drop-weight tests to the law of breakage of an ore.

use std::path::Path;

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

use super::{LabArguments, page_file};

/// The type of these tests.
pub(super) const TYPE: &str = "drop-weight";

/// Reads the sheets, fits the law, writes the file that scenes include and its page, and prints a
/// summary.
pub(super) fn ore(arguments: &LabArguments) -> Result<()> {
    refuse_options_of_curves(arguments)?;
    let output = arguments.output("ore.toml");
    let page_file = page_file(&output, "write the ore to a name that ends in .toml")?;
    refuse_to_replace(&[output.clone(), page_file.clone()], &arguments.files)?;
    let material = material(arguments, &output)?;
    let sheets = read_sheets(&arguments.files)?;
    let ore = fit_ore(&sheets)?;
    let program = format!("dem-run {}", env!("CARGO_PKG_VERSION"));
    let text = ore_text(&ore, &sheets, [&today(), &program], &material);
    write_file(&page_file, |out| {
        out.write_all(ore_page(&ore, &sheets, &material).as_bytes())
    })?;
    write_file(&output, |out| out.write_all(text.as_bytes()))?;
    if arguments.json {
        write_standard_json(&json!({ "material": material, "ore": ore, "notes": sheets.notes }))
    } else if arguments.quiet {
        Ok(())
    } else {
        print(&ore, &sheets, [&output, &page_file])
    }
}

/// Refuses options that only curves have.
fn refuse_options_of_curves(arguments: &LabArguments) -> Result<()> {
    let given = [
        ("--specimens", arguments.specimens.is_some()),
        ("--support-span", arguments.support_span.is_some()),
        ("--loading-span", arguments.loading_span.is_some()),
        ("--width", arguments.width.is_some()),
        ("--height", arguments.height.is_some()),
        ("--length", arguments.length.is_some()),
        ("--area", arguments.area.is_some()),
        ("--travel-column", arguments.travel_column.is_some()),
        ("--travel-unit", arguments.travel_unit.is_some()),
        ("--force-column", arguments.force_column.is_some()),
        ("--force-unit", arguments.force_unit.is_some()),
    ];
    match given.iter().find(|(_, is_given)| *is_given) {
        Some((option, _)) => Err(Diagnostic::input(
            *option,
            format!("does not go with {TYPE}"),
            "leave it out: the sheets give the sizes and units of their columns",
        )),
        None => Ok(()),
    }
}

/// The name of the material: as given, or the name of the output. It is a key in TOML.
fn material(arguments: &LabArguments, output: &Path) -> Result<String> {
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let material = arguments
        .material
        .clone()
        .unwrap_or_else(|| stem.into_owned());
    let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    if material.is_empty() || !material.chars().all(is_plain) {
        let problem = format!(
            "'{}' is not the name of a material",
            material.escape_debug()
        );
        let remedy = "use letters, digits, - and _, such as --material ore";
        return Err(Diagnostic::input("--material", problem, remedy));
    }
    Ok(material)
}

fn print(ore: &FittedOre, sheets: &DropWeightSheets, written: [&Path; 2]) -> Result<()> {
    write_standard_output(|out| {
        for note in &sheets.notes {
            writeln!(out, "note         {}", visible(note))?;
        }
        for doubt in &ore.doubts {
            writeln!(out, "doubt        {}", visible(doubt))?;
        }
        let [rows, sizes] = [(ore.tests, "row"), (ore.by_size.len(), "size")]
            .map(|(count, what)| counted(count, what));
        writeln!(out, "tests        {rows} with a t10, {sizes}")?;
        for one in ore_numbers(ore) {
            writeln!(
                out,
                "{:15}  {:14}  95 %: {}",
                one.name, one.value, one.interval
            )?;
        }
        let points = 100.0 * ore.rms;
        writeln!(
            out,
            "residual         {points:.1} points of t10, root mean square"
        )?;
        let [output, page] = written.map(|path| path.display().to_string());
        writeln!(out, "written      {}, {}", visible(&output), visible(&page))
    })
}
