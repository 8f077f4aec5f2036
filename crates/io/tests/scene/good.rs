//! What good files say.

use std::path::{Path, PathBuf};

use dem_io::scene::{
    At, BodySource, BondDamping, BondFailure, BondModel, Factor, Formulation, Hold, Pick, Quantity,
    Scene,
};
use dem_io::{read_scene, scene_from_text};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scene/good")
}

fn good(name: &str) -> Scene {
    read_scene(&folder().join(name), &[]).unwrap()
}

#[track_caller]
fn assert_near(got: f64, wanted: f64) {
    assert!(
        (got - wanted).abs() <= 4.0 * f64::EPSILON * wanted.abs(),
        "{got} is not {wanted}"
    );
}

#[test]
fn the_run() {
    let run = good("every-key.toml").run;
    assert_eq!(run.end_time_s, 0.5);
    assert_eq!(run.rest, Some(1e-9));
    assert_near(run.time_step_s.unwrap(), 2e-6);
    assert_eq!(run.safety, 0.8);
    assert_eq!(run.gravity_m_s2, [0.0, -9.81, 0.0]);
    assert_eq!(run.particle_damping, 0.7);
    assert_eq!(run.seed, u64::MAX);
}

#[test]
fn materials() {
    let scene = good("every-key.toml");
    let cake = &scene.materials["cake"];
    assert_near(cake.density_kg_m3.unwrap(), 2050.0);
    assert_near(cake.young_modulus_pa.unwrap(), 25e6);
    assert_eq!(cake.poisson_ratio, 0.25);
    let steel = &scene.materials["steel"];
    assert_eq!(steel.density_kg_m3, None);
    assert_eq!(steel.young_modulus_pa, Some(210e9));
    assert_eq!(steel.poisson_ratio, 0.3);
}

#[test]
fn bonds() {
    let scene = good("every-key.toml");
    let parallel = &scene.bonds["parallel"];
    assert_eq!(parallel.model, BondModel::Parallel { kappa: Some(2.5) });
    assert_eq!(parallel.formulation, Formulation::Incremental);
    assert_near(parallel.young_modulus_pa, 12.05e6);
    assert_eq!(parallel.poisson_ratio, 0.3);
    assert_eq!(parallel.radius_factor, Some(0.5));
    assert_eq!(
        parallel.damping,
        BondDamping {
            viscous: 0.1,
            each_mode: true,
            force_n_s_m: 3.0,
            torque: 1.0
        }
    );
    assert_eq!(
        parallel.failure,
        BondFailure {
            tension_pa: Some(1e6),
            shear_pa: Some(2e6),
            compressive: false,
            von_mises_pa: Some(3e6),
            rate_strengthening_from_1_s: Some(1e-5),
            weibull_modulus: Some(7.0),
        }
    );
    let sheared = &scene.bonds["sheared"];
    assert_eq!(sheared.model, BondModel::ShearCoefficient { alpha: 0.85 });
    assert_eq!(sheared.formulation, Formulation::Total);
    assert_eq!(sheared.radius_factor, None);
    assert_eq!(sheared.damping, BondDamping::default());
    assert_eq!(sheared.failure.rate_strengthening_from_1_s, Some(4.64e-6));
    assert!(sheared.failure.compressive);
}

#[test]
fn bodies() {
    let scene = good("every-key.toml");
    let bar = &scene.bodies["bar"];
    let BodySource::Inline { particles, bonds } = &bar.source else {
        panic!("{:?}", bar.source);
    };
    assert_eq!(
        *particles,
        [
            [0.0, 0.0, 0.0, 0.001],
            [0.002, 0.0, 0.0, 0.001],
            [0.004, 0.0, 0.0, 0.001]
        ]
    );
    assert_eq!(*bonds, [[0, 1], [1, 2]]);
    assert_eq!(bar.material, "cake");
    assert_eq!(bar.bond_kind.as_deref(), Some("parallel"));
    assert_eq!(bar.position_m, [0.01, 0.0, -0.001]);
    assert_eq!(bar.rotation_rad[..2], [0.0, 0.0]);
    assert_near(bar.rotation_rad[2], std::f64::consts::FRAC_PI_2);
    assert_eq!(bar.velocity_m_s[..2], [3.0, 0.0]);
    assert_near(bar.velocity_m_s[2], 10.0);
    assert_near(bar.angular_velocity_rad_s[1], std::f64::consts::PI);
    assert_eq!(bar.angular_velocity_rad_s[2], 2.0);
    let file = |name: &str| scene.bodies[name].source.clone();
    assert_eq!(
        file("tool"),
        BodySource::File(folder().join("shapes/tool.vtp"))
    );
    assert_eq!(file("piped"), BodySource::File(PathBuf::from("-")));
    assert_eq!(scene.bodies["tool"].bond_kind, None);
}

#[test]
fn sets() {
    let scene = good("every-key.toml");
    let left = &scene.sets["left-end"];
    assert_eq!(left.body.as_deref(), Some("bar"));
    assert_eq!(left.pick, Pick::Particles(vec![0]));
    assert_eq!(scene.sets["tool_all"].pick, Pick::All);
    assert_eq!(scene.sets["near"].body, None);
    assert_eq!(
        scene.sets["near"].pick,
        Pick::Box {
            min: [-0.001; 3],
            max: [0.001; 3]
        }
    );
    assert_eq!(
        scene.sets["round"].pick,
        Pick::Sphere {
            centre: [0.0; 3],
            radius: 0.005
        }
    );
}

#[test]
fn supports_and_loads() {
    let scene = good("every-key.toml");
    assert_eq!(scene.supports["wall"].holds, [Some(Hold::Fixed); 6]);
    assert_eq!(scene.supports["wall"].factor, Factor::One);
    let pull = &scene.supports["pull"];
    assert_eq!(pull.of, "near");
    assert_eq!(
        pull.holds,
        [
            Some(Hold::Velocity(0.01)),
            Some(Hold::Displacement(0.001)),
            Some(Hold::Fixed),
            Some(Hold::Fixed),
            Some(Hold::Displacement(0.001)),
            Some(Hold::Velocity(90.0 * (std::f64::consts::PI / 180.0))),
        ]
    );
    assert_eq!(pull.factor, Factor::Ramp { until_s: 0.01 });
    assert_eq!(
        scene.supports["shake"].factor,
        Factor::Table(vec![[0.0, 0.0], [0.005, 1.0], [0.01, -0.5]])
    );
    let press = &scene.loads["press"];
    assert_eq!(press.of, "all");
    assert_eq!(press.force_n, [100e3, 0.0, -0.001]);
    assert_eq!(press.torque_n_m, [0.0, 2.0, 0.0]);
    assert_eq!(scene.loads["turn"].torque_n_m, [0.0, 0.0, 0.003]);
    assert_eq!(scene.loads["turn"].factor, Factor::Ramp { until_s: 0.1 });
}

#[test]
fn measures_and_output() {
    let scene = good("every-key.toml");
    let bending = &scene.measures["bending"];
    assert_eq!(bending.of, "left-end");
    assert_eq!(bending.quantity, Quantity::Displacement(1));
    assert_eq!(bending.at, At::Largest);
    assert_near(bending.reference.unwrap(), 0.0015);
    assert_eq!(bending.tolerance, Some(0.02));
    let energy = &scene.measures["energy"];
    assert_eq!((energy.of.as_str(), energy.at), ("all", At::End));
    assert_eq!((energy.reference, energy.tolerance), (None, None));
    let output = scene.output.unwrap();
    assert_eq!(output.folder, Some(folder().join("results")));
    assert_eq!(output.frames_s, Some(0.005));
    assert_eq!(output.series_s, Some(0.0005));
    assert_eq!(output.checkpoint_s, Some(0.1));
}

/// The shortest scene, and what all its defaults are.
#[test]
fn defaults_in_words() {
    let scene = good("shortest.toml");
    assert_eq!(scene.output, None);
    let wanted = "\
run.end_time                    1 s
run.rest                        never
run.time_step                   auto
run.safety                      0.9
run.gravity                     [0, 0, 0] m/s2
run.particle_damping            0
run.seed                        0
materials.clay.density          from the body's file
materials.clay.young_modulus    none
materials.clay.poisson_ratio    0.3
bodies.block.file               block.vtp
bodies.block.material           clay
bodies.block.bonds              none
bodies.block.position           [0, 0, 0] m
bodies.block.rotation           [0, 0, 0] rad
bodies.block.velocity           [0, 0, 0] m/s
bodies.block.angular_velocity   [0, 0, 0] rad/s
output                          none
";
    let text = std::fs::read_to_string(folder().join("shortest.toml")).unwrap();
    let scene = scene_from_text(&text, "shortest.toml", &[]).unwrap();
    assert_eq!(scene.describe(), wanted);
}

/// The echo names every key of the file that says them all.
#[test]
fn values_in_words() {
    let text = good("every-key.toml").describe();
    for line in [
        "materials.cake.young_modulus 2.5e7 Pa",
        "bonds.parallel.kappa 2.5",
        "bonds.parallel.damping.force 3 N s/m",
        "bodies.bar.particles 3 in the scene",
        "bodies.bar.position [0.01, 0, -0.001] m",
        "supports.pull.x velocity 0.01 m/s",
        "supports.wall.rz fixed",
        "supports.shake.table 0 s: 0, 0.005 s: 1, 0.01 s: -0.5",
        "loads.press.force [100000, 0, -0.001] N",
        "measures.bending.reference 0.0015 m",
        "output.frames 0.005 s",
    ] {
        let (key, value) = line.split_once(' ').unwrap();
        assert!(
            text.lines().any(|other| other
                .split_once(' ')
                .is_some_and(|(other, rest)| other == key && rest.trim() == value)),
            "{line}\n{text}"
        );
    }
}
