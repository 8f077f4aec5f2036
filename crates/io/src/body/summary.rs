//! The contents of a body, human-readable and as JSON.

use std::fmt;

use serde::Serialize;

use super::mass::{centre_text, moments_text, of_body, percent_text};
use super::parts::{About, Body};
use crate::disjoint::DisjointSets;
use crate::text::visible;
use crate::units::{show_length, significant};

/// The contents of a body. SI units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodySummary {
    /// Number of particles.
    pub particles: usize,
    /// Number of bonds.
    pub bonds: usize,
    /// Number of bonds / number of particles. Each bond belongs to two, so a particle has twice as
    /// many on average.
    pub bonds_per_particle: f64,
    /// Number of particles without a bond.
    pub unbonded_particles: usize,
    /// Number of pieces connected by bonds. A particle without a bond is a piece.
    pub pieces: usize,
    /// Number of particles of the largest piece.
    pub largest_piece: usize,
    /// Smallest particle radius, m.
    pub radius_min_m: f64,
    /// Mean particle radius, m.
    pub radius_mean_m: f64,
    /// Largest particle radius, m.
    pub radius_max_m: f64,
    /// Smallest corner of the box around all particles, m. Length 3.
    pub box_min_m: [f64; 3],
    /// Largest corner of the box around all particles, m. Length 3.
    pub box_max_m: [f64; 3],
    /// Sum of the particles' volumes, overlaps counted twice, m3.
    pub particle_volume_m3: f64,
    /// Sum of the particles' masses, kg, if their density is known.
    pub mass_kg: Option<f64>,
    /// Mass by volume of the shape, kg/m3, if both are known.
    pub solid_density_kg_m3: Option<f64>,
    /// Mass of the shape filled with the density of the particles, kg, if both are known.
    pub shape_mass_kg: Option<f64>,
    /// Difference between the mass of the body and that mass, percent, if the volume of the shape
    /// is known; independent of the density.
    pub mass_difference_percent: Option<f64>,
    /// Centre of mass, m. Length 3.
    pub centre_m: [f64; 3],
    /// Principal moments of inertia, ascending, kg m2, if the density is known. Length 3.
    pub principal_moments_kg_m2: Option<[f64; 3]>,
    /// Inertia about the centre of mass, kg m2, if the density is known: a symmetric matrix.
    pub inertia_kg_m2: Option<[[f64; 3]; 3]>,
    /// Information on its origin.
    pub about: About,
}

/// The contents of `body`, which must follow the rules of [`Body::check`]. Takes linear time.
pub fn body_summary(body: &Body) -> BodySummary {
    let particles = body.positions.len();
    let mut box_min_m = [f64::INFINITY; 3];
    let mut box_max_m = [f64::NEG_INFINITY; 3];
    for (position, radius) in body.positions.iter().zip(&body.radii) {
        for k in 0..3 {
            box_min_m[k] = box_min_m[k].min(position[k] - radius);
            box_max_m[k] = box_max_m[k].max(position[k] + radius);
        }
    }
    let volume: f64 = body
        .radii
        .iter()
        .map(|r| 4.0 / 3.0 * std::f64::consts::PI * r * r * r)
        .sum();
    let density = body.about.particle_density_kg_m3;
    let mass_kg = density.map(|density| density * volume);
    // The position of the centre does not depend on the density.
    let properties = of_body(body, density.unwrap_or(1.0));
    let shape_volume = body.about.shape_volume_m3;
    let piece_sizes = piece_sizes(body);
    BodySummary {
        particles,
        bonds: body.bonds.len(),
        bonds_per_particle: body.bonds.len() as f64 / particles as f64,
        unbonded_particles: piece_sizes.iter().filter(|size| **size == 1).count(),
        pieces: piece_sizes.len(),
        largest_piece: piece_sizes.iter().copied().max().unwrap_or_default(),
        radius_min_m: body.radii.iter().copied().fold(f64::INFINITY, f64::min),
        radius_mean_m: body.radii.iter().sum::<f64>() / particles as f64,
        radius_max_m: body.radii.iter().copied().fold(0.0, f64::max),
        box_min_m,
        box_max_m,
        particle_volume_m3: volume,
        mass_kg,
        solid_density_kg_m3: mass_kg
            .zip(body.about.shape_volume_m3)
            .map(|(mass, volume)| mass / volume),
        shape_mass_kg: density.zip(shape_volume).map(|(of, volume)| of * volume),
        mass_difference_percent: shape_volume.map(|shape| 100.0 * (volume / shape - 1.0)),
        centre_m: properties.centre_m,
        principal_moments_kg_m2: density.map(|_| properties.moments_kg_m2),
        inertia_kg_m2: density.map(|_| properties.inertia_kg_m2()),
        about: body.about.clone(),
    }
}

/// Number of particles in each piece connected by bonds, by the first particle of each.
fn piece_sizes(body: &Body) -> Vec<usize> {
    let mut sets = DisjointSets::new(body.positions.len());
    for &[a, b] in &body.bonds {
        sets.join(a, b);
    }
    let particles = (0..).take(body.positions.len());
    let roots: Vec<u32> = particles.filter(|&p| sets.root(p) == p).collect();
    roots.iter().map(|&root| sets.size(root) as usize).collect()
}

impl fmt::Display for BodySummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            radius_min_m,
            radius_max_m,
            ..
        } = *self;
        write!(
            f,
            "particles  {}, diameter {}",
            self.particles,
            show_length(2.0 * radius_min_m)
        )?;
        if radius_max_m > radius_min_m {
            let (largest, mean) = (
                show_length(2.0 * radius_max_m),
                show_length(2.0 * self.radius_mean_m),
            );
            write!(f, " to {largest}, mean {mean}")?;
        }
        writeln!(
            f,
            "\nbonds      {}, {} per particle",
            self.bonds,
            significant(self.bonds_per_particle, 3)
        )?;
        let (pieces, largest, single) = (self.pieces, self.largest_piece, self.unbonded_particles);
        writeln!(
            f,
            "pieces     {pieces}, the largest of {largest} particles; {single} particles without a bond"
        )?;
        let show_point = |point: [f64; 3]| point.map(show_length).join(", ");
        writeln!(
            f,
            "box        from {} to {}",
            show_point(self.box_min_m),
            show_point(self.box_max_m)
        )?;
        if let (Some(mass), Some(density)) = (self.mass_kg, self.about.particle_density_kg_m3) {
            write!(
                f,
                "mass       {} kg, particles of {} kg/m3",
                significant(mass, 4),
                significant(density, 4)
            )?;
            if let Some(solid) = self.solid_density_kg_m3 {
                write!(f, ", solid of {} kg/m3", significant(solid, 4))?;
            }
            writeln!(f)?;
        }
        self.write_shape_mass(f)?;
        let about = &self.about;
        let made = [
            about
                .program
                .as_ref()
                .map(|program| format!("by {}", visible(program))),
            about
                .source
                .as_ref()
                .map(|source| format!("from {}", visible(source))),
            about.source_hash.map(|hash| format!("hash {hash:016x}")),
            about
                .shape_volume_m3
                .map(|volume| format!("shape of {} m3", significant(volume, 4))),
            about.overlap.map(|overlap| format!("overlap {overlap}")),
            about
                .bond_range
                .map(|radius| format!("bond range {radius}")),
            about.seed.map(|seed| format!("seed {seed}")),
        ];
        let made: Vec<String> = made.into_iter().flatten().collect();
        if !made.is_empty() {
            writeln!(f, "made       {}", made.join(", "))?;
        }
        self.write_quality(f)
    }
}

impl BodySummary {
    /// Whether few particles lie across it, and warnings of the program that made it.
    fn write_quality(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(coarse) = self.about.coarse() {
            writeln!(f, "coarse     {coarse}")?;
        }
        for warning in &self.about.warnings {
            writeln!(f, "warning    when it was made: {warning}")?;
        }
        Ok(())
    }

    /// The mass of its shape, its centre of mass and its moments of inertia.
    fn write_shape_mass(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(difference) = self.mass_difference_percent {
            let percent = percent_text(difference);
            match (self.shape_mass_kg, self.about.particle_density_kg_m3) {
                (Some(mass), Some(density)) => writeln!(
                    f,
                    "           its shape filled with {} kg/m3 would weigh {} kg ({percent})",
                    significant(density, 4),
                    significant(mass, 4)
                )?,
                _ => writeln!(
                    f,
                    "mass       {} of its shape filled with the density of its particles",
                    significant(1.0 + 0.01 * difference, 4)
                )?,
            }
        }
        let known = self.mass_kg.zip(self.principal_moments_kg_m2);
        // Without a density the size of rounding errors is unknown.
        let (mass_kg, moments) = known.unwrap_or((1.0, [0.0; 3]));
        write!(
            f,
            "centre     {}",
            centre_text(self.centre_m, moments, mass_kg)
        )?;
        match self.principal_moments_kg_m2 {
            Some(moments) => writeln!(f, "; {}", moments_text(moments)),
            None => writeln!(f),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `particles` of 1 mm radius in a row, 2 mm apart.
    fn row(particles: u32, bonds: Vec<[u32; 2]>) -> Body {
        Body {
            positions: (0..particles)
                .map(|i| [f64::from(i) * 2e-3, 0.0, 5.0])
                .collect(),
            radii: vec![1e-3; particles as usize],
            bond_radii: vec![1e-3; bonds.len()],
            bond_lengths: vec![2e-3; bonds.len()],
            bonds,
            ..Body::default()
        }
    }

    #[test]
    fn pieces_do_not_depend_on_the_order_of_the_bonds() {
        let mut bonds: Vec<[u32; 2]> = (1..1000).map(|b| [b - 1, b]).collect();
        bonds.remove(599);
        bonds.push([0, 5]);
        for _ in 0..2 {
            let summary = body_summary(&row(1001, bonds.clone()));
            assert_eq!((summary.pieces, summary.largest_piece), (3, 600));
            assert_eq!((summary.unbonded_particles, summary.bonds), (1, 999));
            bonds.reverse();
        }
    }

    #[test]
    fn box_radii_and_masses() {
        let mut body = row(2, vec![]);
        body.radii[1] = 3e-3;
        let summary = body_summary(&body);
        assert_eq!(summary.box_min_m, [-1e-3, -3e-3, 5.0 - 3e-3]);
        assert_eq!(summary.box_max_m, [5e-3, 3e-3, 5.0 + 3e-3]);
        assert_eq!(
            (
                summary.radius_min_m,
                summary.radius_mean_m,
                summary.radius_max_m
            ),
            (1e-3, 2e-3, 3e-3)
        );
        assert_eq!((summary.mass_kg, summary.solid_density_kg_m3), (None, None));
        body.about.particle_density_kg_m3 = Some(3000.0);
        body.about.shape_volume_m3 = Some(1e-6);
        let summary = body_summary(&body);
        let volume = 4.0 / 3.0 * std::f64::consts::PI * 28e-9;
        assert!((summary.particle_volume_m3 / volume - 1.0).abs() < 1e-14);
        assert!(
            summary
                .mass_kg
                .is_some_and(|mass| (mass / (3000.0 * volume) - 1.0).abs() < 1e-14)
        );
        assert!(
            summary
                .solid_density_kg_m3
                .is_some_and(|density| (density / (3e9 * volume) - 1.0).abs() < 1e-14)
        );
    }
}
