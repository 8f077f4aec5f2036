//! Stress along the loaded diameter of a disc, from the forces of bonds and contacts.

use std::fmt::Write;

use dem_laboratory::Specimen;
use dem_laboratory::theory::disc_diameter_pa;
use dem_plots::{Line, Plot};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::setup::Setup;
use dem_engine::stages::contacts::forces::{pair_force_n, touch_point_m};
use dem_engine::stages::walls::{self, touch_force_n};
use dem_engine::state::State;
use dem_laboratory::figure::{Figure, Source};

/// Stress across the loaded diameter, the mean of its middle half, Pa.
pub const ACROSS: &str = "stress across the loaded diameter";
/// Stress along the loaded diameter in the centre of the disc, Pa.
pub const ALONG: &str = "stress along it in the centre";
/// The load grows by this factor between two stresses that are computed.
const GROWTH: f64 = 1.1;

/// Stress in slabs along the loaded diameter.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DiscStress {
    /// Load, N.
    pub load_n: f64,
    /// Of each slab, in the order of the direction of the load: stress across the diameter and
    /// along it, Pa, positive in tension.
    pub slabs_pa: Vec<[f64; 2]>,
}

impl DiscStress {
    /// Replaces it by that of a state without broken bonds whose load has grown.
    pub(super) fn follow(&mut self, load_n: f64, setup: &Setup, state: &State) {
        if load_n > GROWTH * self.load_n {
            self.load_n = load_n;
            self.slabs_pa = slabs_pa(setup, state);
        }
    }
}

/// Mean stress of each slab, Pa: the sum over its particles of force times the way from the centre
/// to the point where it acts, over their volume (Love 1927, Weber 1966).
fn slabs_pa(setup: &Setup, state: &State) -> Vec<[f64; 2]> {
    let moments = moments_n_m(state);
    let [across, along] = [setup.along, setup.direction].map(Vector3::from);
    let mut sums = vec![([0.0; 2], 0.0); setup.slabs];
    for member in &setup.strip {
        let moment = &moments[member.particle as usize];
        let ([x, y], volume_m3) = &mut sums[member.slab];
        *x += across.dot(&(moment * across));
        *y += along.dot(&(moment * along));
        *volume_m3 += member.volume_m3;
    }
    let mean = |(sum, volume): ([f64; 2], f64)| sum.map(|sum| sum / volume);
    sums.into_iter().map(mean).collect()
}

/// Of each particle, the sum of force times the way from its centre to where the force acts, N m.
fn moments_n_m(state: &State) -> Vec<Matrix3<f64>> {
    let p = &state.particles;
    let place = |i: u32| p.poses[i as usize].place();
    let mut moments = vec![Matrix3::zeros(); p.len()];
    let mut add = |i: u32, force_n: Vector3<f64>, point: Vector3<f64>| {
        moments[i as usize] += force_n * (point - place(i)).transpose();
    };
    for at in (0..state.bonds.len()).filter(|at| !state.bonds.is_broken(*at)) {
        let [a, b] = state.bonds.ends[at];
        let force_n = state.bonds.forces(at, &p.poses).force_on_b;
        let middle = 0.5 * (place(a) + place(b));
        add(a, -force_n, middle);
        add(b, force_n, middle);
    }
    let Some(contacts) = &state.contacts else {
        return moments;
    };
    let touching = contacts.pairs.iter().zip(&contacts.histories);
    for (&[a, b], history) in touching.filter(|(_, history)| history.overlap_m() > 0.0) {
        let force_n = pair_force_n(contacts, p, [a, b], history);
        let point = touch_point_m(&p.poses[a as usize], &p.poses[b as usize]);
        add(a, -force_n, point);
        add(b, force_n, point);
    }
    for wall in &state.walls {
        let touching = wall.touching.iter();
        for touch in touching.filter(|touch| touch.history.overlap_m() > 0.0) {
            let force_n = touch_force_n(wall, contacts, p, touch);
            add(touch.particle, force_n, walls::touch_point_m(p, touch));
        }
    }
    moments
}

/// A slab: distance of its middle from the centre, m, its stresses and those of the closed form,
/// across and along the diameter, Pa.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slab {
    /// m.
    pub from_centre_m: f64,
    /// Pa.
    pub stress_pa: [f64; 2],
    /// Pa.
    pub theory_pa: [f64; 2],
}

/// The slabs of a disc. Empty: no stress was computed.
pub fn slabs(setup: &Setup, found: &DiscStress) -> Vec<Slab> {
    let Specimen::Disc {
        diameter_m,
        thickness_m,
    } = setup.specimen
    else {
        return Vec::new();
    };
    let count = found.slabs_pa.len();
    let slab = |(at, stress_pa): (usize, &[f64; 2])| {
        let from_centre_m = diameter_m * ((at as f64 + 0.5) / count as f64 - 0.5);
        Slab {
            from_centre_m,
            stress_pa: *stress_pa,
            theory_pa: disc_diameter_pa(found.load_n, diameter_m, thickness_m, from_centre_m),
        }
    };
    let all = found.slabs_pa.iter().enumerate().map(slab);
    all.filter(|slab| slab.stress_pa[0].is_finite()).collect()
}

/// Means over the middle half, and over the middle sixth, with their closed forms.
pub(super) fn figures(setup: &Setup, found: &DiscStress) -> Vec<Figure> {
    let slabs = slabs(setup, found);
    let Specimen::Disc { diameter_m, .. } = setup.specimen else {
        return Vec::new();
    };
    let mean = |name: &str, which: usize, within_m: f64| {
        let inside = slabs
            .iter()
            .filter(|slab| slab.from_centre_m.abs() <= within_m);
        let inside: Vec<&Slab> = inside.collect();
        let sum = |of: &dyn Fn(&Slab) -> f64| inside.iter().map(|slab| of(slab)).sum::<f64>();
        let count = inside.len() as f64;
        let [value, theory] = [
            sum(&|slab| slab.stress_pa[which]) / count,
            sum(&|slab| slab.theory_pa[which]) / count,
        ];
        (count > 0.0).then(|| Figure::new(name, value, "Pa", Some(theory)).by(Source::ClosedForm))
    };
    let across = mean(ACROSS, 0, 0.25 * diameter_m);
    let along = mean(ALONG, 1, diameter_m / 12.0);
    across.into_iter().chain(along).collect()
}

/// `disc-stress.csv`.
pub(super) fn table(slabs: &[Slab]) -> String {
    let mut out = "from_centre_m,across_pa,along_pa,theory_across_pa,theory_along_pa\n".to_owned();
    for slab in slabs {
        let ([x, y], [theory_x, theory_y]) = (slab.stress_pa, slab.theory_pa);
        // Writing to a string cannot fail.
        let _ = writeln!(
            out,
            "{:e},{x:e},{y:e},{theory_x:e},{theory_y:e}",
            slab.from_centre_m
        );
    }
    out
}

/// Both stresses over the distance from the centre, with the closed form.
pub(super) fn plot(slabs: &[Slab], load_n: f64) -> Plot {
    let line = |name: &str, dashed: bool, of: &dyn Fn(&Slab) -> f64| Line {
        name: name.to_owned(),
        points: slabs
            .iter()
            .map(|slab| [slab.from_centre_m, of(slab)])
            .collect(),
        dashed,
    };
    Plot::of(
        format!(
            "stress over the loaded diameter at {}",
            dem_io::units::show_quantity(load_n, "N")
        ),
        "distance from the centre (m)",
        "stress (Pa)",
        vec![
            line("across the diameter", false, &|slab| slab.stress_pa[0]),
            line("along it", false, &|slab| slab.stress_pa[1]),
            line("closed form across", true, &|slab| slab.theory_pa[0]),
            line("closed form along", true, &|slab| slab.theory_pa[1]),
        ],
    )
}
