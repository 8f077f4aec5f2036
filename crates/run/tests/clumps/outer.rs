//! Spheres that cannot be touched are left out without changing a bit.

use std::sync::Arc;

use dem_engine::stages::population::change::apply_topology_change;
use dem_engine::state::State;
use dem_engine::state::clumps::{Clump, Template};
use dem_engine::state::events::TopologyChange;
use dem_engine::step::{stages, step};

use super::{HEAD, MEETS, block, planned};

/// Two bodies: one falls onto the other, and both onto a plane.
fn falling(body: impl Fn(&str, &str) -> String) -> State {
    let text = [
        HEAD.to_owned(),
        MEETS.to_owned(),
        "run.gravity = [0, 0, -9.81]\n".to_owned(),
        body(
            "low",
            "position = [0, 0, 1.5e-3]\nrotation = { axis = [1, 2, 1], angle = 0.2 }\nvelocity = [0, 0, -0.3]",
        ),
        body(
            "up",
            "position = [1e-3, -0.5e-3, 8.5e-3]\nrotation = { axis = [1, -1, 0], angle = 0.4 }\n\
             velocity = [0, 0, -0.6]\nangular_velocity = [20, 5, -30]",
        ),
        "[walls.ground]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmaterial = \"stuff\"\n"
            .to_owned(),
    ];
    let text = text.concat();
    let text: Vec<&str> = text
        .lines()
        .filter(|line| !line.starts_with("bond_list"))
        .collect();
    planned(&text.join("\n")).state
}

/// 64 spheres that overlap so much that the 8 in the middle are covered.
fn covered(name: &str, more: &str) -> String {
    let spheres = block(name, [4, 4, 4], 1e-3, |_| Some(1e-3), more);
    spheres.replace("bonds = \"stiff\"\n", "start_as = \"clump\"\n")
}

/// 64 spheres that overlap a little, with pores between them.
fn porous(name: &str, more: &str) -> String {
    let spheres = block(name, [4, 4, 4], 1.2e-3, |_| Some(0.65e-3), more);
    spheres.replace("bonds = \"stiff\"\n", "start_as = \"clump\"\n")
}

/// The same with all spheres in the scene.
fn with_all_spheres(state: &State) -> State {
    let mut state = state.clone();
    let coming: Vec<Clump> = state.clumps.all.clone();
    let leaving = coming.iter().map(|clump| clump.cluster).collect();
    let changes = TopologyChange {
        leaving,
        ..TopologyChange::default()
    };
    apply_topology_change(&mut state, changes);
    assert!(state.particles.is_empty() && state.clumps.all.is_empty());
    for template in &mut state.clumps.templates {
        let outer = Arc::new((0..template.spheres.len() as u32).collect());
        *template = Arc::new(Template {
            outer,
            ..(**template).clone()
        });
    }
    let changes = TopologyChange {
        coming,
        ..TopologyChange::default()
    };
    apply_topology_change(&mut state, changes);
    state
}

#[test]
fn covered_spheres_make_no_difference_to_the_last_bit() {
    make_no_difference(falling(covered));
}

#[test]
fn spheres_within_pores_make_no_difference_to_the_last_bit() {
    make_no_difference(falling(porous));
}

fn make_no_difference(few: State) {
    let mut few = few;
    let mut all = with_all_spheres(&few);
    assert_eq!((few.particles.len(), all.particles.len()), (2 * 56, 2 * 64));
    assert_eq!(few.time_step_s, all.time_step_s);
    let same = |few: &State, all: &State| {
        few.clumps.all.iter().zip(&all.clumps.all).all(|(a, b)| {
            let bits = |c: &Clump| {
                (
                    c.place_m,
                    c.turned,
                    c.velocity_m_s,
                    c.angular_momentum,
                    c.force_n,
                    c.torque_n_m,
                    c.impact_energy_j,
                )
            };
            bits(a) == bits(b)
        })
    };
    let (mut on_ground, mut on_each_other) = (0, 0);
    while few.time_s < 0.03 {
        step(&mut few);
        step(&mut all);
        assert!(same(&few, &all), "at {} s", few.time_s);
        on_ground += u32::from(!few.walls[0].touching.is_empty());
        let contacts = few.contacts.as_ref().unwrap();
        on_each_other += u32::from(contacts.histories.iter().any(|m| m.overlap_m() > 0.0));
    }
    eprintln!(
        "{} steps: {on_ground} with the ground, {on_each_other} with each other",
        few.steps
    );
    assert!(on_ground > 100 && on_each_other > 100);
}

/// Memory of a waiting clump: only its outer spheres, whatever the numbers of spheres and bonds of
/// its body.
#[test]
fn clumps_share_what_they_are_made_of() {
    let lump = porous("lump", "").replace(
        "start_as = \"clump\"\n",
        "start_as = \"clump\"\nbonds = \"stiff\"\n",
    );
    let text = format!(
        "{HEAD}{MEETS}{lump}\
         [regions.gate]\nbox = {{ min = [0, 0, 0], max = [0.3, 0.3, 0.3] }}\n\
         [regions.far]\nbox = {{ min = [1, 1, 1], max = [2, 2, 2] }}\n\
         [replacement.lump]\nwhen = {{ enters = \"far\" }}\n\
         [inlets.all]\nbodies = [\"lump\"]\nregion = \"gate\"\nrate = 1e9\ncount = 1000\norientation = \"random\"\n"
    );
    let mut plan = planned(&text);
    for _ in 0..20 {
        super::go(&mut plan.state, &mut plan.bodies);
    }
    let state = &plan.state;
    let [template] = &state.clumps.templates[..] else {
        panic!("{} templates", state.clumps.templates.len());
    };
    assert_eq!((template.spheres.len(), template.outer.len()), (64, 56));
    assert!(template.bonds.len() == 144 && state.bonds.is_empty());
    assert_eq!(state.clumps.all.len(), 1000);
    assert_eq!(state.particles.len(), 1000 * template.outer.len());
}

/// Bodies of one shape share their arrays, which count once; another shape has its own.
#[test]
fn bodies_of_one_shape_share_their_arrays() {
    let bonded = |name: &str, at: usize, make: fn(&str, &str) -> String| {
        let clump = "start_as = \"clump\"\n";
        make(name, &format!("position = [{}, 0, 0]", 0.1 * at as f64))
            .replace(clump, &format!("{clump}bonds = \"stiff\"\n"))
    };
    let scene = |names: &[&str]| {
        let bodies = names.iter().enumerate();
        let bodies: String = bodies.map(|(at, name)| bonded(name, at, porous)).collect();
        let other = bonded("other", names.len(), covered);
        let far = "[regions.far]\nbox = { min = [1, 1, 1], max = [2, 2, 2] }\n";
        let replaced = names.iter().chain(&["other"]);
        let replaced =
            replaced.map(|name| format!("[replacement.{name}]\nwhen = {{ enters = \"far\" }}\n"));
        let replaced: String = replaced.collect();
        planned(&format!("{HEAD}{MEETS}{bodies}{other}{far}{replaced}")).state
    };
    let bytes = |state: &State| {
        let stage = stages().iter().find(|stage| stage.name == "rigid clumps");
        (stage.unwrap().bytes)(state) as f64
    };
    let [one, many] = [scene(&["a"]), scene(&["a", "b", "c", "d"])];
    let [first, others @ .., another] = &many.clumps.templates[..] else {
        panic!("no templates");
    };
    assert_eq!((others.len(), another.body.as_str()), (3, "other"));
    assert!(!Arc::ptr_eq(&another.spheres, &first.spheres));
    assert!(!first.bonds.is_empty());
    for other in others {
        assert_ne!(other.body, first.body);
        assert!(Arc::ptr_eq(&other.spheres, &first.spheres));
        assert!(Arc::ptr_eq(&other.outer, &first.outer));
        assert!(Arc::ptr_eq(&other.bonds, &first.bonds));
        assert!(Arc::ptr_eq(&other.file_number, &first.file_number));
        assert!(Arc::ptr_eq(&other.bonds_of_file, &first.bonds_of_file));
    }
    let arrays = size_of_val(&first.spheres[..]) as f64;
    assert!(
        bytes(&many) - bytes(&one) < arrays,
        "{} {}",
        bytes(&many),
        bytes(&one)
    );
}
