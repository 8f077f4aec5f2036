//! Rigid walls, incompressible materials, and clumps that are never replaced.

use std::f64::consts::PI;

use dem_engine::step::step;
use dem_physics::contact::law::Law;
use dem_physics::contact::law::hertz_mindlin::HertzMindlin;
use dem_physics::contact::pair_parameters::{Elastic, PairInput};
use dem_plan::Plan;

use super::{PAIR, assert_near, place, planned, try_planned};

const RADIUS_M: f64 = 5e-3;
const SPEED_M_S: f64 = 0.5;

fn dropped(anvil: &str) -> Plan {
    planned(&format!(
        "version = 1\nrun = {{ end_time = 1, safety_factor = 0.1 }}\n\
         materials.glass = {{ density = 2500, young_modulus = \"50 MPa\", poisson_ratio = 0.25 }}\n\
         materials.anvil = {{ {anvil} }}\n\
         contacts.anvil-glass = {{ restitution = 1, friction = 0.5 }}\n\
         bodies.ball = {{ particles = [[0, 0, {RADIUS_M}, {RADIUS_M}]], material = \"glass\", velocity = [0, 0, -{SPEED_M_S}] }}\n\
         walls.anvil = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"anvil\" }}\n"
    ))
}

/// Hertz impact on a rigid wall: only the sphere deforms, 1/E* = (1 - nu^2)/E. The maximum is d =
/// (15 m v^2 / (16 E* sqrt(R)))^(2/5), after 1.4716 d/v.
#[test]
fn an_impact_on_a_rigid_wall_is_that_of_hertz() {
    let Plan {
        mut state,
        step: choice,
        ..
    } = dropped("rigid = true");
    let e_star_pa = 50e6 / (1.0 - 0.25 * 0.25);
    let Law::HertzMindlin(law) = state.contacts.as_ref().unwrap().model.kinds[0].law else {
        panic!("another law");
    };
    assert_near(law.young_modulus_pa, e_star_pa, 1e-14);
    let g_star_pa = 50e6 / (2.0 * (1.0 + 0.25) * (2.0 - 0.25));
    assert_near(law.shear_modulus_pa, g_star_pa, 1e-14);
    let mass_kg = 2500.0 * 4.0 / 3.0 * PI * RADIUS_M.powi(3);
    let depth_m =
        (15.0 / 16.0 * mass_kg * SPEED_M_S.powi(2) / (e_star_pa * RADIUS_M.sqrt())).powf(0.4);
    let mut deepest = [0.0, 0.0];
    while state.particles.motions[0].velocity_m_s[2] < 0.0 || place(&state, 0).z < RADIUS_M {
        step(&mut state);
        let overlap_m = RADIUS_M - place(&state, 0).z;
        if overlap_m > deepest[0] {
            deepest = [overlap_m, state.time_s];
        }
    }
    assert_near(deepest[0], depth_m, 1e-3);
    let duration_s = 2.943_275_184_324_7 * depth_m / SPEED_M_S;
    assert_near(state.time_s, duration_s, 0.01);
    assert_near(state.particles.motions[0].velocity_m_s[2], SPEED_M_S, 5e-3);
    assert!(choice.step_s > 0.0 && choice.rayleigh_s.is_finite());
}

/// Rayleigh's estimate is that of deformable materials, and a wall of a stiff material comes close
/// to a rigid one.
#[test]
fn a_rigid_wall_leaves_the_step_to_what_deforms() {
    let rigid = dropped("rigid = true");
    let stiff = dropped("young_modulus = \"1e9 GPa\"");
    let alike = dropped("young_modulus = \"50 MPa\", poisson_ratio = 0.25");
    assert_near(rigid.step.rayleigh_s, alike.step.rayleigh_s, 1e-12);
    assert_near(rigid.step.step_s, stiff.step.step_s, 1e-3);
}

/// At nu = 0.5 all values are finite: E* = E/(1 - 1/4), G = E/3.
#[test]
fn a_material_that_keeps_its_volume_is_like_any_other() {
    let soft = Elastic {
        young_modulus_pa: 3e6,
        poisson_ratio: 0.5,
    };
    let rigid = Elastic {
        young_modulus_pa: f64::INFINITY,
        poisson_ratio: 0.0,
    };
    let law = HertzMindlin::new([soft, rigid], &PairInput::new(0.5, 0.5));
    assert_near(law.young_modulus_pa, 4e6, 1e-14);
    assert_near(law.shear_modulus_pa, 1e6 / 1.5, 1e-14);
    for model in [
        "parallel",
        "timoshenko",
        "euler-bernoulli",
        "elastic-solid",
        "shear-coefficient",
    ] {
        let text = PAIR.replace("poisson_ratio = 0.3", "poisson_ratio = 0.5");
        let text = text.replace("\"parallel\"", &format!("\"{model}\""));
        let text = format!("{text}run.end_time = 1\n");
        let plan = planned(&text);
        assert!(plan.step.limit.step_s.is_normal(), "{model}");
        let bonds = &plan.state.bonds;
        // Torsion is G 2 I/L: a third of bending, E I/L, times 2.
        assert_near(bonds.torsion_per_bending[0], 2.0 / 3.0, 1e-12);
    }
}

/// Its bonds are ignored if it is never replaced, and needed otherwise.
#[test]
fn a_clump_that_is_never_replaced_needs_no_kind_of_bonds() {
    let text = "version = 1\nrun.end_time = 1\nmaterials.m.density = 1000\n\
         bodies.rock = { material = \"m\", start_as = \"clump\", particles = [[0, 0, 0, 1], [1, 0, 0, 1]], bond_list = [[0, 1]] }\n";
    let plan = planned(text);
    assert_eq!(plan.unused_bonds, [("rock".to_owned(), 1)]);
    assert_eq!(
        (plan.state.clumps.all.len(), plan.state.bonds.len()),
        (1, 0)
    );
    assert!(plan.state.clumps.templates[0].bonds.is_empty());
    let replaced = "bonds.b = { young_modulus = 1e6, poisson_ratio = 0.3 }\nreplacement.rock.when.time = 0.5\n";
    let text = text.replace("bond_list", "bonds = \"b\", bond_list");
    let plan = try_planned(&format!("{text}{replaced}")).unwrap();
    assert!(plan.unused_bonds.is_empty());
    assert_eq!(plan.state.clumps.templates[0].bonds.len(), 1);
}
