//! The spheres and bonds of a frame.

use dem_io::Result;
use dem_io::body::stored_frame::{BOND_RADIUS, BROKEN, FRAGMENT_ID, PARTICLE_ID, RADIUS};
use dem_results::{Arrays, read_arrays};

use super::choose::ChosenFrame;

/// The shown spheres of a frame. SI units; a list has a value for each sphere.
#[derive(Debug, Clone, Default)]
pub(crate) struct Spheres {
    pub(crate) centres_m: Vec<[f64; 3]>,
    pub(crate) radii_m: Vec<f64>,
    pub(crate) fragments: Vec<u32>,
    pub(crate) bodies: Vec<u32>,
    pub(crate) speeds_m_s: Vec<f64>,
    /// Mass of the fragment, kg.
    pub(crate) masses_kg: Vec<f64>,
    /// Largest utilisation of the intact bonds.
    pub(crate) utilisations: Vec<f64>,
    /// Largest strain rate (1/s), dynamic increase factor and dynamic utilisation of the intact
    /// bonds. Empty: the frame has none.
    pub(crate) dynamic: [Vec<f64>; 3],
    /// Mean normal stress of the intact bonds, Pa.
    pub(crate) stresses_pa: Vec<f64>,
    pub(crate) bonds: Vec<Bond>,
    pub(crate) body_names: Vec<String>,
    /// Whether the frame knows fragments.
    pub(crate) can_break: bool,
}

/// A bond between two shown spheres.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bond {
    pub(crate) ends: [u32; 2],
    pub(crate) radius_m: f64,
    pub(crate) utilisation: f64,
    pub(crate) stress_pa: f64,
    pub(crate) is_broken: bool,
}

impl Spheres {
    /// Reads a frame: of so many spheres one, and the bonds between them if wanted.
    pub(crate) fn read(frame: &ChosenFrame, every: usize, with_bonds: bool) -> Result<Self> {
        let of_points = |name: &str| format!("PointData/{name}");
        let of_bonds = |name: &str| format!("CellData/{name}");
        let wanted = [
            "Points/positions_m".to_owned(),
            of_points(RADIUS),
            of_points(FRAGMENT_ID),
            of_points("body"),
            of_points("velocity_m_s"),
            of_points("fragment_mass_kg"),
            of_points(PARTICLE_ID),
            "Lines/connectivity".to_owned(),
            of_bonds(BOND_RADIUS),
            of_bonds("utilisation"),
            of_bonds("normal_stress_pa"),
            of_bonds(BROKEN),
            of_bonds("strain_rate_1_s"),
            of_bonds("dynamic_increase_factor"),
            of_bonds("dynamic_utilisation"),
        ];
        let arrays = read_arrays(&frame.path, &wanted.each_ref().map(String::as_str))?;
        let all = |name: &String| arrays.get(name).unwrap_or_default();
        let ids = all(&wanted[6]);
        // A particle that is shown once is shown always.
        let id = |i: usize| ids.get(i).map_or(i, |id| *id as usize);
        let is_kept = |i: &usize| id(*i).is_multiple_of(every);
        let kept: Vec<usize> = (0..arrays.points).filter(is_kept).collect();
        let of = |name: &String| -> Vec<f64> {
            let values = all(name);
            let value = |i: &usize| values.get(*i).copied().unwrap_or(0.0);
            kept.iter().map(value).collect()
        };
        let vectors = |name: &String| -> Vec<[f64; 3]> {
            let (whole, _) = all(name).as_chunks::<3>();
            kept.iter().filter_map(|i| whole.get(*i).copied()).collect()
        };
        let counts = |name: &String| of(name).into_iter().map(|value| value as u32).collect();
        let speed = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt();
        let mut spheres = Self {
            centres_m: vectors(&wanted[0]),
            radii_m: of(&wanted[1]),
            fragments: counts(&wanted[2]),
            bodies: counts(&wanted[3]),
            speeds_m_s: vectors(&wanted[4]).into_iter().map(speed).collect(),
            masses_kg: of(&wanted[5]),
            body_names: arrays.body_names.clone(),
            can_break: arrays.get(&wanted[2]).is_some(),
            ..Self::default()
        };
        let mut numbers = vec![None; arrays.points];
        for (number, i) in (0..).zip(kept) {
            numbers[i] = Some(number);
        }
        spheres.add_bonds(&arrays, &numbers, with_bonds, &wanted[7..]);
        Ok(spheres)
    }

    /// Adds the bonds, and what they say of their spheres. `numbers`: that of each particle of the
    /// frame among the shown ones.
    fn add_bonds(
        &mut self,
        arrays: &Arrays,
        numbers: &[Option<u32>],
        with_bonds: bool,
        names: &[String],
    ) {
        let values = |at: usize| arrays.get(&names[at]).unwrap_or_default();
        let (ends, _) = values(0).as_chunks::<2>();
        let of = |at: usize, bond: usize| values(at).get(bond).copied().unwrap_or(0.0);
        let count = self.radii_m.len();
        let mut sums = vec![(0.0, 0_u32); count];
        self.utilisations = vec![0.0; count];
        self.dynamic = [5, 6, 7].map(|at| match values(at) {
            [] => Vec::new(),
            _ => vec![0.0; count],
        });
        for (bond, ends) in ends.iter().enumerate() {
            let [Some(a), Some(b)] = ends.map(|end| numbers.get(end as usize).copied()) else {
                continue;
            };
            let found = Bond {
                ends: [a, b].map(Option::unwrap_or_default),
                radius_m: of(1, bond),
                utilisation: of(2, bond),
                stress_pa: of(3, bond),
                is_broken: of(4, bond) != 0.0,
            };
            for end in [a, b].into_iter().flatten().filter(|_| !found.is_broken) {
                let end = end as usize;
                self.utilisations[end] = self.utilisations[end].max(found.utilisation);
                for (at, largest) in (5..).zip(&mut self.dynamic) {
                    if let Some(largest) = largest.get_mut(end) {
                        *largest = largest.max(of(at, bond));
                    }
                }
                sums[end].0 += found.stress_pa;
                sums[end].1 += 1;
            }
            if with_bonds && a.is_some() && b.is_some() {
                self.bonds.push(found);
            }
        }
        let mean = |(sum, number): (f64, u32)| sum / f64::from(number.max(1));
        self.stresses_pa = sums.into_iter().map(mean).collect();
    }
}
