//! Scenes without an equilibrium, or for which none is found.

use dem_io::Diagnostic;
use dem_plan::plan;
use dem_scene::scene_from_text;

use dem_scene::read_bodies;

/// The error for a scene of a body of these particles and bonds, with these additions.
fn refusal(particles: &str, bonds: &str, more: &str) -> Diagnostic {
    let text = format!(
        r#"version = 1
[run]
end_time = "1 s"
integrator = "static"
[materials.steel]
density = 7850
[bonds.steel]
young_modulus = "200 GPa"
poisson_ratio = 0.3
[bodies.bar]
material = "steel"
bonds = "steel"
particles = [{particles}]
{bonds}
{more}"#
    );
    let scene = scene_from_text(&text, "bar.toml", &[]).unwrap();
    let problem = plan(&scene, read_bodies(&scene).unwrap(), 1, false).expect_err("is refused");
    assert_eq!(problem.exit_code(), 2);
    problem
}

const THREE: &str = "[0, 0, 0, 0.2], [0.4, 0, 0, 0.2], [0.8, 0, 0, 0.2]";
const CLAMP: &str = "[groups.end]\nparticles = [0]\n[supports.end]\ngroup = \"end\"\n";

#[test]
fn a_body_that_nothing_holds() {
    let said = refusal(THREE, "bond_list = [[0, 1], [1, 2]]", "").to_string();
    assert_eq!(
        said,
        "bar.toml: run.integrator: the piece of 3 particles with particle 0 of the body 'bar' is not held: 6 of its 6 rigid motions are free, so that \"static\" has no equilibrium to find; hold more of it by [supports]; fixed = true on some particles is enough"
    );
}

#[test]
fn a_body_that_is_held_too_little() {
    for (fixed, free) in [
        (
            r#"fixed = ["x", "y", "z"]"#,
            "3 of its 6 rigid motions are free",
        ),
        (
            r#"fixed = ["x", "y", "z", "rx", "ry"]"#,
            "1 of its 6 rigid motions is free",
        ),
        (
            r#"fixed = ["rx", "ry", "rz"]"#,
            "3 of its 6 rigid motions are free",
        ),
    ] {
        let said = refusal(
            THREE,
            "bond_list = [[0, 1], [1, 2]]",
            &format!("{CLAMP}{fixed}"),
        )
        .to_string();
        assert!(said.contains(free), "{said}");
    }
    // Two points fix all motions except the rotation about the line through them.
    let hinges = "[groups.ends]\nparticles = [0, 2]\n[supports.ends]\ngroup = \"ends\"\nfixed = [\"x\", \"y\", \"z\"]";
    let said = refusal(THREE, "bond_list = [[0, 1], [1, 2]]", hinges).to_string();
    assert!(said.contains("1 of its 6 rigid motions is free"), "{said}");
}

#[test]
fn a_piece_that_is_not_held() {
    let said = refusal(
        "[0, 0, 0, 0.2], [0.4, 0, 0, 0.2], [0.8, 0, 0, 0.2], [1.2, 0, 0, 0.2]",
        "bond_list = [[0, 1], [2, 3]]",
        &format!("{CLAMP}fixed = true"),
    )
    .to_string();
    assert!(
        said.contains("the piece of 2 particles with particle 2 of the body 'bar'"),
        "{said}"
    );
}

#[test]
fn a_particle_without_a_bond() {
    let said = refusal(
        THREE,
        "bond_list = [[0, 1]]",
        &format!("{CLAMP}fixed = true"),
    )
    .to_string();
    assert!(
        said.contains("particle 2 of the body 'bar' has no bond"),
        "{said}"
    );
    assert!(
        said.contains("hold all its freedoms by [supports], or bond it"),
        "{said}"
    );
}

#[test]
fn a_body_without_bonds() {
    let said = refusal(THREE, "", &format!("{CLAMP}fixed = true")).to_string();
    assert!(
        said.starts_with("bar.toml: [bodies.bar]: the body has no bonds"),
        "{said}"
    );
}
