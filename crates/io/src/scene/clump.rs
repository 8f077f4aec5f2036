//! `start_as` and `clump` of `[bodies.NAME]`

use super::table::Table;
use crate::Result;
use crate::units::NUMBER;

/// What a body is at first: when the run starts, or when an inlet feeds it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum StartAs {
    /// "bonded": particles, and bonds between them.
    #[default]
    Bonded,
    /// "clump": rigid, until `[replacement]` replaces it.
    Clump(ClumpSettings),
}

/// `clump = { scale, mass }`: how a rigid clump is made of a body. Its spheres are the body's
/// particles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClumpSettings {
    /// `scale`: radii with which its spheres touch others, over those of the particles, about their
    /// own centres. 1 unless given; in [1, 1.5].
    pub scale: f64,
    /// `mass`, "spheres" unless given.
    pub mass: ClumpMass,
}

impl Default for ClumpSettings {
    fn default() -> Self {
        Self {
            scale: 1.0,
            mass: ClumpMass::Spheres,
        }
    }
}

/// Of what mass, centre and inertia of a clump are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClumpMass {
    /// "spheres": sums over the particles, overlaps twice, as of the bonded cluster.
    Spheres,
    /// "union": what the particles fill together, overlaps once.
    Union,
}

/// What a body may start as: whether as a clump.
const STARTS: [(&str, bool); 2] = [("bonded", false), ("clump", true)];

/// Of what the mass may be.
pub(super) const MASSES: [(&str, ClumpMass); 2] =
    [("spheres", ClumpMass::Spheres), ("union", ClumpMass::Union)];

/// Largest `scale`.
const LARGEST_SCALE: f64 = 1.5;

pub(super) fn read(body: &Table<'_>) -> Result<StartAs> {
    let is_clump = body
        .read("start_as", |field| field.choice(&STARTS))?
        .unwrap_or(false);
    let Some(field) = body.get("clump") else {
        return Ok(if is_clump {
            StartAs::Clump(ClumpSettings::default())
        } else {
            StartAs::Bonded
        });
    };
    if !is_clump {
        let problem = format!(
            "{} stands without start_as = \"clump\", on which it acts",
            field.path
        );
        return Err(field.refuse(problem, "add start_as = \"clump\", or remove it"));
    }
    let table = field.table(&["scale", "mass"])?;
    let usual = ClumpSettings::default();
    Ok(StartAs::Clump(ClumpSettings {
        scale: table
            .read("scale", |field| {
                field.limited(
                    &NUMBER,
                    |scale| (1.0..=LARGEST_SCALE).contains(&scale),
                    &format!("at least 1 and at most {LARGEST_SCALE}"),
                    "it is a factor on the radii: 1 leaves them as they are",
                )
            })?
            .unwrap_or(usual.scale),
        mass: table
            .read("mass", |field| field.choice(&MASSES))?
            .unwrap_or(usual.mass),
    }))
}
