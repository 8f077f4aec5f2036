//! The spheres and walls of a frame as a picture shows them.

use std::path::{Path, PathBuf};

use dem_io::body::stored_walls::StoredWalls;
use dem_io::units::show_quantity;
use dem_io::{Diagnostic, Result};
use dem_pictures::colours::of_fragment;
use dem_pictures::{Ball, Camera, Surface};
use dem_plots::{blue_to_red, viridis};

use super::colour_by::ColourBy;
use crate::home::Home;
use crate::view::{ChosenFrame, Pieces, Spheres, most_of, read_walls};

/// A frame in memory.
pub(super) struct Seen {
    spheres: Spheres,
    walls: Option<StoredWalls>,
}

impl Seen {
    /// Reads a frame of this time, s.
    pub(super) fn read(frame: &(PathBuf, f64)) -> Result<Self> {
        let frame = ChosenFrame::from(frame);
        Ok(Self {
            spheres: Spheres::read(&frame, 1, false)?,
            walls: read_walls(&frame)?,
        })
    }

    /// Whether a sphere is within a picture of this size, px.
    pub(super) fn is_within(&self, camera: &Camera, size_px: [u32; 2]) -> bool {
        let spheres = self.spheres.centres_m.iter().zip(&self.spheres.radii_m);
        let mut spheres = spheres.map(|(centre_m, radius_m)| {
            let [x, y, _] = camera.project(*centre_m);
            ([x, y], radius_m * camera.px_per_m())
        });
        let [wide, high] = size_px.map(f64::from);
        spheres.any(|([x, y], more)| {
            (-more..=wide + more).contains(&x) && (-more..=high + more).contains(&y)
        })
    }

    /// Points between which everything at home lies, m.
    pub(super) fn points_m(&self, home: &Home) -> impl Iterator<Item = [f64; 3]> {
        let spheres = self.spheres.centres_m.iter().zip(&self.spheres.radii_m);
        let spheres = spheres.filter(|(centre_m, _)| home.contains(centre_m));
        let ends = |(centre, radius_m): (&[f64; 3], &f64)| {
            [-radius_m, *radius_m].map(|more| centre.map(|x| x + more))
        };
        let walls = self.walls.iter().flat_map(|walls| walls.points_m.clone());
        spheres.flat_map(ends).chain(walls)
    }

    /// Number of spheres that are not at home.
    pub(super) fn far_away(&self, home: &Home) -> usize {
        let centres_m = self.spheres.centres_m.iter();
        centres_m
            .filter(|centre_m| !home.contains(centre_m))
            .count()
    }

    pub(super) fn balls(&self, colours: &Colours) -> Vec<Ball> {
        let spheres = &self.spheres;
        let ball = |i: usize| Ball {
            centre_m: spheres.centres_m[i],
            radius_m: spheres.radii_m[i],
            colour: colours.of_sphere(spheres, i),
        };
        (0..spheres.centres_m.len()).map(ball).collect()
    }

    /// Each wall as a surface; those that are `solid` are seen from outside only.
    pub(super) fn walls(&self, solid: &[String]) -> Vec<Surface> {
        let Some(walls) = &self.walls else {
            return Vec::new();
        };
        let of = |wall: usize| {
            let numbers = walls.triangles.iter().zip(&walls.wall_of_triangle);
            let own = numbers.filter(|(_, of)| **of as usize == wall);
            let triangles: Vec<[u32; 3]> = own.map(|(triangle, _)| *triangle).collect();
            Surface {
                solid: solid.contains(&walls.names[wall]),
                ..Surface::mesh(&walls.points_m, &triangles)
            }
        };
        (0..walls.names.len()).map(of).collect()
    }
}

/// The colours of spheres, the same in all pictures of a film.
pub(super) struct Colours {
    by: ColourBy,
    /// By number of the fragment.
    pieces: Vec<[u8; 3]>,
    /// Value at the upper end of the scale.
    highest: f64,
}

impl Colours {
    /// For these frames of the run in `folder`.
    pub(super) fn of(by: ColourBy, folder: &Path, frames: &[(PathBuf, f64)]) -> Result<Self> {
        let mut colours = Self {
            by,
            pieces: Vec::new(),
            highest: 0.0,
        };
        let mut last = 0;
        let pieces = Pieces::of(folder);
        for frame in frames {
            let spheres = Seen::read(frame)?.spheres;
            pieces.refuse_unknown(&spheres, &frame.0)?;
            last = spheres.fragments.iter().copied().fold(last, u32::max);
            colours.refuse_missing(&spheres, frame)?;
            let all = (0..spheres.centres_m.len()).map(|i| colours.value(&spheres, i).abs());
            let highest = match by {
                ColourBy::Stress => most_of(&all.collect::<Vec<f64>>()),
                _ => all.fold(0.0, f64::max),
            };
            colours.highest = colours.highest.max(highest);
        }
        colours.pieces = pieces.colours(last);
        Ok(colours)
    }

    /// Refuses a quantity that a frame does not have.
    fn refuse_missing(&self, spheres: &Spheres, (path, _): &(PathBuf, f64)) -> Result<()> {
        let is_missing = match self.by {
            ColourBy::StrainRate => spheres.dynamic[0].is_empty(),
            ColourBy::DynamicIncreaseFactor => spheres.dynamic[1].is_empty(),
            ColourBy::DynamicUtilisation => spheres.dynamic[2].is_empty(),
            _ => false,
        };
        if !is_missing {
            return Ok(());
        }
        let problem = format!(
            "{} has none: the scene has no bonds with rate_strengthening",
            path.display()
        );
        let remedy = "utilisation is that of the static strength";
        Err(Diagnostic::input("--colour-by", problem, remedy))
    }

    /// The value of a sphere on the scale, in SI units; 0 without a scale.
    fn value(&self, spheres: &Spheres, i: usize) -> f64 {
        let dynamic = |at: usize| spheres.dynamic[at].get(i).copied().unwrap_or(0.0);
        match self.by {
            ColourBy::Fragment | ColourBy::Body => 0.0,
            ColourBy::Speed => spheres.speeds_m_s[i],
            ColourBy::FragmentMass => spheres.masses_kg[i],
            ColourBy::StrainRate => dynamic(0),
            ColourBy::DynamicIncreaseFactor => dynamic(1),
            ColourBy::DynamicUtilisation => dynamic(2),
            ColourBy::Utilisation => spheres.utilisations[i],
            ColourBy::Stress => spheres.stresses_pa[i],
        }
    }

    fn of_sphere(&self, spheres: &Spheres, i: usize) -> [u8; 3] {
        match self.by {
            ColourBy::Fragment if spheres.can_break => {
                let known = self.pieces.get(spheres.fragments[i] as usize);
                known.copied().unwrap_or_default()
            }
            ColourBy::Fragment | ColourBy::Body => of_fragment(spheres.bodies[i], 1.0),
            _ => {
                let fraction = self.value(spheres, i) / self.highest.max(f64::MIN_POSITIVE);
                let place = if self.is_signed() {
                    0.5 * (1.0 + fraction)
                } else {
                    fraction
                };
                self.at(place)
            }
        }
    }

    /// Whether the scale begins at minus its largest value instead of 0.
    fn is_signed(&self) -> bool {
        self.by == ColourBy::Stress
    }

    /// The colour at a fraction of the scale, 0 to 1.
    pub(super) fn at(&self, fraction: f64) -> [u8; 3] {
        if self.is_signed() {
            blue_to_red(2.0 * fraction - 1.0)
        } else {
            viridis(fraction)
        }
    }

    /// Name of the scale and the values at its ends, if colours are on one.
    pub(super) fn scale(&self) -> Option<(&'static str, [String; 2])> {
        let (name, unit) = match self.by {
            ColourBy::Fragment | ColourBy::Body => return None,
            ColourBy::Speed => ("speed", "m/s"),
            ColourBy::FragmentMass => ("fragment mass", "kg"),
            ColourBy::StrainRate => ("strain rate", "1/s"),
            ColourBy::DynamicIncreaseFactor => ("dynamic increase factor", ""),
            ColourBy::DynamicUtilisation => ("dynamic utilisation", ""),
            ColourBy::Utilisation => ("utilisation of bonds", ""),
            ColourBy::Stress => ("normal stress of bonds", "Pa"),
        };
        let highest = show_quantity(self.highest, unit);
        let ends = if self.is_signed() {
            let number = highest.split(' ').next().unwrap_or_default();
            [format!("-{number}"), format!("+{highest}")]
        } else {
            ["0".to_owned(), highest]
        };
        Some((name, ends))
    }
}
