//! Invalid scenes with clumps are refused, with the place, the value and the remedy.

use super::regions::box_stl;
use super::{HEAD, MEETS, block, lump, try_planned};
use crate::helpers::scene;
use dem_io::{Body, Diagnostic};
use dem_plan::plan;

/// The message gives place, problem and remedy, and a program that prints it ends with exit code 2.
fn refused(text: &str, place: &str, problem: &str, remedy: &str) {
    told(&try_planned(text).unwrap_err(), place, problem, remedy);
}

fn told(error: &Diagnostic, place: &str, problem: &str, remedy: &str) {
    let [is_place, is_problem, is_remedy] =
        [&error.place, &error.problem, &error.remedy].map(String::as_str);
    let all = format!("{is_place} | {is_problem} | {is_remedy}");
    assert!(is_place.contains(place), "{all}");
    assert!(is_problem.contains(problem), "{all}");
    assert!(is_remedy.contains(remedy), "{all}");
    assert_eq!(error.exit_code(), 2, "{all}");
}

#[test]
fn replacement_without_bonds() {
    let ball = "[bodies.ball]\nmaterial = \"stuff\"\nbonds = \"stiff\"\nstart_as = \"clump\"\n\
                file = \"ball.vtp\"\n";
    let scene = scene(&format!(
        "{HEAD}{ball}[replacement.ball]\nwhen = {{ time = 0 }}\n"
    ));
    let spheres = [[0.0, 0.0, 0.0, 1e-3], [2e-3, 0.0, 0.0, 1e-3]];
    let read = Body::from_spheres(&spheres, &[]).unwrap();
    let error = plan(&scene, [("ball".to_owned(), read)].into(), 1, false).unwrap_err();
    told(
        &error,
        "test.toml: [replacement.ball]",
        "the body has no bonds",
        "with bonds",
    );
}

#[test]
fn triggers_by_the_touch_of_what_cannot_be_touched() {
    let rule = "[replacement.lump]\nwhen = { touches = \"lump\" }\n";
    let place = "replacement.lump.when.touches";
    let one = format!(
        "{HEAD}{MEETS}{}{rule}",
        lump("lump", "start_as = \"clump\"")
    );
    refused(&one, place, "it cannot touch itself", "another body");
    let fed = |count: &str| {
        format!(
            "{HEAD}{MEETS}{}{rule}[regions.gate]\nsphere = {{ centre = [0, 0, 0], radius = 0.1 }}\n\
             [inlets.feed]\nbodies = [\"lump\"]\nregion = \"gate\"\nrate = 1\n{count}\n",
            lump("lump", "start_as = \"clump\"")
        )
    };
    refused(
        &fed("count = 1"),
        place,
        "it cannot touch itself",
        "another body",
    );
    for count in ["count = 2", ""] {
        try_planned(&fed(count)).unwrap();
    }
    refused(
        &one.replace(MEETS, ""),
        place,
        "no [contacts]",
        "add [contacts]",
    );
}

#[test]
fn particle_damping() {
    let body = lump("lump", "start_as = \"clump\"");
    refused(
        &format!("{HEAD}run.local_damping = 0.2\n{body}"),
        "run.local_damping",
        "clumps",
        "remove it",
    );
}

#[test]
fn materials_that_meet_without_a_word() {
    let other = "materials.other = { density = 1000, young_modulus = 1e7, poisson_ratio = 0.2 }\n";
    let lumps = |of: &str| {
        let far = lump("far", "start_as = \"clump\"\nposition = [1, 0, 0]");
        let far = far.replace("material = \"stuff\"", &format!("material = \"{of}\""));
        format!(
            "{HEAD}{MEETS}{other}{}{far}",
            lump("lump", "start_as = \"clump\"")
        )
    };
    assert!(try_planned(&lumps("stuff")).is_ok());
    refused(&lumps("other"), "[contacts]", "other", "-");
    // Fed bodies meet copies of themselves.
    let fed = format!(
        "{HEAD}{other}contacts.other-stuff = {{ restitution = 0.5 }}\n{}\
         [regions.gate]\nsphere = {{ centre = [0, 0, 0], radius = 0.1 }}\n\
         [inlets.feed]\nbodies = [\"lump\"]\nregion = \"gate\"\nrate = 1\n",
        lump("lump", "")
    );
    refused(&fed, "[contacts]", "stuff-stuff", "add stuff-stuff");
}

#[test]
fn regions_whose_surface_is_open_or_missing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("open.stl");
    let scene = |path: &std::path::Path| {
        let body = lump("lump", "start_as = \"clump\"");
        format!(
            "{HEAD}{body}[regions.room]\nstl = '{}'\nunit = \"m\"\n\
             [replacement.lump]\nwhen = {{ enters = \"room\" }}\n",
            path.display()
        )
    };
    std::fs::write(&path, box_stl([0.0; 3], [1.0; 3], false, true)).unwrap();
    refused(&scene(&path), "[regions.room]", "open", "close");
    let gone = folder.path().join("gone.stl");
    refused(
        &scene(&gone),
        "[regions.room]",
        "cannot be read",
        "check its name",
    );
    std::fs::write(&path, "nothing of the kind").unwrap();
    refused(&scene(&path), "[regions.room]", "", "");
}

#[test]
fn clumps_in_other_bodies_at_the_start() {
    let pair = |name: &str, more: &str| block(name, [2, 1, 1], 2e-3, |_| Some(1e-3), more);
    for (first, second) in [
        ("start_as = \"clump\"", "start_as = \"clump\""),
        ("start_as = \"clump\"", ""),
    ] {
        let text = format!(
            "{HEAD}{MEETS}{}{}",
            pair("upper", &format!("position = [0, 0, 1.9e-3]\n{first}")),
            pair("under", second)
        );
        // Both are named, with the depth of their overlap.
        refused(&text, "test.toml", "'upper'", "move the bodies apart");
        refused(&text, "test.toml", "'under'", "move the bodies apart");
        refused(&text, "test.toml", "0.1 mm", "move the bodies apart");
    }
}
