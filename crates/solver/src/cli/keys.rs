//! `dem-run keys`: the reference of the keys of scenes and studies.

use clap::Args;
use dem_io::{Diagnostic, Result};
use dem_scene::reference;
use dem_terminal::standard_output::write_standard_output;

use super::keys_text::plain;

#[derive(Debug, Args)]
pub(super) struct KeysArguments {
    /// A table of a scene or a study, such as bodies, drop or find; study for all keys of a study.
    /// All tables of a scene unless given
    #[arg(value_name = "TABLE")]
    table: Option<String>,
}

/// Prints the reference, or the sections of one table.
pub(super) fn keys(arguments: &KeysArguments) -> Result<()> {
    let files = reference::files();
    let page = |name: &str| {
        let page = files.iter().find(|(file, _)| *file == name);
        page.map_or("", |(_, text)| text.as_str())
    };
    let (scene, study) = (page("scene-keys.md"), page("study-keys.md"));
    let markdown = match arguments.table.as_deref() {
        None | Some("scene") => scene.to_owned(),
        Some("study") => study.to_owned(),
        Some(table) => sections(scene, table)
            .or_else(|| sections(study, table))
            .ok_or_else(|| no_table(table, scene, study))?,
    };
    write_standard_output(|out| out.write_all(plain(&markdown).as_bytes()))
}

/// The sections of a page, each with its heading: `[bodies.NAME]`, or `Drop` for a table within a
/// table, which follows it.
fn headed(page: &str) -> impl Iterator<Item = (&str, &str)> {
    let sections = page.split("\n## ").skip(1);
    let headed = sections.map(|section| {
        let heading = section.lines().next().unwrap_or_default();
        (heading.trim_matches('`'), section.trim_end())
    });
    headed.filter(|(heading, _)| *heading != "Units")
}

/// `bodies` for `[bodies.NAME]`, and as it is for others.
fn bare(heading: &str) -> &str {
    let inner = heading.trim_matches(['[', ']']);
    inner.split('.').next().unwrap_or_default()
}

/// The section of `[table]` or `[table.NAME]`, and those of the tables within it; or that of a
/// table within another.
fn sections(page: &str, table: &str) -> Option<String> {
    let wanted = bare(table);
    let mut text = String::new();
    let mut is_within = false;
    for (heading, section) in headed(page) {
        if heading.starts_with('[') {
            is_within = bare(heading) == wanted;
        }
        if is_within || heading.to_lowercase() == wanted.to_lowercase() {
            let blank = if text.is_empty() { "" } else { "\n" };
            text += &format!("{blank}## {section}\n");
        }
    }
    (!text.is_empty()).then_some(text)
}

fn no_table(table: &str, scene: &str, study: &str) -> Diagnostic {
    let names = |page| {
        let outer = headed(page).filter(|(heading, _)| heading.starts_with('['));
        outer
            .map(|(heading, _)| bare(heading))
            .collect::<Vec<&str>>()
    };
    Diagnostic::input(
        format!("dem-run keys {table}"),
        format!("a scene has no table '{}'", bare(table)),
        format!(
            "use one of {}, or of a study {}; study prints all of a study",
            names(scene).join(", "),
            names(study).join(", ")
        ),
    )
}
