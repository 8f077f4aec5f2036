//! Names used in a .vtp file of a body.

/// Version of this layout. Files of a later version are refused.
pub const FORMAT_VERSION: u64 = 1;

pub(super) const VERSION: &str = "body_format_version";
pub(super) const LENGTH_UNIT: &str = "length_unit";
pub(super) const METRE: &str = "m";

/// Names of the field data, in the order of [`About`].
pub(super) const PROGRAM: &str = "program";
pub(super) const SOURCE: &str = "source";
pub(super) const SOURCE_HASH: &str = "source_hash";
pub(super) const SHAPE_VOLUME: &str = "shape_volume_m3";
pub(super) const PARTICLE_DENSITY: &str = "particle_density_kg_m3";
pub(super) const OVERLAP: &str = "overlap";
pub(super) const BOND_RANGE: &str = "bond_range";
pub(super) const SEED: &str = "seed";
pub(super) const THINNEST_PART: &str = "thinnest_part_m";
pub(super) const PARTICLES_ACROSS: &str = "particles_across";
pub(super) const WARNINGS: &str = "warnings";
