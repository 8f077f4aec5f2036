//! Fragments extracted from a run as bodies, by the program.

use std::path::Path;
use std::process::{Command, Output};

use dem_engine::step::{interact, step};
use dem_io::body::read_frame;
use dem_io::body::{body_summary, read_body};
use dem_plan::plan;
use dem_results::{Existing, ResultsFolder};
use dem_scene::BodySource;

use super::burst::{burst, bursting, planned, run_into};
use dem_scene::read_bodies;

fn fragment(folder: &Path, options: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_dem-run"))
        .current_dir(folder)
        .args(["fragment", "out"])
        .args(options)
        .output()
        .unwrap()
}

fn good(folder: &Path, options: &[&str]) -> String {
    let output = fragment(folder, options);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{said}");
    String::from_utf8(output.stdout).unwrap()
}

fn bad(folder: &Path, options: &[&str]) -> String {
    let output = fragment(folder, options);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(output.stdout.is_empty() && said.matches('\n').count() == 1);
    said
}

#[test]
fn every_fragment_of_the_last_frame_is_a_body() {
    let (parent, folder, summary) = burst();
    let here = parent.path();
    let frame = read_frame(&folder.frame(5)).unwrap();
    assert_eq!(frame.time_s, summary.simulated_s);
    let fragments = frame.fragments();
    assert_eq!(fragments.len(), summary.fragments.unwrap().count);
    let mut bonds = 0;
    for one in &fragments {
        let id = one.id.to_string();
        let said = good(here, &["--id", &id, "-o", "piece.vtp"]);
        assert!(
            said.starts_with(&format!("fragment {id} at 0.0005")),
            "{said}"
        );
        assert!(said.contains(&format!("-> piece.vtp: {} particles, ", one.particles)));
        let body = read_body(&here.join("piece.vtp")).unwrap();
        let places: Vec<[f64; 3]> = (0..frame.clusters.len())
            .filter(|i| frame.clusters[*i] == one.id)
            .map(|i| frame.positions[i])
            .collect();
        assert_eq!(body.positions, places);
        assert_eq!(body.about.particle_density_kg_m3, Some(2050.0));
        let source = body.about.source.clone().unwrap();
        assert!(
            source.ends_with(&format!("frame_000005.vtp: fragment {id}")),
            "{source}"
        );
        assert_eq!(body_summary(&body).pieces, 1, "{}", body.bonds.len());
        bonds += body.bonds.len() as u64;
    }
    assert_eq!(bonds, summary.bonds as u64 - summary.broken_bonds);
}

#[test]
fn the_first_frame_gives_back_the_body_under_the_stress_that_it_began_with() {
    let parent = tempfile::tempdir().unwrap();
    let folder = ResultsFolder::create(&parent.path().join("out"), Existing::Refuse).unwrap();
    let mut scene = bursting();
    scene.run.end_time_s = 1e-6;
    let mut bodies = read_bodies(&scene).unwrap();
    let rod = bodies.get_mut("rod").unwrap();
    for (bond, length) in rod.bond_lengths.iter_mut().enumerate() {
        *length *= 1.0 + 1e-4 * (bond % 3) as f64;
    }
    for (bond, radius) in rod.bond_radii.iter_mut().enumerate() {
        *radius *= 1.0 - 1e-3 * (bond % 5) as f64;
    }
    let wanted = rod.clone();
    let stressed = plan(&scene, bodies, 1, false).unwrap();
    let mut begun = stressed.clone();
    begun.state.clusters = planned(&scene).state.clusters;
    run_into(&folder, begun, &scene, None, 2.0).unwrap();
    let here = parent.path();
    good(here, &["--largest", "--frame", "0", "-o", "rod.vtp"]);
    let read = read_body(&here.join("rod.vtp")).unwrap();
    assert_eq!(read.positions, wanted.positions);
    assert_eq!(read.radii, wanted.radii);
    assert_eq!(read.bonds, wanted.bonds);
    assert_eq!(read.bond_radii, wanted.bond_radii);
    for (read, wanted) in read.bond_lengths.iter().zip(&wanted.bond_lengths) {
        assert!((read / wanted - 1.0).abs() < 1e-15);
    }
    // It can be run again, and its bonds have the same forces.
    let mut bodies = read_bodies(&scene).unwrap();
    bodies.insert("rod".to_owned(), read);
    let again = plan(&scene, bodies, 1, false).unwrap();
    let mut loads = [stressed, again].map(|plan| plan.state);
    for state in &mut loads {
        interact(state);
    }
    let [before, after] = loads.map(|state| state.particles.wrenches);
    let largest = before
        .iter()
        .map(|w| w.force_n[0].abs())
        .fold(0.0, f64::max);
    assert!(largest > 0.1, "{largest} N");
    for (before, after) in before.iter().zip(&after) {
        for k in 0..3 {
            let apart = (before.force_n[k] - after.force_n[k]).abs();
            assert!(apart < 1e-9 * largest, "{apart} N");
        }
    }
}

#[test]
fn a_fragment_runs_again_from_any_format() {
    let (parent, _, _) = burst();
    let here = parent.path();
    good(here, &["--largest", "-o", "piece.vtp", "-q"]);
    let piped = fragment(here, &["--largest"]);
    assert!(piped.status.success() && piped.stderr.is_empty());
    assert_eq!(piped.stdout, std::fs::read(here.join("piece.vtp")).unwrap());
    let wanted = read_body(&here.join("piece.vtp")).unwrap();
    for name in ["piece.vtp", "piece.csv", "piece.data", "piece.txt"] {
        good(here, &["--largest", "-o", name]);
        let mut scene = bursting();
        scene.bodies.remove("pair");
        scene.bodies.get_mut("rod").unwrap().source = BodySource::File(here.join(name));
        let mut plan = plan(&scene, read_bodies(&scene).unwrap(), 1, false).unwrap();
        assert_eq!(plan.state.particles.len(), wanted.positions.len(), "{name}");
        assert_eq!(plan.state.bonds.len(), wanted.bonds.len(), "{name}");
        (0..100).for_each(|_| {
            step(&mut plan.state);
        });
        let places = &plan.state.particles.poses;
        assert!(places.iter().all(|pose| pose.position_m[0].is_finite()));
    }
}

#[test]
fn what_cannot_be_written_is_told() {
    let (parent, folder, _) = burst();
    let here = parent.path();
    let said = bad(here, &["--id", "999", "-o", "piece.vtp"]);
    assert!(
        said.contains("frame_000005.vtp: there is no fragment 999 at 0.0005 s"),
        "{said}"
    );
    assert!(said.contains("; the heaviest are "), "{said}");
    // The rod ended when it broke; it exists in the first frame.
    bad(here, &["--id", "1", "-o", "piece.vtp"]);
    assert!(!here.join("piece.vtp").exists());
    good(here, &["--id", "1", "--frame", "0", "-o", "piece.vtp"]);
    let said = bad(here, &["--largest", "--frame", "6", "-o", "piece.vtp"]);
    assert_eq!(
        said,
        "error: --frame 6: there is no such frame in out; frames 0 to 5 are there\n"
    );
    let said = bad(here, &["--largest", "-o", "none/piece.vtp"]);
    assert!(
        said.contains("none/piece.vtp: there is no folder 'none'; make it first"),
        "{said}"
    );
    let said = bad(here, &["--largest", "-o", "piece.xyz"]);
    assert!(
        said.starts_with("error: piece.xyz: '.xyz' is not the ending of a body"),
        "{said}"
    );
    for number in 0..6 {
        std::fs::remove_file(folder.frame(number)).unwrap();
    }
    let said = bad(here, &["--largest", "-o", "piece.vtp"]);
    assert!(
        said.starts_with("error: out: there are no frames in this folder"),
        "{said}"
    );
    std::fs::remove_dir_all(folder.path()).unwrap();
    let said = bad(here, &["--largest", "-o", "piece.vtp"]);
    assert!(
        said.starts_with("error: out: there is no such folder"),
        "{said}"
    );
    for options in [&[][..], &["--largest", "--id", "3"]] {
        assert_eq!(fragment(here, options).status.code(), Some(2));
    }
}

#[test]
fn all_loose_spheres_are_one_body() {
    // The spheres that have lost all their bonds, as the list of fragments says.
    let (parent, _, _) = burst();
    let folder = parent.path();
    let said = good(folder, &["--loose", "-o", "loose.vtp"]);
    let loose = read_body(&folder.join("loose.vtp")).unwrap();
    let last = dem_results::folder::frames_in(&folder.join("out")).unwrap();
    let path = dem_results::folder::frame_in(&folder.join("out"), *last.last().unwrap());
    let frame = read_frame(&path).unwrap();
    let single: Vec<_> = frame
        .fragments()
        .into_iter()
        .filter(|f| f.particles == 1)
        .collect();
    assert!(single.len() > 1 && single.len() < frame.radii.len());
    assert_eq!(loose.radii.len(), single.len());
    assert!(loose.bonds.is_empty());
    assert!(
        said.contains(&format!(
            "{} of {} particles",
            single.len(),
            frame.radii.len()
        )),
        "{said}"
    );
    let mass = dem_io::body::mass::of_named_density(&loose).unwrap();
    let wanted_kg: f64 = single.iter().map(|fragment| fragment.mass_kg).sum();
    assert!((mass.mass_kg / wanted_kg - 1.0).abs() < 1e-12);
    let mut centre = [0.0; 3];
    for fragment in &single {
        let i = frame
            .clusters
            .iter()
            .position(|id| *id == fragment.id)
            .unwrap();
        assert!(loose.positions.contains(&frame.positions[i]));
        for (sum_m, place_m) in centre.iter_mut().zip(frame.positions[i]) {
            *sum_m += fragment.mass_kg * place_m / wanted_kg;
        }
    }
    for (found_m, wanted_m) in mass.centre_m.iter().zip(centre) {
        assert!((found_m - wanted_m).abs() < 1e-12, "{centre:?}");
    }
    let source = loose.about.source.unwrap();
    assert!(source.ends_with(": loose spheres"), "{source}");
}

#[test]
fn a_frame_without_loose_spheres_is_refused() {
    let (folder, _, _) = burst();
    let said = bad(
        folder.path(),
        &["--loose", "--frame", "0", "-o", "loose.vtp"],
    );
    assert!(
        said.contains("spheres is loose") && said.contains("--largest"),
        "{said}"
    );
    assert!(!folder.path().join("loose.vtp").exists());
}
