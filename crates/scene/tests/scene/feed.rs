//! Clumps, regions, replacement, inlets and outlets.

use dem_scene::{
    BoxShape, ClumpMass, ClumpSettings, CountedEnergy, CylinderShape, Daughters, FeedRate, Inlet,
    Outlet, Region, Replacement, Restore, SharesBy, SizeClass, SphereShape, StartAs, When,
};
use dem_scene::{read_scene, scene_from_text};

use super::good::{assert_near, folder, good};

/// The second example of the documentation continues the first, and each alternative in a comment
/// is valid as well.
#[test]
fn the_documentation() {
    let text = include_str!("../../../../doc/scenes.md");
    let mut examples = text.split("```toml\n").skip(1);
    let mut next = || examples.next().unwrap().split_once("```").unwrap().0;
    let (first, second) = (next(), next());
    let read = |second: &str| scene_from_text(&format!("{first}{second}"), "doc.toml", &[]);
    let scene = read(second).unwrap();
    assert_eq!(scene.regions.len(), 3);
    assert_eq!(scene.replacement.len(), 1);
    assert_eq!((scene.inlets.len(), scene.outlets.len()), (1, 1));
    for (taken, comment) in [
        ("box = ", "# sphere = "),
        ("box = ", "# cylinder = "),
        ("box = ", "# stl = "),
        ("rate = ", "# mass_rate = "),
        ("bodies = ", "# bodies = "),
        ("inside = ", "# outside = "),
    ] {
        let unit = if comment == "# stl = " {
            "unit = \"mm\"\n"
        } else {
            ""
        };
        let other = second.replacen(comment, &format!("{unit}{}", &comment[2..]), 1);
        let other = other.replacen(&format!("\n{taken}"), &format!("\n# {taken}"), 1);
        let read = read(&other).unwrap();
        assert_ne!(read.describe(), scene.describe(), "{comment}");
    }
}

#[test]
fn what_bodies_start_as() {
    let bodies = good("clumps-and-feed.toml").bodies;
    let clump = |scale, mass| StartAs::Clump(ClumpSettings { scale, mass });
    let StartAs::Clump(cake) = bodies["cake"].start_as else {
        panic!("no clump");
    };
    assert_near(cake.scale, 1.02);
    assert_eq!(cake.mass, ClumpMass::Spheres);
    assert_eq!(bodies["pair"].start_as, clump(1.0, ClumpMass::Spheres));
    assert_eq!(bodies["rock"].start_as, clump(1.5, ClumpMass::Union));
    assert_eq!(bodies["bar"].start_as, StartAs::Bonded);
    let others = good("every-key.toml").bodies;
    assert!(others.values().all(|b| b.start_as == StartAs::Bonded));
}

#[test]
fn regions() {
    let regions = good("clumps-and-feed.toml").regions;
    assert_eq!(
        regions["impact"],
        Region::Box(BoxShape {
            min_m: [-0.1, -0.5, -1.0],
            max_m: [1.0, 0.5, 0.5]
        })
    );
    assert_eq!(
        regions["gate"],
        Region::Sphere(SphereShape {
            centre_m: [0.0, 0.0, 2.0],
            radius_m: 0.1
        })
    );
    assert_eq!(
        regions["all"],
        Region::Cylinder(CylinderShape {
            from_m: [0.0, 0.0, -3.0],
            to_m: [0.0, 0.0, 3.0],
            radius_m: 2.0
        })
    );
    assert_eq!(
        regions["cake"],
        Region::Stl {
            file: folder().join("shapes/bin.stl"),
            unit_m: Some(1e-3)
        }
    );
}

#[test]
fn replacement() {
    let replacement = good("clumps-and-feed.toml").replacement;
    assert_eq!(
        replacement["cake"],
        Replacement {
            when: When {
                enters: Some("impact".to_owned()),
                touches: vec!["blade".to_owned(), "rock".to_owned()],
                force_n: Some(100.0),
                contact_force_n: Some(50.0),
                principal_stress_pa: Some(20e3),
                impact_energy_j: Some(0.5),
                time_s: Some(0.1),
            },
            requires_all: true,
            restore: Some(Restore {
                leaves: Some("impact".to_owned()),
                unbroken_for_s: Some(5e-3),
                min_particles: 3,
                strain_energy_j_kg: 0.02,
                fluctuation_velocity_m_s: 0.001,
            }),
            daughters: None,
            breakage: None,
        }
    );
    assert_eq!(
        replacement["pair"],
        Replacement {
            when: When {
                touches: vec!["blade".to_owned()],
                ..When::default()
            },
            requires_all: false,
            restore: Some(Restore {
                leaves: None,
                unbroken_for_s: Some(2e-3),
                min_particles: 10,
                strain_energy_j_kg: 0.01,
                fluctuation_velocity_m_s: 0.005,
            }),
            daughters: None,
            breakage: None,
        }
    );
}

#[test]
fn daughters() {
    let scene = good("daughters.toml");
    let daughters = scene.replacement["ore"].daughters.as_ref().unwrap();
    let class = |from_j_kg, body: &str| SizeClass {
        from_j_kg,
        body: body.to_owned(),
    };
    assert_eq!(
        *daughters,
        Daughters {
            classes: vec![class(20.0, "coarse"), class(108.0, "fine")],
            energy: CountedEnergy::AllImpacts,
            weibull_modulus: Some(5.0),
            smallest_size_m: Some(2e-3),
            limit: 1000,
        }
    );
    assert_eq!(scene.parent_of("fine").unwrap(), "ore");
    assert_eq!(scene.parent_of("ore"), None);
}

#[test]
fn a_sieve_curve_stands_for_bodies_of_its_sizes() {
    let scene = good("breakage.toml");
    let feed = &scene.inlets["feed"];
    let names: Vec<&str> = feed.bodies.iter().map(|(name, _)| name.as_str()).collect();
    // Nothing lies between 22.4 mm and 31.5 mm.
    assert_eq!(names, ["ore-16-22_4mm", "ore-31_5-45mm"]);
    let shares: Vec<f64> = feed.bodies.iter().map(|(_, share)| *share).collect();
    assert!((shares[0] - 0.25).abs() < 1e-15 && (shares[1] - 0.75).abs() < 1e-15);
    assert_eq!(feed.shares_by, SharesBy::Mass);
    let sizes = names
        .iter()
        .map(|name| scene.bodies[*name].sieve_size_m.unwrap());
    for (size_m, [from, to]) in sizes.into_iter().zip([[16.0_f64, 22.4], [31.5, 45.0]]) {
        assert!((size_m - 1e-3 * (from * to).sqrt()).abs() < 1e-15);
    }
    assert!(!scene.bodies.contains_key("ore") && !scene.replacement.contains_key("ore"));
    assert!(scene.replacement["ore-31_5-45mm"].breakage.is_some());
}

#[test]
fn inlets_and_outlets() {
    let scene = good("clumps-and-feed.toml");
    assert_eq!(
        scene.inlets["feed"],
        Inlet {
            bodies: vec![("rock".to_owned(), 3.0), ("cake".to_owned(), 0.5)],
            shares_by: SharesBy::Mass,
            sizes: None,
            region: "gate".to_owned(),
            rate: FeedRate::Number(4.0),
            velocity_m_s: [3.0, 0.0, 0.0],
            angular_velocity_rad_s: [0.0, 0.0, std::f64::consts::PI],
            random_orientation: true,
            start_s: 0.1,
            end_s: 1.0,
            count: Some(100),
        }
    );
    let second = &scene.inlets["second"];
    let FeedRate::Mass(rate) = second.rate else {
        panic!("{:?}", second.rate);
    };
    assert_near(rate, 1.0);
    let usual = Inlet {
        bodies: vec![("cake".to_owned(), 1.0)],
        shares_by: SharesBy::Number,
        sizes: None,
        region: "gate".to_owned(),
        rate: second.rate,
        velocity_m_s: [0.0; 3],
        angular_velocity_rad_s: [0.0; 3],
        random_orientation: false,
        start_s: 0.0,
        end_s: f64::INFINITY,
        count: None,
    };
    assert_eq!(*second, usual);
    let outlet = |region: &str, removes_outside| Outlet {
        region: region.to_owned(),
        removes_outside,
    };
    assert_eq!(scene.outlets["floor"], outlet("cake", false));
    assert_eq!(scene.outlets["lost"], outlet("all", true));
}

/// All bodies may be fed; a group of all bodies then selects from those present, and a zero value
/// does not count as a start condition.
#[test]
fn bodies_that_are_fed() {
    let scene = good("only-fed.toml");
    assert_eq!((scene.bodies.len(), scene.inlets.len()), (1, 1));
    let file = folder().join("only-fed.toml");
    let options = ["groups.there.all=true", "bodies.block.velocity=[0, 0, 0]"];
    let scene = read_scene(&file, &options.map(str::to_owned)).unwrap();
    assert_eq!(scene.groups.len(), 1);
}

#[test]
fn values_in_words() {
    let words = |name: &str| -> Vec<String> {
        let text = good(name).describe();
        let about = ["regions.", "replacement.", "inlets.", "outlets."];
        text.lines()
            .map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "))
            .filter(|line| {
                about.iter().any(|table| line.starts_with(table))
                    || line.contains(".start_as ")
                    || line.contains(".clump.")
                    || line.contains(".bonded_within.")
            })
            .collect()
    };
    let bin = folder().join("shapes/bin.stl");
    assert_eq!(
        words("clumps-and-feed.toml"),
        [
            "bodies.bar.start_as bonded",
            "bodies.cake.start_as clump",
            "bodies.cake.clump.scale 1.02",
            "bodies.cake.clump.mass spheres",
            "bodies.pair.start_as clump",
            "bodies.pair.clump.scale 1",
            "bodies.pair.clump.mass spheres",
            "bodies.rock.start_as clump",
            "bodies.rock.clump.scale 1.5",
            "bodies.rock.clump.mass union",
            "bodies.stalk.start_as bonded",
            "bodies.stalk.bonded_within.region gate",
            "bodies.stalk.bonded_within.moves_with blade",
            "bodies.stalk.bonded_within.rejoin.strain_energy 0.005 J/kg",
            "bodies.stalk.bonded_within.rejoin.fluctuation_velocity 0.002 m/s",
            "regions.all.cylinder.from [0, 0, -3] m",
            "regions.all.cylinder.to [0, 0, 3] m",
            "regions.all.cylinder.radius 2 m",
            &format!("regions.cake.stl {}", bin.display()),
            "regions.cake.unit 0.001 m",
            "regions.gate.sphere.centre [0, 0, 2] m",
            "regions.gate.sphere.radius 0.1 m",
            "regions.impact.box.min [-0.1, -0.5, -1] m",
            "regions.impact.box.max [1, 0.5, 0.5] m",
            "replacement.cake.when.enters impact",
            "replacement.cake.when.touches blade, rock",
            "replacement.cake.when.force 100 N",
            "replacement.cake.when.contact_force 50 N",
            "replacement.cake.when.principal_stress 20000 Pa",
            "replacement.cake.when.impact_energy 0.5 J",
            "replacement.cake.when.time 0.1 s",
            "replacement.cake.require all",
            "replacement.cake.restore.leaves impact",
            "replacement.cake.restore.unbroken_for 0.005 s",
            "replacement.cake.restore.min_particles 3",
            "replacement.cake.restore.strain_energy 0.02 J/kg",
            "replacement.cake.restore.fluctuation_velocity 0.001 m/s",
            "replacement.pair.when.enters not used",
            "replacement.pair.when.touches blade",
            "replacement.pair.when.force not used",
            "replacement.pair.when.contact_force not used",
            "replacement.pair.when.principal_stress not used",
            "replacement.pair.when.impact_energy not used",
            "replacement.pair.when.time not used",
            "replacement.pair.require any",
            "replacement.pair.restore.leaves not used",
            "replacement.pair.restore.unbroken_for 0.002 s",
            "replacement.pair.restore.min_particles 10",
            "replacement.pair.restore.strain_energy 0.01 J/kg",
            "replacement.pair.restore.fluctuation_velocity 0.005 m/s",
            "inlets.feed.bodies rock: 3, cake: 0.5",
            "inlets.feed.shares_by mass",
            "inlets.feed.region gate",
            "inlets.feed.rate 4 1/s",
            "inlets.feed.velocity [3, 0, 0] m/s",
            "inlets.feed.angular_velocity [0, 0, 3.14159265359] rad/s",
            "inlets.feed.orientation random",
            "inlets.feed.start 0.1 s",
            "inlets.feed.end 1 s",
            "inlets.feed.count 100",
            "inlets.second.bodies cake: 1",
            "inlets.second.shares_by number",
            "inlets.second.region gate",
            "inlets.second.mass_rate 1 kg/s",
            "inlets.second.velocity [0, 0, 0] m/s",
            "inlets.second.angular_velocity [0, 0, 0] rad/s",
            "inlets.second.orientation as-is",
            "inlets.second.start 0 s",
            "inlets.second.end never",
            "inlets.second.count no limit",
            "outlets.floor.inside cake",
            "outlets.lost.outside all",
        ]
    );
    let file = folder().join("clumps-and-feed.toml");
    let options = ["replacement.pair={ when = { force = 1 } }".to_owned()];
    let text = read_scene(&file, &options).unwrap().describe();
    let back = text
        .lines()
        .find(|l| l.starts_with("replacement.pair.restore"));
    assert!(back.unwrap().ends_with(" never"), "{text}");
}
