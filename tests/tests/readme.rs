//! README.md is correct: its commands run, and the files, options and shapes that it names exist.

use std::fs;
use std::process::Command;

use super::{DEM_PACK, DEM_RUN, dem_pack, dem_run, root};

fn readme() -> String {
    fs::read_to_string(root().join("README.md")).unwrap()
}

/// The lines of all code blocks in this language.
fn blocks<'a>(readme: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}");
    let mut inside = false;
    let mut found = Vec::new();
    for line in readme.lines() {
        if line.starts_with("```") {
            inside = line == fence;
        } else if inside {
            found.push(line);
        }
    }
    found
}

/// Every command runs, in order, in a folder with a copy of the shapes, scenes and bodies. To save
/// time, spheres are larger, packings fewer, the chute ends sooner, and a shape with few facets
/// replaces the rock.
#[test]
fn commands_run_as_pasted() {
    let folder = tempfile::tempdir().unwrap();
    let shapes = folder.path().join("data/shapes");
    fs::create_dir_all(&shapes).unwrap();
    for (name, stands_in) in [
        ("filter-cake.stl", "filter-cake.stl"),
        ("rock.stl", "c-shape.stl"),
        ("bending-sample.stl", "bending-sample.stl"),
    ] {
        fs::copy(
            root().join("data/shapes").join(stands_in),
            shapes.join(name),
        )
        .unwrap();
    }
    for name in [
        "data/scenes",
        "data/bodies",
        "data/studies",
        "data/measured",
    ] {
        let copies = folder.path().join(name);
        fs::create_dir_all(&copies).unwrap();
        for file in fs::read_dir(root().join(name)).unwrap() {
            let file = file.unwrap();
            fs::copy(file.path(), copies.join(file.file_name())).unwrap();
        }
    }
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
    let readme = readme();
    let mut commands = 0;
    for line in blocks(&readme, "sh") {
        let line = line.replace("cargo run --release --bin dem-pack -- ", "dem-pack ");
        let line = line.replace("cargo run --release --bin dem-run -- ", "dem-run ");
        if line.starts_with("cargo ") || line.starts_with("export ") {
            continue;
        }
        let small = line
            .replace(" 2mm..3mm", " 4mm..5mm")
            .replace(" 5mm..7mm", " 7mm..9mm")
            .replace(" -o cake.toml --", " -o cake.toml --packings 2 --")
            .replace("/chute.toml", "/chute.toml --set run.end_time=0.2")
            .replace(
                " data/studies/spinning-bar.toml",
                " data/studies/spinning-bar.toml --jobs 2",
            );
        let output = Command::new("bash")
            .args(["-o", "pipefail", "-c", &small])
            .env("PATH", &path)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{small}\n{said}");
        assert!(!said.contains("error:"), "{small}\n{said}");
        commands += 1;
    }
    assert!(commands >= 10, "{commands} commands");
    for made in [
        "cake.vtp",
        "cake.data",
        "cake.particles.csv",
        "cake.bonds.csv",
        "again.vtp",
        "rock.vtp",
        "dem-pack.1",
        "dem-run.1",
    ] {
        assert!(
            fs::metadata(folder.path().join(made)).unwrap().len() > 1000,
            "{made}"
        );
    }
}

/// Words that begin with one of the repository's folders, and the targets of links.
#[test]
fn files_exist() {
    let readme = readme();
    let links = readme
        .split("](")
        .skip(1)
        .map(|rest| rest.split(')').next().unwrap());
    let words = readme
        .split(|c: char| c.is_whitespace() || "`\"'(),;:".contains(c))
        .filter(|word| {
            ["data/", "crates/", "doc/", "fuzz/", ".ci/"]
                .iter()
                .any(|folder| word.starts_with(folder))
        });
    let mut files = 0;
    for name in links.filter(|link| !link.starts_with("http")).chain(words) {
        let path = root().join(name.trim_end_matches('.'));
        assert!(path.exists(), "README.md names {name}");
        files += 1;
    }
    assert!(files >= 10, "{files} files");
}

/// The help of these commands.
fn help(of: impl Fn() -> Command, commands: &[&[&str]]) -> String {
    let said = commands.iter().map(|arguments| {
        let output = of().args(*arguments).arg("--help").output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    });
    said.collect()
}

/// Every option outside cargo commands is an option of one of the programs, and every option of the
/// programs is named: in the README, or on the page of its command.
#[test]
fn options_exist() {
    let mut known = help(dem_pack, &[&[], &["info"], &["convert"]]);
    known += &help(dem_run, &[&[], &["check"], &["sweep"]]);
    let of_pages = help(
        dem_run,
        &[&["lab"], &["calibrate"], &["fragment"], &["export"]],
    );
    let readme = readme().replace("cargo run --release --bin dem-pack -- ", "dem-pack ");
    let lines = readme.lines().filter(|line| !line.contains("cargo "));
    let named: Vec<String> = lines.flat_map(options).collect();
    assert!(named.len() >= 20, "{named:?}");
    let all = options(&(known.clone() + &of_pages));
    for option in &named {
        assert!(
            all.contains(option),
            "README.md names {option}, which no program knows"
        );
    }
    let pages = [
        "doc/measured-curves.md",
        "doc/calibration.md",
        "doc/results.md",
    ];
    let pages = pages
        .map(|page| fs::read_to_string(root().join(page)).unwrap())
        .concat();
    for (command, text) in [(known, readme.clone()), (of_pages, readme + &pages)] {
        let named = options(&text);
        for option in options(&command) {
            let told_by_help = ["--help", "--version"].contains(&option.as_str());
            assert!(
                told_by_help || named.contains(&option),
                "README.md and the page of its command do not name {option}"
            );
        }
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

/// Every line of the report begins with a name that the README's table explains.
#[test]
fn report_is_explained() {
    let folder = tempfile::tempdir().unwrap();
    let output = dem_pack()
        .arg(root().join("data/shapes/tablet.stl"))
        .args([
            "--diameter",
            "1mm..1.2mm",
            "--particle-density",
            "2000",
            "--solid-density",
            "1500",
            "-o",
        ])
        .arg(folder.path().join("tablet.vtp"))
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let report = String::from_utf8(output.stdout).unwrap();
    let readme = readme();
    for line in report.lines().skip(1) {
        let name = line.split("  ").next().unwrap().split(':').next().unwrap();
        assert!(
            readme.contains(&format!("`{name}`")),
            "the README's table does not explain '{name}':\n{report}"
        );
    }
}
