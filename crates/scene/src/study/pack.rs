//! `[pack.NAME]`: bodies that a study packs itself, with options of `dem-pack` that may vary.

use std::path::{Path, PathBuf};

use super::contents::{BODY, PACK, Pack, Study};
use super::keys::PACKED;
use super::values::tidy;
use crate::names::suggestion;
use crate::table::Table;
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::hash::{file_hash, fnv1a_of_parts};

/// The bodies that are packed.
pub(super) fn packs(root: &Table<'_>, folder: &Path) -> Result<Vec<Pack>> {
    let read = |(body, field): (String, crate::field::Field<'_>)| {
        let table = Table::of(&field, &PACKED)?;
        let shape = crate::paths::named_path(&table.need("shape")?, folder)?;
        let shape = tidy(shape);
        let options: Option<String> = table.read("options")?;
        let options: Vec<String> = (options.unwrap_or_default().split_whitespace())
            .map(str::to_owned)
            .collect();
        Ok(Pack {
            body,
            content: content(&shape, &options),
            shape,
            options,
            place: field.document.place(field.node.origin),
        })
    };
    root.named("pack")?.into_iter().map(read).collect()
}

/// Hash of a shape and of the files among some options, such as a sieve curve.
fn content(shape: &Path, options: &[String]) -> u64 {
    let named = |word: &String| word.rsplit(['=', ':']).next().map(PathBuf::from);
    let files = std::iter::once(shape.to_owned()).chain(options.iter().filter_map(named));
    let hashes: Vec<[u8; 8]> = files
        .map(|file| file_hash(&file).unwrap_or_default().to_le_bytes())
        .collect();
    fnv1a_of_parts(&hashes.iter().map(|hash| &hash[..]).collect::<Vec<_>>())
}

/// Refuses options of bodies that are not packed, options that are given twice, and files of bodies
/// that are.
pub(super) fn refuse_lost(study: &Study) -> Result<()> {
    let varied = study.axes.iter().flat_map(|axis| &axis.values);
    let varied = varied.flat_map(|value| &value.settings);
    for setting in study.fixed.iter().chain(varied) {
        if let Some(body) = setting.path.strip_prefix(BODY)
            && study.packs.iter().any(|pack| pack.body == body)
        {
            let problem = format!(
                "{} is the file of a body that [pack.{body}] packs",
                setting.path
            );
            return Err(Diagnostic::input(
                &setting.place,
                problem,
                "remove one of the two",
            ));
        }
        let Some(path) = setting.path.strip_prefix(PACK) else {
            continue;
        };
        let (body, option) = path.split_once('.').unwrap_or((path, ""));
        let names = || study.packs.iter().map(|pack| pack.body.as_str());
        let Some(pack) = study.packs.iter().find(|pack| pack.body == body) else {
            let problem = format!("{}: there is no [pack.{body}]", setting.path);
            return Err(Diagnostic::input(
                &setting.place,
                problem,
                suggestion(body, names()),
            ));
        };
        if option.is_empty() {
            let problem = format!("{} names no option of dem-pack", setting.path);
            let remedy = format!("write \"{PACK}{body}.seed\", say");
            return Err(Diagnostic::input(&setting.place, problem, remedy));
        }
        let written = format!("--{option}");
        let is_same = |word: &String| word.split('=').next() == Some(written.as_str());
        if pack.options.iter().any(is_same) {
            let problem = format!("{written} is among the options of [pack.{body}] as well");
            return Err(Diagnostic::input(
                &setting.place,
                problem,
                "remove it there",
            ));
        }
    }
    Ok(())
}
