//! Rules for adding, removing and replacing bodies: regions, replacement, inlets and outlets of the
//! scene.

use std::ops::Range;

use serde::Serialize;

use super::population::InletProgress;
use super::walls::Wall;
use dem_physics::breakage::BreakageLaw;
use dem_physics::geometry::Frame;
use dem_physics::geometry::region::Region;

/// Condition under which a clump becomes a bonded cluster (BPRM: Platzer 2022, section 4.5.4).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trigger {
    /// Its centre of mass is in this region: number in [`Rules::regions`].
    pub enters: Option<usize>,
    /// It touches one of these walls or bodies. None: that does not matter.
    pub touches: Option<Touches>,
    /// The resultant contact force exceeds this, N.
    pub force_n: Option<f64>,
    /// A single contact force on it exceeds this, N.
    pub contact_force_n: Option<f64>,
    /// The mean stress of its contacts exceeds a limit.
    pub principal_stress: Option<PrincipalStress>,
    /// Contacts have taken more than this from its motion so far, J.
    pub impact_energy_j: Option<f64>,
    /// From this time on, s.
    pub time_s: Option<f64>,
    /// All of these must hold at once; otherwise one is enough.
    pub needs_all: bool,
}

/// What a clump has to touch.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Touches {
    /// Numbers of walls.
    pub walls: Vec<usize>,
    /// Numbers of bodies in [`super::model::Model::bodies`].
    pub bodies: Vec<u32>,
}

/// A limit of the mean stress of the contacts of a clump.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PrincipalStress {
    /// Largest principal value, by magnitude, Pa.
    pub limit_pa: f64,
    /// Volume of the body over its mass, also for its fragments, m3/kg.
    pub volume_m3_kg: f64,
}

impl Trigger {
    /// Whether it depends on single contacts.
    pub(crate) fn needs_squeeze(&self) -> bool {
        self.contact_force_n.is_some() || self.principal_stress.is_some()
    }

    /// Whether it depends on contacts.
    pub fn needs_contact(&self) -> bool {
        self.force_n.is_some()
            || self.touches.is_some()
            || self.impact_energy_j.is_some()
            || self.needs_squeeze()
    }
}

/// Conditions under which a cluster becomes a clump again.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Restore {
    /// Its centre of mass is outside this region: number in [`Rules::regions`]. None: it may be
    /// anywhere.
    pub leaves: Option<usize>,
    /// No bond of it has broken for this time, and it has been bonded for as long, s.
    pub unbroken_for_s: f64,
    /// It has at least this many particles.
    pub min_particles: u32,
    /// The elastic energy of its bonds per mass is below this, J/kg.
    pub strain_energy_j_kg: f64,
    /// The relative speed of its particles, root mean square, is below this, m/s.
    pub inner_speed_m_s: f64,
}

/// Daughters that replace a particle once it has taken in enough energy (PRM: Platzer 2022, section
/// 2.1.1).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DaughterRule {
    /// By ascending energy. None with a law.
    pub classes: Vec<SizeClass>,
    /// Breakage by a law, which makes daughters of its own.
    pub by_law: Option<ByLaw>,
    /// Least energy over mass that replaces a particle of the body, or its median, J/kg.
    pub needed_j_kg: f64,
    /// The energies of all impacts count together; otherwise each for itself.
    pub sums_impacts: bool,
    /// Modulus of the Weibull distribution of the energies of the classes. None: no scatter.
    pub weibull_modulus: Option<f64>,
    /// Smallest diameter of a daughter that is replaced in turn, m; infinite: none is. With a law,
    /// of any daughter.
    pub smallest_size_m: f64,
    /// Largest number of particles of the body that are replaced.
    pub limit: u32,
    /// Radius of the smallest sphere that it can make, m; infinite: all daughters have bonds.
    pub smallest_radius_m: f64,
}

/// Breakage by a law of the material.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ByLaw {
    /// The law.
    pub law: BreakageLaw,
    /// Exponent of the damage by impacts that do not break: see [`dem_physics::breakage::damage`].
    /// None: there is none.
    pub damage_exponent: Option<f64>,
    /// t10 at which a particle breaks while its contacts still press harder.
    pub at_once_from_t10: f64,
}

/// A size class of daughters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SizeClass {
    /// Least energy over the mass of the particle, J/kg.
    pub from_j_kg: f64,
    /// Their template.
    pub template: u32,
    /// The spheres of the template are a packing of loose daughters; otherwise it is one body with
    /// bonds.
    pub loose: bool,
}

/// Feed rate of an inlet.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub enum Feed {
    /// Bodies per second.
    Number(f64),
    /// kg/s.
    Mass(f64),
}

/// A source of bodies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Inlet {
    /// Its name in the scene.
    pub name: String,
    /// Templates and their proportions by number, which sum to 1.
    pub templates: Vec<(u32, f64)>,
    /// Region of the centres of mass: number in [`Rules::regions`].
    pub region: usize,
    /// Feed rate.
    pub feed: Feed,
    /// m/s. Length 3.
    pub velocity_m_s: [f64; 3],
    /// rad/s. Length 3.
    pub spin_rad_s: [f64; 3],
    /// Turned at random, or as the scene's body.
    pub random_orientation: bool,
    /// First and last time, s.
    pub between_s: [f64; 2],
    /// Largest number of bodies.
    pub count: u32,
}

impl Inlet {
    /// Number of bodies that are due by now but have not been added: more than one waits for a free
    /// position.
    pub fn owed(&self, progress: &InletProgress, time_s: f64) -> u32 {
        let [start_s, end_s] = self.between_s;
        let since_s = time_s.min(end_s) - start_s;
        if since_s < 0.0 {
            return 0;
        }
        let per_s = match self.feed {
            Feed::Number(per_s) => per_s,
            Feed::Mass(_) if progress.bodies == 0 => 0.0,
            Feed::Mass(kg_s) => kg_s / progress.mass_kg * f64::from(progress.bodies),
        };
        // The first is due at once; none is due at the end.
        let should = if time_s < end_s {
            (since_s * per_s).floor() + 1.0
        } else {
            (since_s * per_s).ceil()
        };
        (should.min(f64::from(self.count)) as u32).saturating_sub(progress.bodies)
    }
}

/// A sink of bodies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outlet {
    /// Its name in the scene.
    pub name: String,
    /// Number in [`Rules::regions`].
    pub region: usize,
    /// Removes bodies outside the region; otherwise those inside.
    pub removes_outside: bool,
}

/// The bonded part of a body, the rest of which is rigid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Zone {
    /// Name of the body.
    pub body: String,
    /// [Ids](super::particles::Particles::id) of the spheres of the body.
    pub ids: Range<u32>,
    /// Number in [`Rules::regions`].
    pub region: usize,
    /// The wall that the region moves with. None: it does not move.
    pub carrier: Option<Carrier>,
    /// Conditions under which spheres join rigid parts again. None: they never do.
    pub rejoin: Option<Rejoin>,
}

/// A wall that a region moves with.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Carrier {
    /// Number of the wall.
    pub wall: usize,
    /// Position of the wall at the start.
    pub start: Frame,
}

/// Conditions under which a sphere joins a rigid part again.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Rejoin {
    /// The elastic energy of its bonds per mass is below this, J/kg.
    pub strain_energy_j_kg: f64,
    /// Its velocity relative to the part is below this, m/s.
    pub speed_m_s: f64,
}

/// All rules of a scene.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Rules {
    /// Regions, in the order of their names.
    pub regions: Vec<Region>,
    /// For each template, the condition under which its clumps become clusters. None: never.
    pub triggers: Vec<Option<Trigger>>,
    /// For each template, the conditions under which clusters made from it become clumps again.
    /// None: never.
    pub restores: Vec<Option<Restore>>,
    /// For each template, the daughters that replace its particles. None: none.
    pub daughters: Vec<Option<DaughterRule>>,
    /// Compliance (1 - nu^2)/E of each material, 1/Pa: 0 is rigid, infinite is unknown.
    pub compliances: Vec<f64>,
    /// The same for each wall; a wall of unknown compliance is rigid.
    pub wall_compliances: Vec<f64>,
    /// For each template, how its bodies start, and their orientation.
    pub starts: Vec<Start>,
    /// Inlets, in the order of their names.
    pub inlets: Vec<Inlet>,
    /// Outlets, in the order of their names.
    pub outlets: Vec<Outlet>,
    /// Bodies that are bonded in a region only.
    pub zones: Vec<Zone>,
    /// Seed of the scene.
    pub seed: u64,
}

/// Initial form of the bodies of a template.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Start {
    /// As bonded clusters; otherwise as clumps.
    pub bonded: bool,
    /// As particles of their own: single spheres that nothing replaces. A clump of one sphere moves
    /// in the same way, but takes twice as long.
    pub sphere: bool,
    /// Orientation of the body in the scene: unit quaternion x, y, z, w, from the axes of its file
    /// to space.
    pub turned: [f64; 4],
}

impl Rules {
    /// Whether the bonded zone of a body contains a place, m, while the walls are where they are.
    pub(crate) fn zone_contains(&self, zone: &Zone, place_m: [f64; 3], walls: &[Wall]) -> bool {
        let at_start = zone.carrier.map_or(place_m, |carrier| {
            let of_wall = walls[carrier.wall].frame.to_wall(place_m);
            carrier.start.to_space(of_wall)
        });
        self.regions[zone.region].contains(at_start)
    }

    /// Whether bodies are fed or discharged.
    pub fn have_flows(&self) -> bool {
        !(self.inlets.is_empty() && self.outlets.is_empty())
    }

    /// Whether there are no rules by which bodies come, go or are replaced.
    pub fn are_none(&self) -> bool {
        !self.have_flows() && self.triggers.iter().all(Option::is_none) && !self.make_daughters()
    }

    /// Whether daughters can replace any particle.
    pub fn make_daughters(&self) -> bool {
        self.daughters.iter().any(Option::is_some)
    }

    /// Radius of the smallest sphere that can come as a daughter, m; infinite if none can.
    pub(crate) fn smallest_daughter_m(&self) -> f64 {
        let rules = self.daughters.iter().flatten();
        rules
            .map(|rule| rule.smallest_radius_m)
            .fold(f64::INFINITY, f64::min)
    }
}
