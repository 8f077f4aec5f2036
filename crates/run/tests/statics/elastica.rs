//! A slender cantilever under a large force at its end compared with the elastica, EI theta'' = -P
//! cos theta, integrated here to rounding.

use dem_physics::bond::stiffness::BondModel;

use super::{bar, fix, load, rest};

/// End position of the elastica of length 1 under P/EI = `load`, axial and transverse; by shooting
/// from the free end, where the moment is 0.
fn elastica(load: f64) -> [f64; 2] {
    // From the clamp: the curvature there is the moment, load times the lever, which is the axial
    // position of the end.
    let end = |curvature: f64| {
        let steps = 4000;
        let h = 1.0 / f64::from(steps);
        let slope =
            |[theta, bend, _, _]: [f64; 4]| [bend, -load * theta.cos(), theta.cos(), theta.sin()];
        let add = |s: [f64; 4], k: [f64; 4], h: f64| [0, 1, 2, 3].map(|n| s[n] + h * k[n]);
        let mut state = [0.0, curvature, 0.0, 0.0];
        for _ in 0..steps {
            let k1 = slope(state);
            let k2 = slope(add(state, k1, 0.5 * h));
            let k3 = slope(add(state, k2, 0.5 * h));
            let k4 = slope(add(state, k3, h));
            for n in 0..4 {
                state[n] += h / 6.0 * (k1[n] + 2.0 * k2[n] + 2.0 * k3[n] + k4[n]);
            }
        }
        state
    };
    // The curvature at the free end increases with that at the clamp.
    let (mut low, mut high) = (0.0, load);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if end(middle)[1] < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let [_, _, along, across] = end(0.5 * (low + high));
    [along, across]
}

/// Values of Mattiasson 1981 by elliptic integrals verify this integration.
#[test]
fn elastica_is_that_of_the_table() {
    for (load, shortening, deflection) in [(1.0, 0.05643, 0.30172), (10.0, 0.55500, 0.81061)] {
        let [along, across] = elastica(load);
        assert!((1.0 - along - shortening).abs() < 6e-6, "{along}");
        assert!((across - deflection).abs() < 6e-6, "{across}");
    }
}

/// Second order in the length of the bonds. The bonds are as thin as a thousandth of the bar: their
/// elongation and shear are 1e-6 of it.
#[test]
fn the_end_tends_to_the_elastica() {
    for strength in [1.0, 10.0] {
        let exact = elastica(strength);
        let errors = [10, 20, 40].map(|bonds| {
            let length_m = 0.4 * f64::from(bonds);
            let mut state = bar(BondModel::Timoshenko, bonds, 0.001 * length_m / 0.2);
            let stiffness_n_m2 = 0.4 * state.bonds.stiffness(0).bending;
            let force_n = strength * stiffness_n_m2 / length_m.powi(2);
            fix(&mut state, &[0]);
            load(&mut state, &[bonds], [0.0, force_n, 0.0], [0.0; 3]);
            let found = rest(&mut state);
            eprintln!(
                "{bonds} {strength}: {} steps in {} load steps, {:?}",
                found.newton_steps, found.load_steps, found.residuals
            );
            let [x, y, ..] = state.particles.poses[bonds as usize].position_m;
            (x / length_m - exact[0]).hypot(y / length_m - exact[1])
        });
        eprintln!("{strength}: {errors:?}");
        assert!(errors[2] < 1e-3, "{errors:?}");
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((order - 2.0).abs() < 0.15, "order {order} of {errors:?}");
        }
    }
}
