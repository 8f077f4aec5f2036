//! `start_as` and `clump` of `[bodies.NAME]`

use std::ops::Bound::Included;

use super::conflicts;
use super::listing::Listing;
use super::plain_table::plain_table;
use super::schema::{Key, Kind, Word, words_of};
use super::table::Table;
use dem_io::diagnostic::Result;

/// The initial form of a body: when the run starts, or when an inlet feeds it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum StartAs {
    /// "bonded": particles, and bonds between them.
    #[default]
    Bonded,
    /// "clump": rigid, until `[replacement]` replaces it.
    Clump(ClumpSettings),
}

/// Default of `scale`.
const SCALE: f64 = 1.0;

impl Default for ClumpSettings {
    fn default() -> Self {
        Self {
            scale: SCALE,
            mass: ClumpMass::Spheres,
        }
    }
}

/// The volume from which the mass, centre and inertia of a clump are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClumpMass {
    /// "spheres": sums over the particles, with overlaps counted twice, as for the bonded cluster.
    Spheres,
    /// "union": the union of the particles, with overlaps counted once.
    Union,
}

/// The initial forms of a body; true for a clump.
const STARTS: [(&str, bool); 2] = [("bonded", false), ("clump", true)];

pub(super) const START_AS: Key = Key::new(
    "start_as",
    Kind::Word(|| words_of(&STARTS)),
    "`bonded` particles, or a rigid `clump` until `[replacement]` replaces it.",
)
.or_word("bonded");

plain_table! {
    CLUMP = "Clump";
    /// A rigid clump made of a body. Its spheres are the body's particles.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct ClumpSettings {
        /// Contact radius of each sphere over the radius of its particle; the centres stay.
        scale: f64 = number("scale")
            .within(Included(1.0), Included(1.5))
            .remedy("it is a factor on the radii: 1 leaves them as they are")
            .or(SCALE);
        /// `spheres`: mass, centre and inertia are sums over the particles, as for the bonded
        /// cluster; `union`: those of the volume that the particles fill, with overlaps counted
        /// once.
        mass: ClumpMass = word::<ClumpMass>("mass", "spheres");
    }
}

impl Word for ClumpMass {
    const WORDS: &'static [(&'static str, Self)] =
        &[("spheres", Self::Spheres), ("union", Self::Union)];
}

pub(super) fn read(body: &Table<'_>) -> Result<StartAs> {
    let is_clump = body
        .read_by("start_as", |field| field.choice(&STARTS))?
        .unwrap_or(false);
    if is_clump {
        return ClumpSettings::read(&body.table("clump", &CLUMP)?).map(StartAs::Clump);
    }
    conflicts::BODY.refuse_key("clump", body)?;
    Ok(StartAs::Bonded)
}

pub(super) fn list_start(start_as: StartAs, listing: &mut Listing) {
    match start_as {
        StartAs::Bonded => listing.text("start_as", "bonded"),
        StartAs::Clump(clump) => {
            listing.text("start_as", "clump");
            listing.table("clump", &CLUMP, |listing| clump.list(listing));
        }
    }
}
