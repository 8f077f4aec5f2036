//! A scene: what stands where, of what, what is done to it and what is asked. Plain data in SI
//! units, as read from TOML.
//!
//! Every table of the file has one struct, here or beside its reader; names are unique within their
//! table. The reader of the file refuses what cannot be simulated.

mod body;
mod bond;
mod clump;
mod clusters;
mod contact;
mod describe;
mod direction;
mod field;
mod initial;
mod inlet;
mod inputs;
mod load;
mod material;
mod measure;
mod names;
mod outlet;
mod output;
mod overrides;
mod presence;
mod read;
mod region;
mod relaxation;
mod replacement;
mod run;
mod search;
mod set;
mod shape;
mod sleep;
mod statics;
pub mod study;
mod support;
mod table;
mod targets;
mod test;
mod tree;
mod wall;

use std::collections::BTreeMap;
use std::path::PathBuf;

pub use clump::{ClumpMass, ClumpSettings, StartAs};
pub use clusters::Clusters;
pub use contact::{Contact, ContactLaw, Rolling};
pub use initial::Initial;
pub use inlet::{FeedRate, Inlet};
pub use outlet::Outlet;
pub use read::{read_scene, scene_from_text, text_of};
pub use region::Region;
pub use relaxation::Relaxation;
pub use replacement::{Back, Replacement};
pub use run::SAFETY;
pub use search::Search;
pub use sleep::Sleep;
pub use test::{Test, TestKind};
pub use wall::{Wall, WallMotion, WallShape};

/// Version of the scene format.
pub const SCENE_VERSION: u64 = 1;

/// A whole scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// File that it was read from, as the user named it.
    pub source: String,
    /// `[run]`
    pub run: Run,
    /// `[materials.NAME]`
    pub materials: BTreeMap<String, Material>,
    /// `[contacts]`, by pairs of materials: sorted, each pair once. Pairs that bodies and walls
    /// need may be missing.
    pub contacts: Vec<Contact>,
    /// `[bonds.NAME]`
    pub bonds: BTreeMap<String, BondKind>,
    /// `[bodies.NAME]`. At least one.
    pub bodies: BTreeMap<String, BodyEntry>,
    /// `[walls.NAME]`. No body or set has the name of a wall.
    pub walls: BTreeMap<String, Wall>,
    /// `[sets.NAME]`. The name of a body also stands for all its particles, and `all` for all of
    /// the scene.
    pub sets: BTreeMap<String, ParticleSet>,
    /// `[initial.NAME]`
    pub initial: BTreeMap<String, Initial>,
    /// `[supports.NAME]`
    pub supports: BTreeMap<String, Support>,
    /// `[loads.NAME]`
    pub loads: BTreeMap<String, Load>,
    /// `[regions.NAME]`, of any names.
    pub regions: BTreeMap<String, Region>,
    /// `[replacement.NAME]`, by the name of the body: a clump that has bonds.
    pub replacement: BTreeMap<String, Replacement>,
    /// `[inlets.NAME]`. The bodies that they name do not stand in the scene at the start.
    pub inlets: BTreeMap<String, Inlet>,
    /// `[outlets.NAME]`
    pub outlets: BTreeMap<String, Outlet>,
    /// `[measures.NAME]`
    pub measures: BTreeMap<String, Measure>,
    /// `[clusters]`
    pub clusters: Clusters,
    /// `[relaxation]`
    pub relaxation: Relaxation,
    /// `[search]`
    pub search: Search,
    /// `[sleep]`. None: nothing sleeps.
    pub sleep: Option<Sleep>,
    /// `[output]`. None: nothing is written to disk unless the command line names a folder.
    pub output: Option<Output>,
    /// `[test]`. None: no laboratory test.
    pub test: Option<Test>,
}

/// When the run ends, how it steps, what acts everywhere.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// `end_time`: simulated time at the end, s. Infinite where a `[test]` says when it ends.
    pub end_time_s: f64,
    /// `integrator`, "leapfrog" unless given.
    pub integrator: Integrator,
    /// `rest`, in (0, 1): end sooner, when the kinetic energy has been below this share of the
    /// elastic energy during the last fifth of the run.
    pub rest: Option<f64>,
    /// `time_step`: seconds, or None for "auto", which is `safety` times the exact limit.
    pub time_step_s: Option<f64>,
    /// `safety`: the automatic step over the limit, 0.9 unless given; in (0, 2), of which 1 and
    /// more are for trials only.
    pub safety: f64,
    /// `adaptive`: the automatic step follows the limit up as well as down; not unless given.
    pub adaptive: bool,
    /// `gravity`, m/s2; none unless given. Length 3.
    pub gravity_m_s2: [f64; 3],
    /// `particle_damping`: gamma of Chen et al. 2022, eqs. 11 and 12; 0 unless given; in [0, 1).
    pub particle_damping: f64,
    /// `seed` of everything random (scatter of strengths); 0 unless given.
    pub seed: u64,
    /// `start_overlap`, "refuse" unless given.
    pub start_overlap: StartOverlap,
}

/// How a run comes to its end.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Integrator {
    /// "leapfrog": step by step.
    #[default]
    Leapfrog,
    /// "static": at once, into the equilibrium under what loads and supports are at the end. Bonded
    /// bodies on supports only: nothing touches, breaks, comes or goes.
    Static,
}

/// What happens where bodies or walls overlap at the start, although no bond joins them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StartOverlap {
    /// "refuse": the scene is refused.
    Refuse,
    /// "relax": the overlap is the origin of their contact law.
    Relax,
    /// "keep": contacts like all others, which press with the force of their overlap.
    Keep,
}

/// What particles and walls are made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// `density`, kg/m3. None: the density that the body's file names; a body whose particles stand
    /// in the scene has none.
    pub density_kg_m3: Option<f64>,
    /// `young_modulus`, Pa; or from `shear_modulus` and `poisson_ratio`. None: not given; only
    /// contacts and Rayleigh's estimate need it.
    pub young_modulus_pa: Option<f64>,
    /// `poisson_ratio`, in (-1, 0.5]. 0.3 unless given.
    pub poisson_ratio: f64,
    /// `rigid`: does not deform; of walls only, and without the values above. Not unless given.
    pub rigid: bool,
}

/// Which beam a bond is taken for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BondModel {
    /// "parallel": `kappa` is normal over shear stiffness, 2 (1 + nu) unless given.
    Parallel {
        /// Normal over shear stiffness.
        kappa: Option<f64>,
    },
    /// "euler-bernoulli"
    EulerBernoulli,
    /// "timoshenko"
    Timoshenko,
    /// "elastic-solid"
    ElasticSolid,
    /// "shear-coefficient": `shear_coefficient`, 0.9 unless given.
    ShearCoefficient {
        /// Shear coefficient of the section.
        alpha: f64,
    },
}

/// How forces follow from motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Formulation {
    /// "total": the gradient of an energy of positions and orientations.
    Total,
    /// "incremental": summed step by step.
    Incremental,
}

/// What bonds are made of.
#[derive(Debug, Clone, PartialEq)]
pub struct BondKind {
    /// `model`, "timoshenko" unless given.
    pub model: BondModel,
    /// `formulation`, "total" unless given.
    pub formulation: Formulation,
    /// `young_modulus`, Pa.
    pub young_modulus_pa: f64,
    /// `poisson_ratio`, in (-1, 0.5].
    pub poisson_ratio: f64,
    /// `radius_factor`: bond radius over the smaller of the two particle radii. None: the radii of
    /// the body's file.
    pub radius_factor: Option<f64>,
    /// `damping = { ... }`
    pub damping: BondDamping,
    /// `failure = { ... }`
    pub failure: BondFailure,
}

/// Viscous damping at the bond. Both may act together.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BondDamping {
    /// `viscous`: eta of Chen et al. 2022, eqs. 9 and 10. 0: none.
    pub viscous: f64,
    /// `each_mode`: eta acts with each mode's own stiffness instead of the normal and the torsional
    /// one.
    pub each_mode: bool,
    /// `force`: d of Platzer 2022, eq. 7, N s/m. 0: none.
    pub force_n_s_m: f64,
    /// `torque`: factor of the damping torque of Platzer 2022, eq. 9 (1 there). 0: none.
    pub torque: f64,
}

/// What the rate is of that strengthens bonds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum RateOf {
    /// "elongation": relative velocity along the bond over its initial length.
    #[default]
    Elongation,
    /// "relative-velocity": the whole relative velocity over the initial length, as printed in
    /// Platzer 2022, eq. 21. A bond that only turns has a rate, too.
    RelativeVelocity,
}

/// What breaks a bond; whichever comes first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondFailure {
    /// `tension`: largest stress at the tensile edge, F_n/A + M_ben r/I, Pa (MUSEN's sigma_max with
    /// the sign of the force).
    pub tension_pa: Option<f64>,
    /// `compression`: largest stress at the pressed edge, -F_n/A + M_ben r/I, Pa. None: nothing
    /// breaks there.
    pub compression_pa: Option<f64>,
    /// `shear`: largest shear stress, Pa (MUSEN's tau_max).
    pub shear_pa: Option<f64>,
    /// `von_mises`: largest equivalent stress, Pa (Platzer 2022, eqs. 11-13).
    pub von_mises_pa: Option<f64>,
    /// `rate_strengthening`: strain rate from which strengths but that in compression rise with the
    /// rate (Platzer 2022, eqs. 20, 21), 1/s; `true` stands for 4.64e-6. None: never.
    pub rate_strengthening_from_1_s: Option<f64>,
    /// `rate_of`: what that rate is of. The elongation unless given.
    pub rate_of: RateOf,
    /// `weibull_modulus`: strengths scatter by a Weibull distribution of this modulus whose scale
    /// is the strength given. None: all alike.
    pub weibull_modulus: Option<f64>,
}

/// Where a body comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum BodySource {
    /// `file`, resolved against the folder of the scene; "-" is standard input.
    File(PathBuf),
    /// `particles` and `bond_list` in the scene. A bond is as thick as the smaller of its
    /// particles, times `radius_factor`, and as long as they are apart.
    Inline {
        /// `particles = [[x, y, z, radius], ...]`, m.
        particles: Vec<[f64; 4]>,
        /// `bond_list = [[a, b], ...]`: indices of particles, from 0; the smaller comes first here,
        /// in any order in the file.
        bonds: Vec<[u32; 2]>,
    },
}

/// A body and how it stands and moves at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyEntry {
    /// Where its particles and bonds come from.
    pub source: BodySource,
    /// `material`: a name of `[materials]`.
    pub material: String,
    /// `bonds`: a name of `[bonds]`. None only for bodies without bonds.
    pub bond_kind: Option<String>,
    /// `position`: moved by this, m. Length 3. After `rotation`.
    pub position_m: [f64; 3],
    /// `rotation = { axis, angle }`: turned about the origin of the body's file, as a rotation
    /// vector, rad. Length 3.
    pub rotation_rad: [f64; 3],
    /// `velocity` of the centre of mass, m/s. Length 3.
    pub velocity_m_s: [f64; 3],
    /// `angular_velocity` about the centre of mass, as a rigid body, rad/s. Length 3.
    pub angular_velocity_rad_s: [f64; 3],
    /// `start_as`, "bonded" unless given, and `clump`.
    pub start_as: StartAs,
    /// `body_density` or `mass`. None: its spheres have the density of the material.
    pub whole_mass: Option<WholeMass>,
}

/// What a body weighs as a whole: the density of its spheres follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WholeMass {
    /// `body_density`: mass over the volume of its shape, kg/m3. The body comes from a file.
    Density(f64),
    /// `mass`, kg.
    Mass(f64),
}

/// Which particles are meant.
#[derive(Debug, Clone, PartialEq)]
pub struct ParticleSet {
    /// `body`: only of this one. None: of all. Never None where `pick` lists particles.
    pub body: Option<String>,
    /// How they are picked, at the start of the run.
    pub pick: Pick,
}

/// How particles are picked.
#[derive(Debug, Clone, PartialEq)]
pub enum Pick {
    /// `all = true`
    All,
    /// `particles = [i, ...]`: indices in the body's file, from 0. Only with `body`, or where there
    /// is one body.
    Particles(Vec<u32>),
    /// `box = { min, max }`: centres in it, m.
    Box {
        /// Smallest corner, m.
        min: [f64; 3],
        /// Largest corner, m.
        max: [f64; 3],
    },
    /// `sphere = { centre, radius }`: centres in it, m.
    Sphere {
        /// Centre, m.
        centre: [f64; 3],
        /// Radius, m.
        radius: f64,
    },
}

/// Factor on a load or a motion, over time.
#[derive(Debug, Clone, PartialEq)]
pub enum Factor {
    /// 1 from the start.
    One,
    /// `ramp`: rises evenly from 0 to 1 until this time, s, and stays.
    Ramp {
        /// End of the rise, s.
        until_s: f64,
    },
    /// `table = [[time, factor], ...]`: straight between the points, constant outside them. Times
    /// rise.
    Table(Vec<[f64; 2]>),
}

/// What holds one degree of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hold {
    /// Does not move.
    Fixed,
    /// Moves at this velocity times the factor, m/s or rad/s.
    Velocity(f64),
    /// Is displaced by this times the factor, m or rad.
    Displacement(f64),
}

/// A support: holds degrees of freedom of a set of particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Support {
    /// `of`: a set, a body or `all`.
    pub of: String,
    /// Along x, y, z, then about x, y, z (`fixed`, `velocity`, `displacement`); None: free. Not all
    /// are free. Length 6.
    pub holds: [Option<Hold>; 6],
    /// `ramp` or `table`, for velocities and displacements.
    pub factor: Factor,
    /// `end`: from this time on the freedoms are free, s. Not before the factor's last change.
    /// None: never.
    pub end_s: Option<f64>,
}

/// A load on a set of particles, shared equally among them.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// `of`: a set, a body or `all`.
    pub of: String,
    /// `force` on the whole set, N. Length 3. Not zero together with the torque.
    pub force_n: [f64; 3],
    /// `torque` on the whole set, N m. Length 3.
    pub torque_n_m: [f64; 3],
    /// `ramp` or `table`.
    pub factor: Factor,
    /// `end`: from this time on it is zero, s. Not before the factor's last change. None: never.
    pub end_s: Option<f64>,
}

/// What is measured. Of a set, positions and velocities are those of its centre of mass, energies,
/// forces and counts are
/// sums. Walls have positions, forces and torques, fragments a count and masses, sets all but
/// torques, count and masses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// "position_x", ... m; of a wall, that of its pivot. Axis 0, 1, 2.
    Position(u8),
    /// "displacement_x", ... of the centre of mass since the start, m.
    Displacement(u8),
    /// "displacement": its magnitude, m.
    DisplacementMagnitude,
    /// "velocity_x", ... of the centre of mass, m/s.
    Velocity(u8),
    /// "velocity": its magnitude, m/s.
    VelocityMagnitude,
    /// "rotation_x", ... since the start (rotation vector, mean by mass), rad.
    Rotation(u8),
    /// "angular_velocity_x", ... of the rigid body with the same inertia and angular momentum,
    /// rad/s.
    AngularVelocity(u8),
    /// "reaction_x", ... force of supports on the set, N.
    Reaction(u8),
    /// "reaction_torque_x", ... torque of supports on the set, each about its particle's centre, N
    /// m.
    ReactionTorque(u8),
    /// "kinetic_energy", J.
    KineticEnergy,
    /// "elastic_energy" of the bonds, each half to its ends, J.
    ElasticEnergy,
    /// "broken_bonds" since the start.
    BrokenBonds,
    /// "largest_utilisation": stress over strength of the bond nearest to failure.
    LargestUtilisation,
    /// "angle_of_repose": slope of the heap that the particles form, degrees.
    AngleOfRepose,
    /// "force_x", ... force of contacts with all else: of particles on a wall, of others and walls
    /// on a set, N.
    Force(u8),
    /// "force": its magnitude, N.
    ForceMagnitude,
    /// "contact_force_x", ... force of contacts with what `with` names on the set, N.
    ContactForce(u8),
    /// "contact_force": its magnitude, N.
    ContactForceMagnitude,
    /// "contact_overlap": deepest overlap of these contacts; 0 where there is none, m.
    ContactOverlap,
    /// "contact_duration": how long the two have touched since the start, s.
    ContactDuration,
    /// "torque_x", ... torque of particles on the wall about its pivot, N m.
    Torque(u8),
    /// "count" of fragments.
    Count,
    /// "mass_fraction_of_largest": mass of the heaviest fragment over that of all.
    MassFractionOfLargest,
    /// "mass_of_largest": mass of the heaviest fragment, kg.
    MassOfLargest,
}

/// Which value of a measure's history is its result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum At {
    /// "end"
    End,
    /// "largest"
    Largest,
    /// "smallest"
    Smallest,
    /// "mean" over time
    Mean,
}

/// A named quantity, with what it should be where that is known.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// `of`: a set, a body, a wall, `fragments` or `all` (unless given). It has the quantity.
    pub of: String,
    /// `quantity`
    pub quantity: Quantity,
    /// `with`: the body, set or wall that `of` touches. Only of contacts, which need it.
    pub with: Option<String>,
    /// `at`, "end" unless given.
    pub at: At,
    /// `reference`: what the result should be, in the quantity's unit. Not zero where there is a
    /// `tolerance`.
    pub reference: Option<f64>,
    /// `tolerance`: largest relative error for the run to be called good. Only with `reference`.
    pub tolerance: Option<f64>,
    /// `tolerance_absolute`: largest difference from `reference`, which it needs, in the quantity's
    /// unit.
    pub tolerance_absolute: Option<f64>,
}

/// What is written, and how often. Times are simulated seconds.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Output {
    /// `folder`: results go here, resolved against the folder of the scene. None: the scene's name
    /// with `-out`.
    pub folder: Option<PathBuf>,
    /// `frames`: time between frames. None: first and last only.
    pub frames_s: Option<f64>,
    /// `series`: time between rows of the time series. None: a thousandth of the run; 200 steps at
    /// least in large scenes.
    pub series_s: Option<f64>,
    /// `pictures`: time between pictures. None: no pictures.
    pub pictures_s: Option<f64>,
    /// `view = { from }`: where pictures are taken from, as seen from the bodies; of length 1.
    /// None: from the front, the right and above. Length 3.
    pub view_from: Option<[f64; 3]>,
    /// `checkpoint`: time between checkpoints. None: only at the end and when interrupted.
    pub checkpoint_s: Option<f64>,
}
