//! `dem-run keys`: the reference of the keys of scenes and studies.

use clap::Args;
use dem_io::standard_output::write_standard_output;
use dem_io::{Diagnostic, Result};
use dem_scene::reference;

#[derive(Debug, Args)]
pub(super) struct KeysArguments {
    /// A table of a scene, such as bodies or run; study for the keys of a study. All tables of a
    /// scene unless given
    #[arg(value_name = "TABLE")]
    table: Option<String>,
}

/// Prints the reference, or the sections of one table.
///
/// # Errors
/// There is no such table.
pub(super) fn keys(arguments: &KeysArguments) -> Result<()> {
    let wanted = arguments.table.as_deref();
    let file = match wanted {
        Some("study") => "study-keys.md",
        _ => "scene-keys.md",
    };
    let files = reference::files();
    let page = files.iter().find(|(name, _)| *name == file);
    let page = page.map_or("", |(_, text)| text.as_str());
    let text = match wanted {
        None | Some("study" | "scene") => page.to_owned(),
        Some(table) => sections(page, table)?,
    };
    write_standard_output(|out| out.write_all(text.as_bytes()))
}

/// The section of `[table]` or `[table.NAME]`, and those of the tables within it.
fn sections(page: &str, table: &str) -> Result<String> {
    let bare = table.trim_matches(['[', ']']);
    let bare = bare.split('.').next().unwrap_or_default();
    let mut text = String::new();
    let mut names = Vec::new();
    let mut is_wanted = false;
    for section in page.split("\n## ").skip(1) {
        // Those of tables within a table follow it, with a plain heading.
        if let Some(name) = section.strip_prefix("`[") {
            let name = name.split(['.', ']']).next().unwrap_or_default();
            names.push(name);
            is_wanted = name == bare;
        }
        if is_wanted && !section.starts_with("Units") {
            text += &format!("## {}\n\n", section.trim_end());
        }
    }
    if text.is_empty() {
        return Err(Diagnostic::input(
            format!("dem-run keys {table}"),
            format!("a scene has no table '{bare}'"),
            format!("use one of {}, or study", names.join(", ")),
        ));
    }
    Ok(text)
}
