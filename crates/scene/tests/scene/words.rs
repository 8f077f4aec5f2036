//! The values of a scene in words.

use dem_scene::{Scene, read_scene, scene_from_text};

use super::good::{folder, good};

/// The shortest scene, and what all its defaults are.
#[test]
fn defaults_in_words() {
    let scene = good("shortest.toml");
    assert_eq!(scene.output, None);
    let wanted = "\
run.end_time                    1 s
run.integrator                  leapfrog
run.rest_energy_ratio           never
run.time_step                   auto
run.safety_factor               0.9
run.impact_accuracy             0.01
run.adaptive                    false
run.gravity                     [0, 0, 0] m/s2
run.local_damping               0
run.seed                        0
run.initial_overlap             refuse
materials.clay.density          from the body, where one needs it
materials.clay.young_modulus    none
materials.clay.poisson_ratio    0.3
bodies.block.file               block.vtp
bodies.block.material           clay
bodies.block.sieve_size         the size of its file
bodies.block.mass               that of its particles
bodies.block.bonds              none
bodies.block.position           [0, 0, 0] m
bodies.block.position_of        origin
bodies.block.rotation           [0, 0, 0] rad
bodies.block.velocity           [0, 0, 0] m/s
bodies.block.angular_velocity   [0, 0, 0] rad/s
bodies.block.start_as           bonded
output                          none
";
    let text = std::fs::read_to_string(folder().join("shortest.toml")).unwrap();
    let scene = scene_from_text(&text, "shortest.toml", &[]).unwrap();
    assert_eq!(scene.describe(), wanted);
}

/// The echo names every key of the file that gives them all.
#[test]
fn values_in_words() {
    let text = good("every-key.toml").describe();
    for line in [
        "materials.cake.young_modulus 2.5e7 Pa",
        "bodies.bar.mass that of its particles",
        "bodies.piped.body_density 1800 kg/m3",
        "bodies.tool.mass 1.2 kg",
        "run.initial_overlap relax",
        "contacts.belt-rubber-cake.law linear",
        "contacts.belt-rubber-cake.normal_stiffness 100000 N/m",
        "contacts.belt-rubber-cake.tangential_stiffness_ratio 0.5",
        "contacts.belt-rubber-cake.rolling constant-torque",
        "contacts.cake-cake.law hertz-mindlin",
        "contacts.cake-cake.restitution 1",
        "contacts.cake-cake.friction 0.6",
        "contacts.cake-cake.rolling spring-dashpot",
        "contacts.cake-cake.rolling_friction 0.1",
        "contacts.cake-cake.rolling_damping_ratio 0.5",
        "walls.floor.plane.point [0, 0, -0.01] m",
        "walls.floor.plane.normal [0, 0, 1]",
        "walls.floor.motion fixed",
        "walls.belt.box.min [-2, -0.3, -0.02] m",
        "walls.belt.surface_velocity [3, 0, 0] m/s",
        "walls.pin.cylinder.radius 0.005 m",
        "walls.pin.angular_velocity [0, 3.14159265359, 0] rad/s",
        "walls.pin.ramp 0.01 s",
        "walls.plate.unit 0.001 m",
        "walls.plate.scale 0.5",
        "walls.plate.angular_displacement [0, 12.5663706144, 0] rad",
        "walls.plate.table 0 s: 0, 0.005 s: 1",
        "walls.punch.servo.force 1000 N",
        "walls.punch.servo.direction [0, 0, -1]",
        "walls.punch.servo.max_velocity 0.01 m/s",
        "measures.pieces.reference 0.02 kg",
        "clusters.self_contact false",
        "relaxation.enabled false",
        "relaxation.min_overlap 0",
        "search.skin 0.5",
        "sleep.speed 0.002 m/s",
        "sleep.after 0.01 s",
        "supports.swing.rx velocity 0.10471975512 rad/s",
        "supports.turn.z displacement 1e-6 m",
        "bonds.parallel.stiffness_ratio 2.5",
        "bonds.parallel.damping.damping_coefficient 3 N s/m",
        "bodies.bar.particles 3 in the scene",
        "bodies.bar.position [0.01, 0, -0.001] m",
        "supports.pull.x velocity 0.01 m/s",
        "supports.wall.rz fixed",
        "supports.shake.table 0 s: 0, 0.005 s: 1, 0.01 s: -0.5",
        "loads.press.force [100000, 0, -0.001] N",
        "loads.press.end 0.001 s",
        "loads.turn.end never",
        "supports.pull.end 0.02 s",
        "initial.tip.velocity [0.003, 0, 0] m/s",
        "initial.tip.displacement [0, -1e-6, 0] m",
        "materials.anvil.rigid true",
        "measures.bending.reference 0.0015 m",
        "measures.bending.absolute_tolerance none",
        "measures.hit.with punch",
        "measures.hit.absolute_tolerance 1e-5 m",
        "output.frames 0.005 s",
        "output.pictures 0.01 s",
        "output.view.from [0.6, -0.8, 0]",
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

/// If objects can touch, all contact values are listed, with their defaults; if nothing can touch,
/// only those given.
#[test]
fn words_on_contacts() {
    let said = |scene: &Scene| -> Vec<String> {
        let of_contacts = |line: &&str| {
            ["clusters.", "relaxation.", "search.", "sleep."]
                .iter()
                .any(|table| line.starts_with(table))
        };
        let text = scene.describe();
        let lines = text.lines().filter(of_contacts);
        let words = lines.map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
        words.collect()
    };
    assert_eq!(
        said(&good("touching.toml")),
        [
            "clusters.self_contact true",
            "relaxation.enabled true",
            "relaxation.min_overlap 0",
            "search.skin chosen by the program",
        ]
    );
    let options = ["search.skin=0.1".to_owned()];
    let scene = read_scene(&folder().join("shortest.toml"), &options).unwrap();
    assert_eq!(said(&scene), ["search.skin 0.1"]);
    let options = ["sleep.speed=\"2 mm/s\"".to_owned()];
    let scene = read_scene(&folder().join("shortest.toml"), &options).unwrap();
    assert_eq!(
        said(&scene),
        ["sleep.speed 0.002 m/s", "sleep.after 0.05 s"]
    );
}
