//! README.md and the pages in doc/ and doc/inside/ are correct: their commands run, and the files,
//! options and shapes that they name exist.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::{DEM_PACK, DEM_RUN, dem_pack, dem_run, root};

/// The pages whose commands are run and whose options must exist.
const PAGES: [&str; 23] = [
    "README.md",
    "doc/README.md",
    "doc/tablet.md",
    "doc/transfer-chute.md",
    "doc/sphere-size.md",
    "doc/verdict.md",
    "doc/toml.md",
    "doc/glossary.md",
    "doc/packing.md",
    "doc/inside/packing-method.md",
    "doc/running.md",
    "doc/calibration.md",
    "doc/measured-curves.md",
    "doc/breakage.md",
    "doc/gallery.md",
    "doc/inside/development.md",
    "doc/bulk.md",
    "doc/dynamic-tests.md",
    "doc/laboratory.md",
    "doc/inside/performance.md",
    "doc/pressing.md",
    "doc/process.md",
    "doc/inside/round-robin.md",
];

fn read(page: &str) -> String {
    fs::read_to_string(root().join(page)).unwrap()
}

/// The files of this ending in a folder of the repository, such as `doc/studies.md`.
fn files_in(folder: &str, ending: &str) -> Vec<String> {
    let entries = fs::read_dir(root().join(folder)).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut found: Vec<String> = names
        .filter(|name| name.ends_with(ending))
        .map(|name| format!("{folder}/{name}"))
        .collect();
    found.sort();
    found
}

/// The pages for users and those about the inside, README.md excepted.
fn pages() -> Vec<String> {
    [files_in("doc", ".md"), files_in("doc/inside", ".md")].concat()
}

/// The lines of all code blocks in this language.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}");
    let mut inside = false;
    let mut found = Vec::new();
    for line in page.lines() {
        if line.starts_with("```") {
            inside = line == fence;
        } else if inside {
            found.push(line);
        }
    }
    found
}

/// What the copies of scenes and studies have in place of something that takes longer.
const SHORTER: [(&str, &str, &str); 3] = [
    (
        "data/scenes/transfer-chute.toml",
        "end_time = \"2.8 s\"",
        "end_time = \"0.5 s\"",
    ),
    ("data/studies/liner.toml", "[1, 2, 3, 4]", "[1, 2]"),
    (
        "data/studies/tablet-drop.toml",
        "tolerance = \"0.7 m\"",
        "tolerance = \"6 m\"",
    ),
];

/// Copies the shapes, scenes and bodies. A shape with few facets replaces the rock, to save time.
fn copy_data(to: &Path) {
    let shapes = to.join("data/shapes");
    fs::create_dir_all(&shapes).unwrap();
    for (name, stands_in) in [
        ("filter-cake.stl", "filter-cake.stl"),
        ("rock.stl", "c-shape.stl"),
        ("bending-sample.stl", "bending-sample.stl"),
        ("tablet.stl", "tablet.stl"),
    ] {
        let original = root().join("data/shapes").join(stands_in);
        fs::copy(original, shapes.join(name)).unwrap();
    }
    for name in [
        "data/scenes",
        "data/bodies",
        "data/studies",
        "data/measured",
        "data/materials",
    ] {
        let copies = to.join(name);
        fs::create_dir_all(&copies).unwrap();
        for file in fs::read_dir(root().join(name)).unwrap() {
            let file = file.unwrap();
            fs::copy(file.path(), copies.join(file.file_name())).unwrap();
        }
    }
    for (name, whole, short) in SHORTER {
        let file = to.join(name);
        let text = fs::read_to_string(&file).unwrap();
        assert!(text.contains(whole), "{name} lacks {whole}");
        fs::write(&file, text.replace(whole, short)).unwrap();
    }
}

/// The command, with larger spheres, fewer packings and a scene that ends sooner; none if it builds
/// or tests the programs.
fn shortened(line: &str) -> Option<String> {
    let line = line
        .replace("cargo run --release --bin dem-pack -- ", "dem-pack ")
        .replace("cargo run --release --bin dem-run -- ", "dem-run ");
    if line.starts_with("cargo ") || line.starts_with("export ") {
        return None;
    }
    let small = line
        .replace(" 2mm..3mm", " 4mm..5mm")
        .replace(" 5mm..7mm", " 7mm..9mm")
        .replace(" -o cake.toml --", " -o cake.toml --packings 2 --")
        .replace(" -o tablet.toml --", " -o tablet.toml --packings 2 --")
        .replace(" 4.6mm..5.1mm", " 10mm..12mm")
        .replace("/lumps.toml", "/lumps.toml --set run.end_time=0.1")
        .replace(
            "-crusher-ore.toml",
            "-crusher-ore.toml --set run.end_time=0.4",
        )
        .replace("/crusher-gap.toml", "/crusher-gap.toml --list")
        .replace(
            " data/studies/spinning-bar.toml",
            " data/studies/spinning-bar.toml --jobs 2",
        );
    Some(small)
}

/// Runs the commands of a page in order, in a folder with a copy of the data: there are at least so
/// many, and they leave these files.
fn run_commands(page: &str, at_least: usize, made: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    copy_data(folder.path());
    let programs = tempfile::tempdir().unwrap();
    for (name, program) in [("dem-pack", DEM_PACK), ("dem-run", DEM_RUN)] {
        std::os::unix::fs::symlink(program, programs.path().join(name)).unwrap();
    }
    let inherited = std::env::var_os("PATH").unwrap();
    let path = std::env::join_paths(
        [programs.path().to_owned()]
            .into_iter()
            .chain(std::env::split_paths(&inherited)),
    )
    .unwrap();
    let text = read(page);
    let mut commands = 0;
    for small in blocks(&text, "sh").into_iter().filter_map(shortened) {
        let output = Command::new("bash")
            .args(["-o", "pipefail", "-c", &small])
            .env("PATH", &path)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{page}: {small}\n{said}");
        assert!(!said.contains("error:"), "{page}: {small}\n{said}");
        commands += 1;
    }
    assert!(commands >= at_least, "{page}: {commands} commands");
    for name in made {
        let length = fs::metadata(folder.path().join(name)).unwrap().len();
        assert!(length > 1000, "{page}: {name}");
    }
}

#[test]
fn commands_of_the_readme_run() {
    run_commands(
        "README.md",
        1,
        &[
            "lump.vtp",
            "lumps-out/film-strip.png",
            "lumps-out/report.html",
        ],
    );
}

#[test]
fn commands_for_packing_run() {
    let made = [
        "cake.vtp",
        "cake.data",
        "cake.particles.csv",
        "cake.bonds.csv",
        "again.vtp",
        "rock.vtp",
        "dem-pack.1",
    ];
    run_commands("doc/packing.md", 12, &made);
}

#[test]
fn commands_for_running_run() {
    let made = [
        "spin/report.html",
        "cake-falls/film.png",
        "at-rest/report.html",
        "dem-run.1",
    ];
    run_commands("doc/running.md", 12, &made);
}

#[test]
fn commands_for_calibration_run() {
    let made = [
        "measured.json",
        "cake.html",
        "four-point-bending-out/report.html",
    ];
    run_commands("doc/calibration.md", 4, &made);
}

#[test]
fn commands_for_the_tablet_run() {
    let made = [
        "measured.json",
        "tablet.html",
        "tablet-drop-out/report.html",
        "tablet-drop-sweep/sweep.html",
    ];
    run_commands("doc/tablet.md", 5, &made);
}

#[test]
fn commands_for_the_transfer_chute_run() {
    let made = [
        "start.png",
        "transfer-chute-out/report.html",
        "liner-sweep/sweep.html",
    ];
    run_commands("doc/transfer-chute.md", 3, &made);
}

#[test]
fn commands_from_drop_weight_sheets_to_a_crusher_run() {
    let made = ["quartzite.toml", "ore.html", "crusher/report.html"];
    run_commands("doc/breakage.md", 5, &made);
}

#[test]
fn commands_for_studies_run() {
    let made = [
        "spinning-bar-sweep/sweep.html",
        "bar-thickness-sweep/find.1.svg",
    ];
    run_commands("doc/studies.md", 2, &made);
}

#[test]
fn the_page_of_studies_holds_the_whole_search() {
    let page = read("doc/studies.md");
    let study = read("data/studies/bar-thickness.toml");
    assert!(page.contains(&format!("```toml\n{study}```")));
}

/// The targets of links, without their anchors.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let targets = text.split("](").skip(1);
    targets
        .map(|rest| rest.split(['#', ')']).next().unwrap())
        .filter(|link| !link.is_empty() && !link.starts_with("http"))
}

#[test]
fn links_lead_to_files() {
    let mut pages = pages();
    pages.push("README.md".to_owned());
    let mut files = 0;
    for page in &pages {
        let path = root().join(page);
        for link in links(&read(page)) {
            assert!(
                path.parent().unwrap().join(link).exists(),
                "{page} links to {link}"
            );
            files += 1;
        }
    }
    assert!(files >= 100, "{files} files");
}

/// Words that begin with one of the repository's folders.
#[test]
fn files_exist() {
    let mut files = 0;
    for page in PAGES {
        let text = read(page);
        let words = text
            .split(|c: char| c.is_whitespace() || "`\"'(),;:[]".contains(c))
            .filter(|word| {
                ["data/", "crates/", "doc/", "fuzz/", ".ci/"]
                    .iter()
                    .any(|folder| word.starts_with(folder))
            });
        for name in words {
            let path = root().join(name.trim_end_matches('.'));
            assert!(path.exists(), "{page} names {name}");
            files += 1;
        }
    }
    assert!(files >= 30, "{files} files");
}

/// The help of a program and of all its commands.
fn help(of: impl Fn() -> Command) -> String {
    let said = |arguments: &[&str]| {
        let output = of().args(arguments).arg("--help").output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let all = said(&[]);
    let commands = all.lines().skip_while(|line| *line != "Commands:").skip(1);
    let names = commands
        .take_while(|line| !line.is_empty())
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .map(|line| line.split_whitespace().next().unwrap());
    let of_commands: Vec<String> = names
        .filter(|name| *name != "help")
        .map(|name| said(&[name]))
        .collect();
    assert!(of_commands.len() >= 4, "{all}");
    all + &of_commands.concat()
}

/// Every option outside cargo commands is an option of one of the programs, and every option of the
/// programs is named on a page.
#[test]
fn options_exist() {
    let known = options(&(help(dem_pack) + &help(dem_run)));
    let mut named = Vec::new();
    for page in PAGES {
        let text = read(page)
            .replace("cargo run --release --bin dem-pack -- ", "dem-pack ")
            .replace("cargo run --release --bin dem-run -- ", "dem-run ");
        for option in text
            .lines()
            .filter(|line| !line.contains("cargo ") && !line.contains("python "))
            .flat_map(options)
        {
            assert!(
                known.contains(&option),
                "{page} names {option}, which no program knows"
            );
            named.push(option);
        }
    }
    assert!(named.len() >= 20, "{named:?}");
    let all: String = pages().iter().map(|page| read(page)).collect();
    named.extend(options(&all));
    for option in known {
        let told_by_help = ["--help", "--version"].contains(&option.as_str());
        assert!(
            told_by_help || named.contains(&option),
            "no page names {option}"
        );
    }
}

/// Words such as `--densify` in a text.
fn options(text: &str) -> Vec<String> {
    text.split(|c: char| !(c.is_ascii_lowercase() || c == '-'))
        .filter(|word| {
            word.starts_with("--") && word.len() > 3 && word.as_bytes()[2].is_ascii_lowercase()
        })
        .map(str::to_owned)
        .collect()
}

/// README.md is short, code and tables included.
#[test]
fn the_readme_is_short() {
    let words = read("README.md").split_whitespace().count();
    assert!(words <= 900, "README.md has {words} words");
}

#[test]
fn the_table_of_contents_names_every_page() {
    let contents = read("doc/README.md");
    for page in pages() {
        let name = page.trim_start_matches("doc/");
        let link = format!("]({name})");
        assert!(
            name == "README.md" || contents.contains(&link),
            "doc/README.md does not link to {name}"
        );
    }
}

#[test]
fn the_gallery_names_every_scene() {
    let gallery = read("doc/gallery.md");
    for scene in files_in("data/scenes", ".toml") {
        assert!(
            gallery.contains(&scene),
            "doc/gallery.md does not name {scene}"
        );
    }
}

#[test]
fn the_page_of_studies_names_every_study() {
    let page = read("doc/studies.md");
    for study in files_in("data/studies", ".toml") {
        let name = study.trim_start_matches("data/studies/");
        let row = format!("\n| `{name}` |");
        assert!(page.contains(&row), "doc/studies.md has no row of {name}");
    }
}

/// The words of all tables and pictures that `dem-pages` writes.
#[test]
fn development_names_every_command_that_writes_tables() {
    let page = read("doc/inside/development.md");
    let program = read("crates/pages/src/main.rs");
    let (_, commands) = program.split_once("const COMMANDS").unwrap();
    let (commands, _) = commands.split_once("];").unwrap();
    let lines = commands
        .lines()
        .filter_map(|line| line.trim().strip_prefix("(\""));
    let words: Vec<&str> = lines.map(|line| line.split('"').next().unwrap()).collect();
    assert!(words.len() >= 25, "{words:?}");
    for words in words {
        let named = [" -- ", "`"].map(|before| page.contains(&format!("{before}{words}`")));
        assert!(
            named.contains(&true),
            "doc/inside/development.md lacks {words}"
        );
    }
}

/// The commands in comments of scenes and studies: `#   dem-run data/scenes/NAME.toml OPTIONS`. A
/// remark follows after two spaces or more.
fn commands_in_comments() -> Vec<String> {
    let mut files = files_in("data/scenes", ".toml");
    files.extend(files_in("data/studies", ".toml"));
    let commands = files.iter().flat_map(|file| {
        let text = read(file);
        let lines = text
            .lines()
            .filter_map(|line| line.strip_prefix("#   dem-run "));
        let commands = lines.map(|line| line.split("  ").next().unwrap().to_owned());
        commands.collect::<Vec<_>>()
    });
    commands.collect()
}

/// `dem-run check` refuses no command that a scene prints, except that a body or a material which
/// an earlier command makes is not there. A study is listed instead.
#[test]
fn commands_in_comments_of_scenes_and_studies_are_not_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut counts = [0, 0];
    for command in commands_in_comments() {
        let is_study = command.starts_with("sweep ");
        if !is_study && !command.starts_with("data/scenes/") {
            continue;
        }
        let made = ["--body ", "--material rock.toml"].map(|word| command.contains(word));
        if made.contains(&true) || command.contains("larger-spheres") {
            continue;
        }
        // `--output` is for a run.
        let command = command.split(" --output ").next().unwrap();
        let command = command.split(" -o ").next().unwrap();
        let options = if is_study {
            format!(
                "{command} --list --output {}",
                folder.path().join("sweep").display()
            )
        } else {
            format!("check {command}")
        };
        let output = Command::new("bash")
            .args(["-c", &format!("{DEM_RUN} {options}")])
            .current_dir(root())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{command}\n{said}");
        counts[usize::from(is_study)] += 1;
        let _ = fs::remove_dir_all(folder.path().join("sweep"));
    }
    assert!(counts[0] >= 35 && counts[1] >= 8, "{counts:?}");
}

/// Every line of the report begins with a name that the table of doc/packing.md explains.
#[test]
fn report_is_explained() {
    let folder = tempfile::tempdir().unwrap();
    let page = read("doc/packing.md");
    for whole in [None, Some("--verbose")] {
        let output = dem_pack()
            .arg(root().join("data/shapes/tablet.stl"))
            .args(["--diameter", "1mm..1.2mm", "--particle-density", "2000"])
            .args(["--solid-density", "1500"])
            .args(whole)
            .arg("-o")
            .arg(folder.path().join("tablet.vtp"))
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let report = String::from_utf8(output.stdout).unwrap();
        for line in report.lines().skip(1) {
            let name = line.split("  ").next().unwrap().split(':').next().unwrap();
            assert!(
                page.contains(&format!("`{name}`")),
                "the table of doc/packing.md does not explain '{name}':\n{report}"
            );
        }
    }
}
