//! Bending of a slender rigid body: the moments that it bears in some sections, if contacts push it
//! and its mass resists. The mean stress does not show them: a rod that hits a pin with its middle
//! has next to none.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Length over thickness of a body from which it is slender: a beam that bends before it is crushed.
const SLENDER: f64 = 4.0;
/// Places of the sections over the length, from the centre of mass.
const SECTIONS: [f64; COUNT] = [-0.25, 0.0, 0.25];
/// Number of sections.
pub const COUNT: usize = 3;
/// Stress in a section after an impulse there, over that which a force there causes in the rigid
/// body, is its impulse over the force, times this, times sqrt(E I / (mass per length)) / length^2:
/// the first two modes of a free beam, by their shapes there. In the middle only the first bends.
const MODES: [f64; COUNT] = [26.5, 15.4, 26.5];

/// A sphere of the body, relative to its centre of mass along its principal axes.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    /// m.
    pub place_m: Vector3<f64>,
    /// m.
    pub radius_m: f64,
    /// kg.
    pub mass_kg: f64,
    /// Its own moment of inertia, kg m2.
    pub inertia_kg_m2: f64,
}

/// A bond of the body, in the same axes.
#[derive(Debug, Clone, Copy)]
pub struct Bond {
    /// Its ends, m.
    pub ends_m: [Vector3<f64>; 2],
    /// m.
    pub radius_m: f64,
    /// Young's modulus times section, N.
    pub axial_stiffness_n: f64,
}

/// A section of a slender body across its longest principal axis, and the part beyond it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Section {
    /// Its place on the axis, m.
    at_m: f64,
    /// Mass of the part times the way from the section to its centre, kg m.
    moment_kg_m: Vector3<f64>,
    /// Moments about the section of the forces of mass per angular acceleration about the centre,
    /// kg m2.
    inertia_kg_m2: Matrix3<f64>,
    /// Section modulus for moments about each principal axis, m3; infinite about the longest.
    moduli_m3: Vector3<f64>,
    /// How fast modes of the free body follow, 1/s: see [`MODES`].
    rate_1_s: f64,
}

/// Sections of a slender body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SlenderBody {
    sections: [Section; COUNT],
    /// Volume of all spheres, overlaps counted twice, m3.
    pub volume_m3: f64,
}

/// Force, N, and moment about the centre of the body, N m, on the part beyond each section.
pub type Beyond = [[Vector3<f64>; 2]; COUNT];

/// The bonds that cross a section, as the elements of a beam whose sections remain plane.
struct Crossing {
    area_m2: f64,
    modulus_pa: f64,
    /// About the two principal axes in the section: second moment of area, m4, and distance of the
    /// farthest edge, m.
    bending: [[f64; 2]; 2],
}

impl Crossing {
    fn of(bonds: &[Bond], at_m: f64) -> Self {
        let crosses = |bond: &&Bond| (bond.ends_m[0].x > at_m) != (bond.ends_m[1].x > at_m);
        let crossing: Vec<&Bond> = bonds.iter().filter(crosses).collect();
        let place = |bond: &Bond| {
            let [a, b] = bond.ends_m;
            a + (b - a) * ((at_m - a.x) / (b.x - a.x))
        };
        let area = |bond: &Bond| PI * bond.radius_m.powi(2);
        let area_m2: f64 = crossing.iter().map(|bond| area(bond)).sum();
        let weighted = crossing.iter().map(|bond| area(bond) * place(bond));
        let middle = weighted.sum::<Vector3<f64>>() / area_m2;
        let stiffness_n: f64 = crossing.iter().map(|bond| bond.axial_stiffness_n).sum();
        let bending = [2, 1].map(|across| {
            let of = |bond: &&Bond| {
                let away_m = (place(bond) - middle)[across];
                let own_m2 = away_m.powi(2) + 0.25 * bond.radius_m.powi(2);
                [area(bond) * own_m2, away_m.abs() + bond.radius_m]
            };
            (crossing.iter().map(of)).fold([0.0_f64; 2], |all, one| {
                [all[0] + one[0], all[1].max(one[1])]
            })
        });
        Self {
            area_m2,
            modulus_pa: stiffness_n / area_m2,
            bending,
        }
    }
}

impl SlenderBody {
    /// The body of these parts and bonds with this mass, kg, and these principal moments of inertia,
    /// ascending, kg m2, to which the masses and moments of the parts are scaled. None: it is not
    /// slender, or no bond crosses one of the sections.
    pub fn of(
        parts: &[Part],
        (mass_kg, moments_kg_m2): (f64, [f64; 3]),
        bonds: &[Bond],
    ) -> Option<Self> {
        let [i0, i1, i2] = moments_kg_m2;
        // That of a uniform bar; its axis is that of the smallest moment, x.
        let length_m = (6.0 * (i1 + i2 - i0) / mass_kg).sqrt();
        let crossings = SECTIONS.map(|at| Crossing::of(bonds, at * length_m));
        let thickness_m = |one: &Crossing| 2.0 * one.bending[0][1].min(one.bending[1][1]);
        let thickest_m = crossings.iter().map(thickness_m).fold(0.0, f64::max);
        let is_whole = crossings.iter().all(|one| one.area_m2 > 0.0);
        if !is_whole || length_m < SLENDER * thickest_m {
            return None;
        }
        let of_mass = mass_kg / parts.iter().map(|part| part.mass_kg).sum::<f64>();
        let own = parts.iter().map(|part| {
            let [x, y, z] = part.place_m.into();
            part.mass_kg * (2.0 * x * x + y * y + z * z) + 2.0 * part.inertia_kg_m2
        });
        let of_inertia = (i1 + i2) / own.sum::<f64>();
        let section = |k: usize| {
            let crossing = &crossings[k];
            let [about_1, about_2] = crossing.bending;
            let rigidity = crossing.modulus_pa * about_1[0].min(about_2[0]) * length_m / mass_kg;
            let moduli = Vector3::new(
                f64::INFINITY,
                about_1[0] / about_1[1],
                about_2[0] / about_2[1],
            );
            let rate_1_s = MODES[k] * rigidity.sqrt() / length_m.powi(2);
            let mut section = Section::of(parts, SECTIONS[k] * length_m, moduli, rate_1_s);
            section.moment_kg_m *= of_mass;
            section.inertia_kg_m2 *= of_inertia;
            section
        };
        let volume_m3 = |part: &Part| 4.0 / 3.0 * PI * part.radius_m.powi(3);
        Some(Self {
            sections: [0, 1, 2].map(section),
            volume_m3: parts.iter().map(volume_m3).sum(),
        })
    }

    /// Adds a force, N, with this moment about the centre, N m, at a place, m, all along the
    /// principal axes, to the parts beyond which it acts.
    pub fn add(
        &self,
        beyond: &mut Beyond,
        place_m: &Vector3<f64>,
        [force, moment]: [Vector3<f64>; 2],
    ) {
        for (section, sums) in self.sections.iter().zip(beyond) {
            if place_m.x > section.at_m {
                sums[0] += force;
                sums[1] += moment;
            }
        }
    }

    /// Largest stress of bending at the edge of a section, Pa, and the rate at which the modes of
    /// the body follow it, Pa/s, if the body accelerates with these, m/s2 and rad/s2, along the
    /// principal axes. Gravity, which accelerates all alike, counts on neither side.
    pub fn stress(&self, accelerations: [Vector3<f64>; 2], beyond: &Beyond) -> [f64; 2] {
        let each = self.sections.iter().zip(beyond).map(|(section, sums)| {
            let stress_pa = section.stress_pa(&section.moment_n_m(accelerations, sums));
            [stress_pa, section.rate_1_s * stress_pa]
        });
        each.fold([0.0; 2], |[a, b], one| [a.max(one[0]), b.max(one[1])])
    }
}

impl Section {
    fn of(parts: &[Part], at_m: f64, moduli_m3: Vector3<f64>, rate_1_s: f64) -> Self {
        let beyond = parts.iter().filter(|part| part.place_m.x > at_m);
        let from_section = |part: &Part| part.place_m - at_m * Vector3::x();
        let inertia = |part: &Part| {
            let (place, way) = (part.place_m, from_section(part));
            let about = way.dot(&place) * Matrix3::identity() - place * way.transpose();
            part.mass_kg * about + part.inertia_kg_m2 * Matrix3::identity()
        };
        Self {
            at_m,
            moment_kg_m: (beyond.clone())
                .map(|part| part.mass_kg * from_section(part))
                .sum(),
            inertia_kg_m2: beyond.map(inertia).sum(),
            moduli_m3,
            rate_1_s,
        }
    }

    fn moment_n_m(
        &self,
        [linear, angular]: [Vector3<f64>; 2],
        [force, moment]: &[Vector3<f64>; 2],
    ) -> Vector3<f64> {
        let of_mass = self.moment_kg_m.cross(&linear) + self.inertia_kg_m2 * angular;
        of_mass - (moment - self.at_m * Vector3::x().cross(force))
    }

    /// Stress at the edge under a moment, Pa.
    fn stress_pa(&self, moment_n_m: &Vector3<f64>) -> f64 {
        moment_n_m.component_div(&self.moduli_m3).norm()
    }
}
