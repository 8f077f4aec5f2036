//! Bars at rest compared with exact solutions.

use dem_run::physics::bond::stiffness::BondModel;
use nalgebra::UnitQuaternion;

use super::bar::LOAD;
use super::cases::{
    KAPPA_OF_CASE_5, TOLERANCE, assert_near, assert_profile, case1, case2, case3, case5, small,
};
use super::models::{MODELS, PARALLEL, number, numbers, small_load, whole_load};
use crate::verification::page::on_one_thread;

/// The closed form used for the bars equals the result of an independent implementation by direct
/// stiffness.
#[test]
fn exact_solution_is_that_of_the_direct_stiffness_method() {
    let reference = small_load();
    for named in MODELS {
        let (deflections, rotations) = case1(named.model).exact(LOAD);
        let path = format!("/case1/models/{}", named.key);
        let profile = numbers(&reference, &format!("{path}/profile"));
        assert_profile(&deflections, &profile, 1e-9);
        let rotation = numbers(&reference, &format!("{path}/rotation"));
        assert_profile(&rotations, &rotation, 1e-9);
        for row in 0..5 {
            let path = format!("/case2/rows/{row}");
            let bonds = number(&reference, &format!("{path}/n_bonds")) as usize;
            let tip = number(&reference, &format!("{path}/{}/tip", named.key));
            let (found, _) = case2(bonds, named.model).exact(LOAD);
            assert_near(found[bonds], tip, 1e-9, &path);
        }
        for row in 0..4 {
            let path = format!("/case3/rows/{row}");
            let bonds = number(&reference, &format!("{path}/n_bonds")) as usize;
            let tip = number(&reference, &format!("{path}/{}/tip", named.key));
            let (found, _) = case3(bonds, named.model).exact(LOAD);
            assert_near(found[bonds], tip, 1e-9, &path);
        }
    }
    let kappa = Some(KAPPA_OF_CASE_5);
    let with_kappa = BondModel::Parallel { kappa };
    for row in 0..3 {
        for (key, model) in [
            ("PBM_ksEB", with_kappa),
            ("PBM", PARALLEL),
            ("EBBM", BondModel::EulerBernoulli),
            ("TBBM", BondModel::Timoshenko),
        ] {
            let path = format!("/case5/rows/{row}");
            let middle = number(&reference, &format!("{path}/R_mid"));
            let (found, _) = case5(middle, model).exact(LOAD);
            let path = format!("{path}/{key}");
            assert_near(
                found[2],
                number(&reference, &format!("{path}/tip")),
                1e-9,
                &path,
            );
            assert_near(
                found[1],
                number(&reference, &format!("{path}/mid")),
                1e-9,
                &path,
            );
        }
    }
}

#[test]
fn both_formulations_bend_alike() {
    on_one_thread(|| {
        for named in MODELS {
            let mut bar = case1(named.model);
            bar.incremental = true;
            small(&bar, TOLERANCE);
        }
    });
}

/// In a rotated bar, positions are also rounded along the load, by up to 4e-16 m; with the axial
/// stiffness of the bar this gives 3e-5 N. Particle damping acts on it as dry friction, and the
/// load is 2 kN: 1e-8, and more in deflections that accumulate it.
#[test]
fn a_turned_bar_bends_as_one_along_x() {
    on_one_thread(|| {
        for named in MODELS {
            for incremental in [false, true] {
                let mut bar = case1(named.model);
                bar.incremental = incremental;
                bar.turned = UnitQuaternion::from_euler_angles(0.3, 1.1, -2.0);
                small(&bar, 10.0 * TOLERANCE);
            }
        }
    });
}

/// Under the paper's load the bar comes to rest at the minimum of the energy of its bonds, which
/// was found without time stepping.
#[test]
fn at_the_whole_load_energy_is_least() {
    let reference = whole_load();
    on_one_thread(|| {
        for named in MODELS {
            let path = format!("/energies/stated/{}", named.key);
            let rest = case1(named.model).at_rest(LOAD);
            let tip = number(&reference, &format!("{path}/tip"));
            assert_near(rest.deflections_m[10], tip, 1e-11, named.name);
            let shortening = number(&reference, &format!("{path}/axial_shortening"));
            assert_near(rest.shortening_m, shortening, 1e-8, named.name);
        }
    });
}

/// The same with increments, compared with the independent implementation's increments.
#[test]
fn at_the_whole_load_increments_agree() {
    let reference = whole_load();
    on_one_thread(|| {
        for named in &MODELS[..3] {
            let path = format!("/{}/INC_TS_MID", named.key);
            let mut bar = case1(named.model);
            bar.incremental = true;
            let rest = bar.at_rest(LOAD);
            let tip = number(&reference, &format!("{path}/tip"));
            assert_near(rest.deflections_m[10], tip, 1e-9, named.name);
            let shortening = number(&reference, &format!("{path}/axial_shortening"));
            assert_near(rest.shortening_m, shortening, 1e-7, named.name);
        }
    });
}

/// The independent implementation's total formulation has another energy, equal to second order.
/// Its tips are those of that energy, and differ from ours by the difference of the two.
#[test]
fn the_other_total_formulation_is_another_energy() {
    let reference = whole_load();
    for key in ["PBM", "EBBM", "TBBM"] {
        let theirs = number(&reference, &format!("/{key}/TOTAL/tip"));
        let of_theirs = number(&reference, &format!("/energies/mean_axis/{key}/tip"));
        assert_near(theirs, of_theirs, 1e-11, key);
        let stated = number(&reference, &format!("/energies/stated/{key}/tip"));
        assert_near(stated / theirs - 1.0, 8.07e-8, 0.01, key);
    }
}

/// Under the paper's load the bar deflects less than small-deflection theory predicts, by the
/// square of the load: its tip approaches the support, which shortens the lever of the load. The
/// elastica gives 4/35 (F L^2/EI)^2.
#[test]
fn the_lever_of_the_load_shortens() {
    on_one_thread(|| {
        let bar = case1(BondModel::Timoshenko);
        let (exact, _) = bar.exact(LOAD);
        let less = [1.0, 0.5].map(|part| {
            let tip = bar.at_rest(part * LOAD).deflections_m[10];
            1.0 - tip / (part * exact[10])
        });
        assert_near(less[0] / less[1], 4.0, 1e-3, "square of the load");
        let second_moment = 0.25 * std::f64::consts::PI * 0.2_f64.powi(4);
        let bend = LOAD * 16.0 / (super::bar::YOUNG * second_moment);
        assert_near(less[0], 4.0 / 35.0 * bend * bend, 0.02, "elastica");
    });
}
