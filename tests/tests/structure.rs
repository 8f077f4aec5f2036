//! The structure of the code, from its text: crates import only crates below them, files do not
//! import each other in circles, and neither files, functions nor crates are too long.
//!
//! A file imports another if it names it in a path: `use super::x::Y`, `crate::x::f()`, or `x::f()`
//! after `mod x;`. That a file declares another is no import, and modules of tests do not count.
//! In other modules within a file, `super::` is taken for the parent of the file.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fs;
use std::path::{Path, PathBuf};

use super::root;

/// Largest number of lines of a function, of a file without its tests, and of a crate.
const MOST_LINES: [usize; 3] = [80, 600, 27_000];

/// The crates of the programs; each uses only those before it.
const UPWARDS: [&str; 20] = [
    "io",
    "terminal",
    "physics",
    "plots",
    "pictures",
    "laboratory",
    "packer",
    "scene",
    "calibration",
    "results",
    "study",
    "report",
    "engine",
    "plan",
    "rig",
    "run",
    "lammps",
    "stress",
    "solver",
    "pages",
];

/// The path of a module in its crate: none for `lib.rs` and `main.rs`.
type Module = Vec<String>;

/// A source file; its path has slashes on every system.
struct Source {
    path: String,
    text: String,
}

/// All files of a crate or an example whose root file is in this folder.
fn sources(folder: &Path) -> BTreeMap<Module, Source> {
    let mut all = BTreeMap::new();
    let mut folders = vec![(folder.to_owned(), Module::new())];
    while let Some((folder, within)) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let mut module = within.clone();
            let stem = path.file_stem().unwrap().to_str().unwrap();
            if !["lib", "main", "mod"].contains(&stem) {
                module.push(stem.to_owned());
            }
            if path.is_dir() {
                folders.push((path, module));
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                let path = slashed(&path);
                all.insert(module, Source { path, text });
            }
        }
    }
    all
}

fn slashed(path: &Path) -> String {
    path.display().to_string().replace('\\', "/")
}

/// The text without comments and without the module of its tests.
fn code(text: &str) -> String {
    let lines = text.lines();
    let lines = lines.map(|line| line.split("//").next().unwrap_or_default());
    let code = lines.collect::<Vec<&str>>().join("\n");
    let tests = code.find("#[cfg(test)]\nmod tests {");
    code[..tests.unwrap_or(code.len())].to_owned()
}

/// The modules that a text declares: `mod x;`.
fn declared(code: &str) -> Vec<String> {
    let lines = code.lines().filter_map(|line| line.strip_suffix(';'));
    let names = lines.filter_map(|line| {
        let mut words = line.split(' ').rev();
        let name = words.next()?;
        (words.next()? == "mod").then(|| name.to_owned())
    });
    names.collect()
}

/// The modules, among the known ones, that a module names in paths.
fn imports(module: &[String], code: &str, known: &BTreeSet<Module>) -> BTreeSet<Module> {
    let mut starts = declared(code);
    starts.extend(["crate", "super", "self"].map(str::to_owned));
    let is_of_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut found = BTreeSet::new();
    for start in starts {
        for (at, _) in code.match_indices(&format!("{start}::")) {
            let before = &code[..at];
            let is_within = before.ends_with(|c: char| is_of_name(c) || c == ':');
            // `pub(in crate::x)` imports nothing.
            if !is_within && !before.ends_with("(in ") {
                let mut paths = Vec::new();
                add_paths(&code[at..], &[], &mut paths);
                found.extend(paths.iter().map(|path| file_of(module, path, known)));
            }
        }
    }
    found.remove(module);
    found
}

/// Adds the paths at the beginning of a text, one or a tree of them: `a::b`, `a::{b, c::d}`.
/// Returns the rest of the text.
fn add_paths<'a>(text: &'a str, before: &[String], paths: &mut Vec<Module>) -> &'a str {
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_'));
    let (name, rest) = text.split_at(end.unwrap_or(text.len()));
    let path = [before, &[name.to_owned()]].concat();
    let Some(after) = rest.strip_prefix("::") else {
        paths.push(path);
        return rest;
    };
    let Some(mut inner) = after.strip_prefix('{') else {
        return add_paths(after, &path, paths);
    };
    loop {
        inner = inner.trim_start();
        if let Some(rest) = inner.strip_prefix('}') {
            return rest;
        }
        let rest = add_paths(inner, &path, paths);
        // An item may have another name here: `a as b`.
        let rest = &rest[rest.find([',', '}']).unwrap_or(rest.len())..];
        inner = rest.strip_prefix(',').unwrap_or(rest);
        if inner.is_empty() {
            return inner;
        }
    }
}

/// The known module that a path of a module leads to: the longest part of the path that is one.
fn file_of(module: &[String], path: &[String], known: &BTreeSet<Module>) -> Module {
    let mut place = module.to_vec();
    for (at, name) in path.iter().enumerate() {
        match name.as_str() {
            "crate" if at == 0 => place.clear(),
            "super" => drop(place.pop()),
            "self" => {}
            _ => place.push(name.clone()),
        }
    }
    while !(place.is_empty() || known.contains(&place)) {
        place.pop();
    }
    place
}

/// The shortest circle of imports through each module, each circle once: the files in it.
fn circles(sources: &BTreeMap<Module, Source>) -> Vec<String> {
    let codes: BTreeMap<&Module, String> =
        sources.iter().map(|(m, s)| (m, code(&s.text))).collect();
    let mut known: BTreeSet<Module> = sources.keys().cloned().collect();
    for (module, code) in &codes {
        // Also those whose file is elsewhere, which are none of ours.
        known.extend(
            declared(code)
                .into_iter()
                .map(|name| [&module[..], &[name]].concat()),
        );
    }
    let of =
        |(module, code): (&&Module, &String)| ((*module).clone(), imports(module, code, &known));
    let imports: BTreeMap<Module, BTreeSet<Module>> = codes.iter().map(of).collect();
    let rings: BTreeMap<BTreeSet<&Module>, Vec<&Module>> = imports
        .keys()
        .rev()
        .filter_map(|module| ring(module, &imports))
        .map(|ring| (ring.iter().copied().collect(), ring))
        .collect();
    let name = |module: &&Module| sources[*module].path.as_str();
    let names = |ring: &Vec<&Module>| ring.iter().map(name).collect::<Vec<&str>>();
    rings
        .values()
        .map(|ring| names(ring).join(" -> "))
        .collect()
}

/// The shortest way from a module along imports back to itself, both ends included.
fn ring<'a>(
    from: &'a Module,
    imports: &'a BTreeMap<Module, BTreeSet<Module>>,
) -> Option<Vec<&'a Module>> {
    let mut ways = VecDeque::from([vec![from]]);
    let mut seen = BTreeSet::new();
    while let Some(way) = ways.pop_front() {
        for next in imports.get(way[way.len() - 1]).into_iter().flatten() {
            let longer = [&way[..], &[next]].concat();
            if next == from {
                return Some(longer);
            }
            if seen.insert(next) {
                ways.push_back(longer);
            }
        }
    }
    None
}

/// The functions of a text that are too long: name and number of lines. It must be formatted: a
/// function ends with the first brace that is as far from the margin as its beginning.
fn long_functions(text: &str) -> Vec<(String, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut long = Vec::new();
    for (at, line) in lines.iter().enumerate() {
        let mut words = line.split_whitespace();
        let is_before = |word: &&str| word.starts_with("pub") || ["const", "unsafe"].contains(word);
        let Some("fn") = words.by_ref().find(|word| !is_before(word)) else {
            continue;
        };
        let end = format!("{}}}", &line[..line.len() - line.trim_start().len()]);
        let is_whole = |line: &&&str| line.ends_with(['{', ';', '}']);
        let opens = lines[at..]
            .iter()
            .find(is_whole)
            .is_some_and(|line| line.ends_with('{'));
        let count = 1 + lines[at..].iter().take_while(|line| **line != end).count();
        if opens && count > MOST_LINES[0] {
            let name = words.next().and_then(|word| word.split(['(', '<']).next());
            long.push((name.unwrap_or_default().to_owned(), count));
        }
    }
    long
}

/// What is wrong with the files of some crates and examples, given by the folders of their root
/// files, a sentence each.
fn faults(folders: &[PathBuf]) -> Vec<String> {
    let mut faults = Vec::new();
    for folder in folders {
        let sources = sources(folder);
        faults.extend(
            circles(&sources)
                .into_iter()
                .map(|circle| format!("imports in a circle: {circle}")),
        );
        let [of_function, of_file, of_crate] = MOST_LINES;
        let mut total = 0;
        for Source { path, text } in sources.values() {
            let lines = code(text).lines().count();
            total += lines;
            if lines > of_file {
                faults.push(format!("{path} has {lines} lines, more than {of_file}"));
            }
            for (name, count) in long_functions(text) {
                faults.push(format!(
                    "{path}: {name} has {count} lines, more than {of_function}"
                ));
            }
        }
        if total > of_crate {
            let folder = slashed(folder);
            faults.push(format!("{folder} has {total} lines, more than {of_crate}"));
        }
    }
    faults
}

fn folders_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths.filter(|path| path.is_dir()).collect()
}

#[test]
fn imports_run_one_way_and_functions_are_short() {
    let mut folders = vec![root().join("python/src")];
    for of_crate in folders_in(&root().join("crates")) {
        folders.push(of_crate.join("src"));
        folders.extend(folders_in(&of_crate.join("examples")));
    }
    assert!(folders.len() > 10);
    let faults = faults(&folders);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Crates of this workspace in a table of a manifest, by the names of their folders.
fn used(manifest: &str, table: &str) -> Vec<String> {
    let after = manifest.split_once(table).map_or("", |(_, after)| after);
    let own = after.split_once("\n[").map_or(after, |(own, _)| own);
    let names = own.lines().filter_map(|line| line.strip_prefix("dem-"));
    let folder = |name: &str| match name {
        "pack" => "packer".to_owned(),
        "run" => "solver".to_owned(),
        "runner" => "run".to_owned(),
        other => other.to_owned(),
    };
    names
        .filter_map(|line| line.split(['.', ' ']).next())
        .map(folder)
        .collect()
}

#[test]
fn crates_use_only_those_below_them() {
    let rank = |name: &str| UPWARDS.iter().position(|known| *known == name);
    let mut arrows = 0;
    for of_crate in folders_in(&root().join("crates")) {
        let name = of_crate.file_name().unwrap().to_str().unwrap().to_owned();
        if name == "testing" {
            continue;
        }
        let manifest = fs::read_to_string(of_crate.join("Cargo.toml")).unwrap();
        let own = rank(&name).unwrap_or_else(|| panic!("{name} is not listed"));
        for other in used(&manifest, "[dependencies]\n") {
            let below = rank(&other).unwrap_or_else(|| panic!("{other} is not listed"));
            assert!(below < own, "{name} uses {other}");
            // The packer and the solver share body files alone; only commands call the packer.
            assert!(
                other != "packer" || name == "solver" || name == "pages",
                "{name}"
            );
            arrows += 1;
        }
    }
    assert!(arrows > 50, "{arrows}");
}

/// A library without tests in its manifest has none in its source: they would never run.
#[test]
fn tests_within_a_library_are_run() {
    let mut with_tests = 0;
    for of_crate in folders_in(&root().join("crates")) {
        let manifest = fs::read_to_string(of_crate.join("Cargo.toml")).unwrap();
        let sources = sources(&of_crate.join("src"));
        let test = sources.values().find(|source| {
            source.text.contains("#[cfg(test") || source.text.contains("#[cfg(all(test")
        });
        with_tests += usize::from(test.is_some());
        if let (Some(test), Some((_, library))) = (test, manifest.split_once("[lib]")) {
            let library = library
                .split_once("\n[")
                .map_or(library, |(library, _)| library);
            assert!(!library.contains("test = false"), "{}", test.path);
        }
    }
    assert!(with_tests > 5, "{with_tests}");
}

#[test]
fn a_circle_and_a_long_function_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    let found = || {
        let faults = faults(&[folder.path().to_owned()]).join("\n");
        faults.replace(&format!("{}/", slashed(folder.path())), "")
    };
    write(
        "lib.rs",
        "pub mod wall;\npub mod ball;\npub use ball::Ball;\n",
    );
    write(
        "ball.rs",
        "use crate::wall::{self as flat, shape::{Plane, plane}};\n",
    );
    write(
        "wall.rs",
        "pub mod shape;\nmod touch;\n// crate::ball::Ball\n",
    );
    write(
        "wall/touch.rs",
        "use super::shape::Plane;\n#[cfg(test)]\nmod tests {\n    use super::*;\n}\n",
    );
    let short = format!(
        "    pub(crate) fn plane() {{\n{}    }}\n",
        "        one();\n".repeat(MOST_LINES[0] - 2)
    );
    write(
        "wall/shape.rs",
        &format!("trait Shape {{\n    fn area();\n{short}}}\n"),
    );
    assert_eq!(found(), "");
    write(
        "wall/shape.rs",
        &short
            .replacen("one", "crate::ball::one", 1)
            .replacen("    one", "    one();\n    one", 1),
    );
    assert_eq!(
        found(),
        "imports in a circle: ball.rs -> wall/shape.rs -> ball.rs\n\
         wall/shape.rs: plane has 81 lines, more than 80"
    );
    write("wall/shape.rs", "");
    write(
        "wall.rs",
        "pub mod shape;\nmod touch;\nfn f() { touch::g() }\n",
    );
    write("wall/touch.rs", "use super::f;\n");
    assert_eq!(
        found(),
        "imports in a circle: wall.rs -> wall/touch.rs -> wall.rs"
    );
    write("wall/touch.rs", "use crate::Ball;\n");
    assert_eq!(
        found(),
        "imports in a circle: lib.rs -> ball.rs -> wall.rs -> wall/touch.rs -> lib.rs"
    );
}
