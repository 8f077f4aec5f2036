//! The contents of valid files.

use std::path::{Path, PathBuf};

use dem_io::units::DIMENSIONS;
use dem_physics::bond::failure::EquivalentStress;
use dem_physics::bond::flat_joint::{FlatJointLaw, moment_ratio};
use dem_physics::bond::rate_strengthening::IncreaseCurve;
use dem_physics::bond::stiffness::BondModel;
use dem_physics::contact::law::Rolling;
use dem_physics::contact::rolling::{ConstantMoment, ElasticPlastic};
use dem_scene::{
    BodySource, BondDamping, BondFailure, BondPlasticity, BoxShape, Clusters, ColourBy, Contact,
    ContactLaw, CylinderShape, Factor, Formulation, Hold, InitialOverlap, Integrator, Pick,
    PlaneShape, QUANTITIES, Relaxation, Scene, Search, SphereShape, Statistic, StrainRateMeasure,
    Wall, WallLoads, WallMotion, WallShape,
};
use dem_scene::{read_scene, scene_from_text};

pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scene/good")
}

pub(crate) fn good(name: &str) -> Scene {
    read_scene(&folder().join(name), &[]).unwrap()
}

#[track_caller]
pub(crate) fn assert_near(got: f64, wanted: f64) {
    assert!(
        (got - wanted).abs() <= 4.0 * f64::EPSILON * wanted.abs(),
        "{got} is not {wanted}"
    );
}

/// The example in the documentation is a valid scene.
#[test]
fn the_documentation() {
    let text = include_str!("../../../../doc/scenes.md");
    let (_, rest) = text.split_once("```toml\n").unwrap();
    let (example, _) = rest.split_once("```").unwrap();
    let scene = scene_from_text(example, "doc.toml", &[]).unwrap();
    assert_eq!(scene.walls.len(), 2);
    // Each alternative in a comment is valid as well.
    let ways = [
        ("box = ", "# plane = "),
        ("box = ", "# cylinder = "),
        ("velocity = [0, 0, \"-10", "# displacement = [0, 0, \"-1 mm"),
        ("velocity = [0, 0, \"-10", "# servo = "),
    ];
    for (taken, comment) in ways {
        let walls = example.find("[walls.").unwrap();
        let (before, walls) = example.split_at(walls);
        let other =
            walls
                .replacen(taken, &format!("# {taken}"), 1)
                .replacen(comment, &comment[2..], 1);
        let text = format!("{before}{other}");
        let read = scene_from_text(&text, "doc.toml", &[]).unwrap();
        assert_ne!(read.walls, scene.walls, "{comment}");
    }
}

#[test]
fn the_documentation_lists_every_unit() {
    let text = include_str!("../../../../doc/scene-keys.md");
    for dimension in DIMENSIONS {
        let units: Vec<String> = dimension
            .units
            .iter()
            .map(|(unit, _)| format!("`{unit}`"))
            .collect();
        let row = format!(" | {} |\n", units.join(", "));
        assert!(text.contains(&row), "{}: {row}", dimension.name);
    }
}

#[test]
fn the_run() {
    let run = good("every-key.toml").run;
    assert_eq!(run.end_time_s, 0.5);
    assert_eq!(run.rest_energy_ratio, Some(1e-9));
    assert_near(run.time_step_s.unwrap(), 2e-6);
    assert_eq!(run.safety_factor, 0.8);
    assert_eq!(run.gravity_m_s2, [0.0, -9.81, 0.0]);
    assert_eq!(run.local_damping, 0.7);
    assert_eq!(run.seed, u64::MAX);
    assert_eq!(run.initial_overlap, InitialOverlap::Relax);
    assert_eq!(run.integrator, Integrator::Leapfrog);
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
    assert!(!steel.rigid);
    assert_eq!(scene.materials["belt-rubber"].poisson_ratio, 0.5);
    let anvil = &scene.materials["anvil"];
    assert!(anvil.rigid && anvil.young_modulus_pa.is_none());
}

fn contact(materials: [&str; 2], law: ContactLaw, restitution: f64, rolling: Rolling) -> Contact {
    Contact {
        materials: materials.map(str::to_owned),
        law,
        restitution,
        friction: 0.0,
        rolling,
        liquid_bridge: None,
    }
}

#[test]
fn a_liquid_bridge_belongs_to_any_law() {
    let scene = good("liquid-bridge.toml");
    let [contact] = &scene.contacts[..] else {
        panic!("one pair");
    };
    assert_eq!(contact.law, ContactLaw::HertzMindlin);
    let bridge = contact.liquid_bridge.unwrap();
    assert_near(bridge.surface_tension_n_m, 0.073);
    assert_near(bridge.contact_angle_rad, 20_f64.to_radians());
    assert_near(bridge.volume_m3, 1e-12);
}

#[test]
fn contacts() {
    let linear = |normal_n_m, tangential_stiffness_ratio| ContactLaw::Linear {
        normal_n_m,
        tangential_stiffness_ratio,
    };
    let sprung = |friction, damping_ratio| {
        Rolling::Spring(ElasticPlastic {
            friction,
            damping_ratio,
        })
    };
    let torque = |friction| Rolling::Constant(ConstantMoment { friction });
    let hertz = ContactLaw::HertzMindlin;
    assert_eq!(
        good("every-key.toml").contacts,
        [
            contact(["anvil", "cake"], hertz, 0.5, Rolling::Free),
            Contact {
                friction: 0.1,
                ..contact(["belt-rubber", "cake"], linear(1e5, 0.5), 0.6, torque(0.2))
            },
            Contact {
                friction: 0.6,
                ..contact(["cake", "cake"], hertz, 1.0, sprung(0.1, 0.5))
            },
            Contact {
                friction: 0.4,
                ..contact(["cake", "steel"], hertz, 0.3, torque(0.05))
            },
        ]
    );
    let usual = 2.0 / 7.0;
    assert_eq!(
        good("touching.toml").contacts,
        [
            contact(["a", "a"], hertz, 0.7, Rolling::Free),
            contact(["a", "a-a"], hertz, 0.5, Rolling::Free),
            Contact {
                friction: 0.3,
                ..contact(["a", "b-2"], linear(1e5, usual), 0.9, sprung(0.1, 0.3))
            },
            contact(["b-2", "b-2"], linear(1e3, usual), 1.0, Rolling::Free),
        ]
    );
}

#[test]
fn walls() {
    let walls = good("every-key.toml").walls;
    assert_eq!(
        walls["floor"],
        Wall {
            shape: WallShape::Plane(PlaneShape {
                point_m: [0.0, 0.0, -0.01],
                normal: [0.0, 0.0, 1.0]
            }),
            material: "steel".to_owned(),
            rotation_rad: [0.0; 3],
            pivot_m: [0.0; 3],
            motion: WallMotion::Fixed,
            surface_velocity_m_s: [0.0; 3],
            loads: Some(WallLoads {
                patch_m: Some(0.01),
                wear_constant_1_pa: 1e-13
            }),
        }
    );
    let belt = &walls["belt"];
    assert_eq!(
        belt.shape,
        WallShape::Box(BoxShape {
            min_m: [-2.0, -0.3, -0.02],
            max_m: [0.0, 0.3, 0.0]
        })
    );
    assert_eq!(belt.material, "belt-rubber");
    assert_near(belt.rotation_rad[2], std::f64::consts::FRAC_PI_2);
    assert_eq!(belt.pivot_m, [0.0, 0.0, 0.01]);
    assert_eq!(belt.surface_velocity_m_s, [3.0, 0.0, 0.0]);
    assert_eq!(
        walls["pin"].shape,
        WallShape::Cylinder(CylinderShape {
            from_m: [0.0, -0.01, 0.0],
            to_m: [0.0, 0.01, 0.0],
            radius_m: 0.005
        })
    );
    assert_eq!(
        walls["plate"].shape,
        WallShape::Stl {
            path: folder().join("shapes/plate.stl"),
            unit_m: Some(1e-3),
            scale: 0.5
        }
    );
    let WallShape::Plane(plane) = good("touching.toml").walls["ground"].shape else {
        panic!("no plane");
    };
    assert_near(plane.normal[1], 0.6);
    assert_near(plane.normal[2], 0.8);
}

#[test]
fn motions_of_walls() {
    let walls = good("every-key.toml").walls;
    assert_eq!(
        walls["pin"].motion,
        WallMotion::Velocity {
            velocity_m_s: [0.0, 0.0, -0.01],
            spin_rad_s: [0.0, std::f64::consts::PI, 0.0],
            factor: Factor::Ramp { until_s: 0.01 },
        }
    );
    assert_eq!(
        walls["plate"].motion,
        WallMotion::Displacement {
            displacement_m: [0.0, 0.0, -0.001],
            angular_displacement_rad: [0.0, 4.0 * std::f64::consts::PI, 0.0],
            factor: Factor::Table(vec![[0.0, 0.0], [0.005, 1.0]]),
        }
    );
    assert_eq!(
        walls["punch"].motion,
        WallMotion::Servo {
            force_n: 1000.0,
            direction: [0.0, 0.0, -1.0],
            max_velocity_m_s: 0.01,
            factor: Factor::Ramp { until_s: 0.001 },
        }
    );
    // Only the part of a direction normal to the axis counts.
    let WallMotion::Orbit(orbit) = walls["deck"].motion else {
        panic!("no orbit");
    };
    assert_eq!(
        (orbit.axis, orbit.towards),
        ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0])
    );
    assert_eq!((orbit.radius_m, orbit.frequency_hz), (0.004, 15.0));
    let WallMotion::Gyration(gyration) = walls["mantle"].motion else {
        panic!("no gyration");
    };
    assert_eq!(gyration.axis, [0.0, 0.0, 1.0]);
    assert_eq!(gyration.towards, [0.0, 1.0, 0.0]);
    assert_near(gyration.angle_rad, 1_f64.to_radians());
    assert_eq!(gyration.frequency_hz, 5.0);
    assert_near(gyration.spin_rad_s, -std::f64::consts::PI / 3.0);
    // A single key of one type of motion leaves the others unset.
    let walls = good("touching.toml").walls;
    assert_eq!(
        walls["roller"].motion,
        WallMotion::Velocity {
            velocity_m_s: [0.0; 3],
            spin_rad_s: [0.0, 1.0, 0.0],
            factor: Factor::One,
        }
    );
    assert_eq!(
        walls["sieve"].motion,
        WallMotion::Displacement {
            displacement_m: [0.0; 3],
            angular_displacement_rad: [0.0; 3],
            factor: Factor::Ramp { until_s: 1.0 },
        }
    );
}

#[test]
fn how_contacts_are_found() {
    let scene = good("every-key.toml");
    let clusters = Clusters {
        self_contact: false,
    };
    let relaxation = Relaxation {
        enabled: false,
        min_overlap: 0.0,
    };
    assert_eq!(scene.clusters, clusters);
    assert_eq!(scene.relaxation, relaxation);
    assert_eq!(scene.search, Search { skin: Some(0.5) });
    for name in ["touching.toml", "shortest.toml"] {
        let scene = good(name);
        let clusters = Clusters { self_contact: true };
        let relaxation = Relaxation {
            enabled: true,
            min_overlap: 0.0,
        };
        assert_eq!(scene.clusters, clusters);
        assert_eq!(scene.relaxation, relaxation);
        assert_eq!(scene.search, Search { skin: None });
        assert_eq!(scene.run.initial_overlap, InitialOverlap::Refuse);
    }
}

#[test]
fn bonds() {
    let scene = good("every-key.toml");
    let parallel = &scene.bonds["parallel"];
    assert_eq!(parallel.model, BondModel::Parallel { kappa: Some(2.5) });
    assert_eq!(parallel.formulation, Formulation::Total);
    assert_near(parallel.young_modulus_pa, 12.05e6);
    assert_eq!(parallel.poisson_ratio, 0.3);
    assert_eq!(parallel.radius_factor, Some(0.5));
    assert_eq!(
        parallel.damping,
        BondDamping {
            damping_ratio: 0.1,
            per_mode: true,
            damping_coefficient_n_s_m: 3.0,
            torque_factor: 1.0,
            normal_damping_ratio: 0.2,
            shear_damping_ratio: 0.3,
            torsion_damping_ratio: 0.4,
            bending_damping_ratio: 0.5,
            structural_damping: 0.25,
        }
    );
    assert_eq!(
        parallel.failure,
        BondFailure {
            tensile_strength_pa: Some(1e6),
            shear_strength_pa: Some(2e6),
            compressive_strength_pa: Some(15e6),
            cohesion_pa: Some(3e6),
            friction_angle_rad: Some(35.0_f64.to_radians()),
            von_mises_strength_pa: Some(3e6),
            equivalent_stress: EquivalentStress::TensileEdge,
            rate_strengthening: Some(IncreaseCurve::Platzer { from_1_s: 1e-5 }),
            keeps_largest_factor: true,
            strain_rate_measure: StrainRateMeasure::RelativeVelocity,
            fracture_energy_j_m2: Some(50.0),
            weibull_modulus: Some(7.0),
        }
    );
    let kappa = Some(3.0);
    assert_eq!(scene.bonds["pinned"].model, BondModel::Pin { kappa });
    assert_eq!(scene.bonds["pinned"].joint, None);
    assert_eq!(
        scene.bonds["pinned"].failure.rate_strengthening,
        Some(IncreaseCurve::Table(vec![[1e-3, 1.0], [0.05, 1.25]]))
    );
    let joint = FlatJointLaw {
        radial_elements: 2,
        circumferential_elements: 8,
        friction: 0.4,
    };
    assert_eq!(
        scene.bonds["joined"].model,
        BondModel::FlatJoint {
            kappa: None,
            moment_ratio: moment_ratio(&joint),
        }
    );
    assert_eq!(scene.bonds["joined"].joint, Some(joint));
    let sheared = &scene.bonds["sheared"];
    assert_eq!(sheared.model, BondModel::ShearCoefficient { alpha: 0.85 });
    assert_eq!(sheared.formulation, Formulation::Total);
    assert_eq!(sheared.radius_factor, None);
    assert_eq!(sheared.damping, BondDamping::default());
    let from = |from_1_s| Some(IncreaseCurve::Platzer { from_1_s });
    assert_eq!(sheared.failure.rate_strengthening, from(4.64e-6));
    assert!(!sheared.failure.keeps_largest_factor);
    assert_eq!(sheared.failure.compressive_strength_pa, None);
    assert_eq!(
        sheared.plasticity,
        Some(BondPlasticity {
            normal_yield_strength_pa: Some(0.1e6),
            shear_yield_strength_pa: Some(60e3),
            torsion_yield_strength_pa: Some(70e3),
            bending_yield_strength_pa: Some(0.17e6),
            hardening_ratio: 0.05,
        })
    );
    assert_eq!(parallel.plasticity, None);
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
    let left = &scene.groups["left-end"];
    assert_eq!(left.body.as_deref(), Some("bar"));
    assert_eq!(left.pick, Pick::Particles(vec![0]));
    assert_eq!(scene.groups["tool_all"].pick, Pick::All);
    assert_eq!(scene.groups["near"].body, None);
    assert_eq!(
        scene.groups["near"].pick,
        Pick::Box(BoxShape {
            min_m: [-0.001; 3],
            max_m: [0.001; 3]
        })
    );
    assert_eq!(
        scene.groups["round"].pick,
        Pick::Sphere(SphereShape {
            centre_m: [0.0; 3],
            radius_m: 0.005
        })
    );
}

#[test]
fn supports_and_loads() {
    let scene = good("every-key.toml");
    assert_eq!(scene.supports["wall"].holds, [Some(Hold::Fixed); 6]);
    assert_eq!(scene.supports["wall"].factor, Factor::One);
    let pull = &scene.supports["pull"];
    assert_eq!(pull.group, "near");
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
    assert_eq!(press.group, "all");
    assert_eq!(press.force_n, [100e3, 0.0, -0.001]);
    assert_eq!(press.torque_n_m, [0.0, 2.0, 0.0]);
    assert_eq!(scene.loads["turn"].torque_n_m, [0.0, 0.0, 0.003]);
    assert_eq!(scene.loads["turn"].factor, Factor::Ramp { until_s: 0.1 });
    assert_eq!(pull.end_s, Some(0.02));
    assert_eq!(scene.supports["wall"].end_s, None);
    assert_eq!(press.end_s, Some(0.001));
    assert_eq!(scene.loads["turn"].end_s, None);
}

/// The initial conditions of a group, in SI; values left out are 0.
#[test]
fn initial_states() {
    let scene = good("every-key.toml");
    let tip = &scene.initial["tip"];
    assert_eq!(tip.group, "left-end");
    assert_eq!(tip.velocity_m_s, [0.003, 0.0, 0.0]);
    assert_near(tip.angular_velocity_rad_s[1], std::f64::consts::PI);
    assert_eq!(tip.displacement_m, [0.0, -1e-6, 0.0]);
    let options = ["initial.only={ group = \"all\", velocity = [1, 0, 0] }".to_owned()];
    let file = folder().join("every-key.toml");
    let scene = read_scene(&file, &options).unwrap();
    assert_eq!(scene.initial["only"].displacement_m, [0.0; 3]);
    assert_eq!(scene.initial["only"].angular_velocity_rad_s, [0.0; 3]);
}

/// A clump that is never replaced needs no bond properties, and overlaps may be kept.
#[test]
fn a_rigid_clump_without_a_kind_of_bonds() {
    let options = ["bodies.bar.start_as=clump", "run.initial_overlap=keep"].map(str::to_owned);
    let text = "version = 1\nrun.end_time = 1\nmaterials.clay.density = 2000\n\
                bodies.bar = { particles = [[0, 0, 0, 1], [1, 0, 0, 1]], bond_list = [[0, 1]], \
                material = \"clay\" }\n";
    let error = scene_from_text(text, "bar.toml", &[])
        .unwrap_err()
        .to_string();
    assert!(error.contains("bodies.bar.bonds is missing"), "{error}");
    let scene = scene_from_text(text, "bar.toml", &options).unwrap();
    assert_eq!(scene.bodies["bar"].bond_kind, None);
    assert_eq!(scene.run.initial_overlap, InitialOverlap::Keep);
}

#[test]
fn measures_and_output() {
    let scene = good("every-key.toml");
    let bending = &scene.measures["bending"];
    assert_eq!(bending.of, "left-end");
    assert_eq!(bending.quantity_name(), "displacement_y");
    assert_eq!(bending.statistic, Statistic::Largest);
    assert_near(bending.reference.unwrap(), 0.0015);
    assert_eq!(bending.tolerance, Some(0.02));
    let energy = &scene.measures["energy"];
    assert_eq!(
        (energy.of.as_str(), energy.statistic),
        ("all", Statistic::End)
    );
    assert_eq!((energy.reference, energy.tolerance), (None, None));
    let push = &scene.measures["push"];
    assert_eq!(
        (push.of.as_str(), push.quantity_name()),
        ("punch", "force_z")
    );
    assert_eq!(push.reference, Some(-1000.0));
    assert_eq!((push.absolute_tolerance, &push.with), (None, &None));
    let hit = &scene.measures["hit"];
    assert_eq!(hit.quantity_name(), "contact_overlap");
    assert_eq!(hit.with.as_deref(), Some("punch"));
    assert_near(hit.absolute_tolerance.unwrap(), 1e-5);
    let pieces = &scene.measures["pieces"];
    assert_eq!(pieces.of, "fragments");
    assert_eq!(
        (pieces.quantity_name(), pieces.reference),
        ("mass_of_largest", Some(0.02))
    );
    let calm = &scene.measures["calm"];
    assert_eq!(calm.quantity_name(), "fraction_below_dynamic_utilisation");
    assert_eq!((calm.limit, push.limit), (Some(0.5), None));
    let strain_rate = ["largest_strain_rate"];
    let rate = QUANTITIES.iter().find(|one| one.names == strain_rate);
    assert_eq!(rate.unwrap().dimension.si, "1/s");
    let others = good("touching.toml").measures;
    for (name, quantity, unit) in [
        ("hit", "force_z", "N"),
        ("twist", "torque_y", "N m"),
        ("place", "position_z", "m"),
        ("pieces", "count", ""),
        ("largest", "mass_fraction_of_largest", ""),
        ("all_of_it", "force", "N"),
        ("sideways", "contact_force_y", "N"),
        ("while", "contact_duration", "s"),
        ("slope", "angle_of_repose", "deg"),
    ] {
        assert_eq!(others[name].quantity_name(), quantity);
        assert_eq!(others[name].quantity.dimension.si, unit);
    }
    assert_near(others["slope"].reference.unwrap(), 30.0);
    let output = scene.output.unwrap();
    assert_eq!(output.folder, Some(folder().join("results")));
    assert_eq!(output.frames_s, Some(0.005));
    assert_eq!(output.series_s, Some(0.0005));
    assert_eq!(output.pictures_s, Some(0.01));
    let from = output.view_from.unwrap();
    (0..3).for_each(|k| assert_near(from[k], [0.6, -0.8, 0.0][k]));
    assert_eq!(output.colour_by, ColourBy::DynamicUtilisation);
    assert_eq!(output.sieves_m, [1e-3, 2e-3, 5e-3]);
    assert_eq!(output.flow_s, Some(2e-3));
    assert_eq!(output.checkpoint_s, Some(0.1));
}
