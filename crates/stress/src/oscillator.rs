//! Oscillations of spheres on a line: their positions in closed form, as stepped by leapfrog, so
//! that only rounding errors remain.
//!
//! A bond is linear in elongation along a line. Kick-drift-kick takes x'' = -w^2 x from rest to
//! x_n = x_0 cos(n theta) with sin(theta / 2) = w dt / 2 exactly (Hairer et al. 2003).

use std::f64::consts::PI;

use dem_io::{Body, Result};

use super::prediction::{Member, Shown};
use super::trial::Trial;
use dem_physics::bond::pair::frequencies;
use dem_physics::bond::stiffness::{BondModel, BondShape, stiffness};

/// Spheres that touch along x, the first at `at_m`, joined by bonds, the last of which is
/// stretched.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    /// Radii of two or three spheres, m.
    pub radii_m: Vec<f64>,
    /// Initial distances of neighbours, m. One fewer than spheres.
    pub distances_m: Vec<f64>,
    /// Radii of the bonds, m. Length as `distances_m`.
    pub bond_radii_m: Vec<f64>,
    /// Young's modulus, Pa.
    pub young_modulus_pa: f64,
    /// kg/m3.
    pub density_kg_m3: f64,
    /// Centre of the first, m.
    pub at_m: f64,
    /// Initial strain of the last bond.
    pub strain: f64,
    /// Ratio of the step to the limit of the bond's two particles alone, for the fastest bond.
    pub fraction: f64,
    /// Oscillations of the slowest mode. An additional quarter shows the period best.
    pub oscillations: f64,
}

impl Row {
    /// Two spheres of 1 mm and 1 GPa that touch, at the origin.
    pub(crate) fn pair() -> Self {
        Self {
            radii_m: vec![1e-3; 2],
            distances_m: vec![2e-3],
            bond_radii_m: vec![1e-3],
            young_modulus_pa: 1e9,
            density_kg_m3: 2500.0,
            at_m: 0.0,
            strain: 1e-3,
            fraction: 0.5,
            oscillations: 10.25,
        }
    }

    fn mass_kg(&self, sphere: usize) -> f64 {
        self.density_kg_m3 * 4.0 / 3.0 * PI * self.radii_m[sphere].powi(3)
    }

    /// Initial length of a bond, m.
    fn length_m(&self, bond: usize) -> f64 {
        let is_last = bond + 1 == self.distances_m.len();
        let strain = if is_last { self.strain } else { 0.0 };
        self.distances_m[bond] / (1.0 + strain)
    }

    /// Stiffness of a bond along the line, N/m: E A / L0.
    fn normal_n_m(&self, bond: usize) -> f64 {
        let area = PI * self.bond_radii_m[bond].powi(2);
        self.young_modulus_pa * area / self.length_m(bond)
    }

    fn step_s(&self, model: BondModel) -> f64 {
        let of_bond = |bond: usize| {
            let shape = BondShape {
                length_m: self.length_m(bond),
                radius_m: self.bond_radii_m[bond],
                end_radii_m: [self.radii_m[bond], self.radii_m[bond + 1]],
            };
            let answer = stiffness(model, &shape, self.young_modulus_pa, 0.3);
            let masses = [bond, bond + 1].map(|sphere| self.mass_kg(sphere));
            let inverse = masses.map(|kg| 1.0 / kg);
            let inertia = [0, 1].map(|end| inverse[end] / (0.4 * self.radii_m[bond + end].powi(2)));
            frequencies(&answer, inverse, inertia).critical_step_s()
        };
        let bonds = 0..self.distances_m.len();
        self.fraction * bonds.map(of_bond).fold(f64::INFINITY, f64::min)
    }

    /// Modes of the elongations of the bonds: square of the circular frequency, 1/s2, and their
    /// contribution to each elongation, relative to the initial elongation of the last bond.
    fn modes(&self) -> Vec<(f64, Vec<f64>)> {
        let m = |sphere: usize| self.mass_kg(sphere);
        let k = |bond: usize| self.normal_n_m(bond);
        if self.distances_m.len() == 1 {
            return vec![(k(0) * (1.0 / m(0) + 1.0 / m(1)), vec![1.0])];
        }
        // s'' = -[[a, -b], [-c, d]] s of the two elongations.
        let a = k(0) * (1.0 / m(0) + 1.0 / m(1));
        let b = k(1) / m(1);
        let c = k(0) / m(1);
        let d = k(1) * (1.0 / m(1) + 1.0 / m(2));
        let fast = 0.5 * (a + d + (a - d).hypot(2.0 * (b * c).sqrt()));
        let slow = (a * d - b * c) / fast;
        // Eigenvectors from the row without cancellation, if bond 0 is the stiffer one.
        let of_fast = [fast - d, -c];
        let of_slow = [b, a - slow];
        let determinant = of_fast[0] * of_slow[1] - of_fast[1] * of_slow[0];
        // From the start [0, 1].
        let parts = [-of_slow[0] / determinant, of_fast[0] / determinant];
        let mode =
            |square: f64, vector: [f64; 2], part: f64| (square, vector.map(|v| part * v).to_vec());
        vec![mode(fast, of_fast, parts[0]), mode(slow, of_slow, parts[1])]
    }

    /// Its scene, with bonds of this model, and the final displacement of each sphere.
    pub(crate) fn member(&self, what: String, (model, name): (BondModel, &str)) -> Result<Member> {
        let step_s = self.step_s(model);
        let modes = self.modes();
        let angle = |square: f64| 2.0 * (0.5 * square.sqrt() * step_s).asin();
        let slowest = modes.iter().map(|(square, _)| angle(*square));
        let slowest = slowest.fold(f64::INFINITY, f64::min);
        let steps = (self.oscillations * 2.0 * PI / slowest).round();
        let stretched_m = self.distances_m.last().copied().unwrap_or(0.0)
            - self.length_m(self.distances_m.len() - 1);
        let gained_m: Vec<f64> = (0..self.distances_m.len())
            .map(|bond| {
                let of_mode = |(square, parts): &(f64, Vec<f64>)| {
                    parts[bond] * ((steps * angle(*square)).cos() - 1.0)
                };
                stretched_m * modes.iter().map(of_mode).sum::<f64>()
            })
            .collect();
        let moved_m = self.moved_m(&gained_m);
        // Every step rounds every coordinate once, by half a unit in the last place at most, and
        // earlier rounding errors oscillate.
        let extent_m = self.at_m.abs() + self.distances_m.iter().sum::<f64>();
        let rounding_m = steps * f64::EPSILON * extent_m;
        let names = ["first_moved", "second_moved", "third_moved"];
        let shown = moved_m.iter().zip(names);
        let shown = shown.map(|(moved, name)| Shown::measure(name, "m", *moved, rounding_m));
        let shown: Vec<Shown> = shown.collect();
        Ok(Member::ends(what, self.trial(name, step_s, steps)?, shown))
    }

    /// Displacement of each sphere once the bonds are longer by this, m: the centre of mass does
    /// not move.
    fn moved_m(&self, gained_m: &[f64]) -> Vec<f64> {
        let mut moved = vec![0.0];
        for gained in gained_m {
            moved.push(moved.last().copied().unwrap_or(0.0) + gained);
        }
        let masses: Vec<f64> = (0..moved.len()).map(|i| self.mass_kg(i)).collect();
        let moment: f64 = masses.iter().zip(&moved).map(|(m, x)| m * x).sum();
        let centre = moment / masses.iter().sum::<f64>();
        moved.iter().map(|x| x - centre).collect()
    }

    fn trial(&self, model: &str, step_s: f64, steps: f64) -> Result<Trial> {
        let mut text = format!(
            "version = 1
run = {{ end_time = {:e}, time_step = {step_s:e} }}
materials.m.density = {}
bonds.b = {{ model = \"{model}\", young_modulus = {:e}, poisson_ratio = 0.3 }}
bodies.row = {{ file = \"row.vtp\", material = \"m\", bonds = \"b\" }}
",
            steps * step_s,
            self.density_kg_m3,
            self.young_modulus_pa
        );
        let mut spheres = Vec::new();
        let mut x = self.at_m;
        for (i, radius) in self.radii_m.iter().enumerate() {
            spheres.push([x, 0.0, 0.0, *radius]);
            x += self.distances_m.get(i).copied().unwrap_or(0.0);
            let name = ["first", "second", "third"][i.min(2)];
            text += &format!(
                "groups.{name} = {{ body = \"row\", particles = [{i}] }}
measures.{name}_moved = {{ of = \"{name}\", quantity = \"displacement_x\" }}
"
            );
        }
        let bonds: Vec<[u32; 2]> = (0..self.distances_m.len() as u32)
            .map(|a| [a, a + 1])
            .collect();
        let mut body = Body::from_spheres(&spheres, &bonds)?;
        body.bond_radii.clone_from(&self.bond_radii_m);
        for (bond, length) in body.bond_lengths.iter_mut().enumerate() {
            *length = self.length_m(bond);
        }
        Ok(Trial {
            bodies: vec![("row.vtp", body)],
            ..Trial::of(text)
        })
    }
}
