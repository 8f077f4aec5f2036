//! The page says what the summary says.

use serde_json::json;

use super::made_run::{Moment, folder_with, out, page_of, summary};

const MOMENTS: [Moment; 1] = [Moment {
    time_s: 0.0,
    particles: 3,
}];

#[test]
fn verdict_results_input_and_time_are_there() {
    let folder = folder_with(&MOMENTS);
    let page = page_of(&folder, &summary());
    for text in [
        "<title>drop</title>",
        "Sound: all checks passed.",
        "20 ms simulated in 1.5 s on 2 threads, ended by end time; dem-run 0.1.0.",
        "height",
        "250 mm",
        "broken in tension",
        "seed 7",
        "Set: run.end_time=0.02.",
        "cake.vtp",
        "run.gravity = [0, 0, -9.81] m/s2",
        "bond forces",
        "75 %",
        "0.9 of the largest stable one",
        "Inactive, at no cost: loads.",
    ] {
        assert!(page.contains(text), "{text}");
    }
    assert!(!page.contains("in shear"), "no bond broke in shear");
    assert!(!page.contains("somebody"), "folders are not named");
}

/// The share of the largest fragment stands once, whether or not the scene measures it.
#[test]
fn the_largest_fragment_stands_once() {
    let folder = folder_with(&MOMENTS);
    let mut summary = summary();
    summary["fragments"] = json!({"count": 4, "inside": 4, "mass_fraction_of_largest": 0.82});
    let line = "largest fragment, share";
    assert!(page_of(&folder, &summary).contains(line));
    summary["measures"] = json!({"piece": {"value": 0.82, "unit": ""}});
    assert!(page_of(&folder, &summary).contains(line));
    summary["inputs"]["scene"]["measures.piece.quantity"] = json!("mass_fraction_of_largest");
    let page = page_of(&folder, &summary);
    assert!(page.contains("0.82") && !page.contains(line));
}

/// Only walls that move to and fro have a stroke.
#[test]
fn belts_have_no_column_of_strokes() {
    let folder = folder_with(&MOMENTS);
    let mut summary = summary();
    summary["walls"] = json!({"belt": {"work_j": 1.0, "mean_power_w": 2.0}});
    assert!(!page_of(&folder, &summary).contains("stroke"));
    summary["walls"]["jaw"] = json!({"stroke_m": 0.01, "work_j": 3.0, "mean_power_w": 4.0});
    let page = page_of(&folder, &summary);
    assert!(page.contains("stroke") && page.contains("10 mm"));
}

/// A `scene.toml` has the name of its folder, also if it was named from within.
#[test]
fn a_scene_has_the_name_of_its_folder() {
    let place = tempfile::tempdir().unwrap();
    let title = |scene: &str, results: &str| {
        let results = place.path().join("mill").join(results);
        std::fs::create_dir_all(&results).unwrap();
        let mut summary = summary();
        summary["scene"] = json!(scene);
        let page = dem_report::report(&results, &summary.to_string()).unwrap();
        let (_, rest) = page.split_once("<title>").unwrap();
        rest.split_once("</title>").unwrap().0.to_owned()
    };
    assert_eq!(title("/home/somebody/drop/scene.toml", "scene-out"), "drop");
    assert_eq!(title("scene.toml", "scene-out"), "mill");
    assert_eq!(title("scene.toml", "second"), "second");
    assert_eq!(title("silo.toml", "scene-out"), "silo");
}

#[test]
fn warnings_come_first_and_without_folders() {
    let folder = folder_with(&MOMENTS);
    let mut summary = summary();
    summary["verdict"] = json!({
        "word": "doubtful",
        "sound": false,
        "warnings": ["body 'cake' (/home/somebody/mill/cake.vtp): few particles <across>"],
    });
    let page = page_of(&folder, &summary);
    let warning = "body 'cake' (cake.vtp): few particles &lt;across&gt;";
    let [warned, view] = [warning, "id=\"view\""].map(|text| page.find(text).expect(text));
    assert!(warned < view);
    assert!(page.contains("Doubtful: 1 warning."));
}

#[test]
fn a_run_that_failed_has_a_page() {
    let folder = folder_with(&[]);
    let failed = json!({
        "scene": "drop.toml", "program": "dem-run 0.1.0", "ended_by": "failure",
        "problem": "disk full", "inputs": {"scene": {}, "set": [], "seed": 0},
    });
    let page = page_of(&folder, &failed);
    assert!(page.contains("disk full"));
    assert!(!page.contains("NaN"), "{page}");
}

#[test]
fn names_cannot_break_out_of_the_page() {
    let folder = folder_with(&MOMENTS);
    let mut summary = summary();
    let name = "</script><script>alert(1)</script>";
    summary["measures"] = json!({name: {"value": 1.0, "unit": name}});
    summary["scene"] = json!(format!("{name}.toml"));
    summary["inputs"]["bodies"] = json!({name: {"file": name, "particles": 1, "bonds": 0}});
    let page = page_of(&folder, &summary);
    assert!(!page.contains("<script>alert"), "a name became an element");
}

#[test]
fn what_is_no_summary_is_refused() {
    let folder = folder_with(&MOMENTS);
    for text in ["", "no JSON", "[1, 2"] {
        let error = dem_report::report(&out(&folder), text).unwrap_err();
        assert_eq!(error.exit_code(), 2, "{text}");
        assert!(error.to_string().contains("summary.json"), "{error}");
    }
}

#[test]
fn the_same_folder_gives_the_same_bytes() {
    let folder = folder_with(&MOMENTS);
    assert_eq!(page_of(&folder, &summary()), page_of(&folder, &summary()));
}

#[test]
fn a_coarse_run_says_why() {
    let folder = folder_with(&MOMENTS);
    let mut summary = summary();
    summary["verdict"] = json!({
        "word": "coarse",
        "sound": false,
        "warnings": [],
        "coarse": ["body 'cake': only about 3 particles across"],
    });
    let page = page_of(&folder, &summary);
    assert!(page.contains("class=\"verdict coarse\""));
    assert!(page.contains("Coarse: the result is that of these spheres"));
    assert!(page.contains("only about 3 particles across"));
}
