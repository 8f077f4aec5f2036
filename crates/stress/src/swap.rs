//! Clumps that are replaced while two plates squeeze them.

use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::sync::atomic::AtomicBool;

use dem_io::{Diagnostic, Result};
use rayon::prelude::*;

use super::prediction::{Member, Quantity, Shown};
use super::trial::{Outcome, Trial};
use dem_results::Summary;

/// Radius of the spheres of the block, m.
const RADIUS_M: f64 = 1e-3;
/// Spheres along an edge of the block.
const EDGE: usize = 3;
/// What a swap may add to the error of the energy: that of the run itself is smaller.
const ENERGY_ERROR: f64 = 1e-3;
/// The same for the momentum.
const MOMENTUM_ERROR: f64 = 1e-10;

/// Young's modulus, Pa, and Poisson's ratio of spheres and bonds.
const YOUNG_PA: f64 = 1e9;
const POISSON: f64 = 0.25;
/// Stress of the first trigger, Pa.
const STRESS_PA: f64 = 1e6;
/// The stress of the block, or the force of one of its contacts.
const TRIGGERS: [&str; 2] = ["principal_stress = \"1 MPa\"", "contact_force = \"2 N\""];
/// More swaps than any of the runs makes.
const MOST_SWAPS: f64 = 100.0;
/// Tensile strength of the bonds of an upright block, whose columns are only pressed, and of a
/// tilted one, whose bonds bend and shear beyond it, Pa; the shear strength is twice as large.
const STRENGTHS_PA: [f64; 2] = [2e6, 0.4e6];
/// Fracture energy of bonds that soften, J/m2.
const FRACTURE_J_M2: f64 = 200.0;
/// Largest difference of what bonds lose to softening from that of the twin: until its swap the
/// block does not bend, and it does not swing with the plates as the twin has begun to.
const DAMAGE_ERROR: f64 = 0.15;
/// The same for how far the largest stress goes beyond the strength.
const UTILISATION_ERROR: f64 = 1e-4;
/// What breaking bonds may add to the error of the energy: the verdict of a run permits as much.
const BREAKAGE_ERROR: f64 = 1e-2;

/// A block between plates that close by a thirtieth of its height becomes a bonded cluster when
/// their squeeze reaches 1 MPa. The swap changes neither momentum nor energy, whatever else the
/// scene asks for: clump spheres that are larger than those of the cluster, whose overlap vanishes
/// with the clump and is recorded; a cluster that becomes a clump again at every check, and is
/// replaced at once; a block from an inlet. A tilted block is loaded beyond the strength of its
/// bonds: they soften, break, or hold because the strain rate strengthens them, as those of a twin
/// do that is bonded from the start, in the same place between the same plates.
pub(crate) fn swaps(interrupted: &AtomicBool) -> Result<Vec<Member>> {
    let mut blocks: Vec<(String, Block, Expected)> = Vec::new();
    for scale in [1.0, 1.02] {
        let upright = Block {
            scale,
            is_tilted: false,
            failure: String::new(),
            restores: false,
            is_fed: false,
            when: TRIGGERS[0],
            restitution: 0.5,
        };
        let tilted = |failure: &str| Block {
            is_tilted: true,
            failure: failure.to_owned(),
            ..upright.clone()
        };
        let softens = tilted(&format!(", fracture_energy = {FRACTURE_J_M2}"));
        let restored = |block: &Block| Block {
            restores: true,
            ..block.clone()
        };
        let fed = |block: &Block| Block {
            is_fed: true,
            ..block.clone()
        };
        let by_force = |block: &Block| Block {
            when: TRIGGERS[1],
            ..block.clone()
        };
        let mut add = |what: &str, block: Block, expected: Expected| {
            blocks.push((format!("{what}, clump spheres x {scale}"), block, expected));
        };
        let undamped = Block {
            restitution: 1.0,
            ..upright.clone()
        };
        add("replaced", upright.clone(), Expected::Whole);
        add("replaced without damping", undamped, Expected::Freed);
        add(
            "replaced by the force of a contact",
            by_force(&upright),
            Expected::Whole,
        );
        add(
            "restored and replaced again",
            restored(&upright),
            Expected::Whole,
        );
        add("fed", fed(&upright), Expected::Whole);
        add("softening", softens.clone(), Expected::Damaged);
        add(
            "softening and restored",
            restored(&softens),
            Expected::Damaged,
        );
        add("softening and fed", fed(&softens), Expected::Damaged);
        add("breaking", tilted(""), Expected::Broken);
        let strengthens =
            ", rate_strengthening = true, strain_rate_measure = \"relative-velocity\"";
        add(
            "held by its strain rate",
            tilted(strengthens),
            Expected::Held,
        );
    }
    let member = |(what, block, expected): (String, Block, Expected)| {
        let more = match expected {
            Expected::Whole => whole(),
            Expected::Freed => freed(block.scale),
            Expected::Damaged => damaged(&block.twin(interrupted)?),
            Expected::Broken => broken(&block.twin(interrupted)?),
            Expected::Held => held(&block.twin(interrupted)?),
        };
        Ok(block.member(what, more))
    };
    blocks.into_par_iter().map(member).collect()
}

/// What a block is expected to do.
#[derive(Debug, Clone, Copy)]
enum Expected {
    /// Nothing breaks.
    Whole,
    /// The same, and what its contacts have stored is gone.
    Freed,
    /// As its twin, its bonds soften and hold.
    Damaged,
    /// As in its twin, bonds break.
    Broken,
    /// As in its twin, bonds hold beyond their strength.
    Held,
}

/// Nothing breaks.
fn whole() -> Vec<Shown> {
    vec![
        Shown::at_most(Quantity::EnergyError, ENERGY_ERROR),
        Shown::count(Quantity::BrokenBonds, 0),
        Shown::count(Quantity::Fragments, 1),
    ]
}

/// The same, and what the contacts of larger clump spheres have stored at the swap, which is gone
/// with their overlap: Hertz's energy of 18 contacts at the stress of the trigger. Spheres of the
/// same size go on pressing, and nothing is gone. The trigger is seen up to a step late. Without
/// damping, since the stress counts the force of dashpots, too.
fn freed(scale: f64) -> Vec<Shown> {
    let radius_m = scale * RADIUS_M;
    let volume_m3 = (EDGE * EDGE * EDGE) as f64 * 4.0 / 3.0 * PI * RADIUS_M.powi(3);
    let hertz = 4.0 / 3.0 * YOUNG_PA / (2.0 * (1.0 - POISSON * POISSON)) * radius_m.sqrt();
    let contacts = (2 * EDGE * EDGE) as f64;
    let arm_m = (EDGE - 1) as f64 * RADIUS_M + radius_m;
    let force_n = STRESS_PA * volume_m3 / (contacts * arm_m);
    let overlap_m = (force_n / hertz).powf(2.0 / 3.0);
    let stored_j = contacts * 0.4 * force_n * overlap_m;
    let gone_j = if scale > 1.0 { stored_j } else { 0.0 };
    let mut shown = whole();
    let off_j = 0.03 * stored_j;
    let ends_j = [-gone_j - off_j, -gone_j + off_j];
    shown.push(Shown::between(
        Quantity::FlowEnergy,
        "J",
        ends_j[0],
        ends_j[1],
    ));
    shown
}

/// Bonds lose as much to softening as those of the twin, and hold.
fn damaged(twin: &Summary) -> Vec<Shown> {
    let [least, largest] = [-DAMAGE_ERROR, DAMAGE_ERROR].map(|off| 1.0 + off);
    let lost_j = Quantity::BondDamage.of(twin);
    let mut shown = whole();
    shown.push(Shown::between(
        Quantity::BondDamage,
        "J",
        least * lost_j,
        largest * lost_j,
    ));
    shown
}

/// As many bonds break as in the twin, into as many fragments.
fn broken(twin: &Summary) -> Vec<Shown> {
    let as_twin = |quantity: Quantity| Shown {
        value: quantity.of(twin),
        ..Shown::at_most(quantity, 0.0)
    };
    vec![
        Shown::at_most(Quantity::EnergyError, BREAKAGE_ERROR),
        as_twin(Quantity::BrokenBonds),
        as_twin(Quantity::Fragments),
    ]
}

/// Bonds hold although stresses exceed their strength, as far as those of the twin do: it is larger
/// by the dynamic increase factor.
fn held(twin: &Summary) -> Vec<Shown> {
    let mut shown = whole();
    for name in ["largest_utilisation", "largest_dynamic_utilisation"] {
        let value = Quantity::Measure(name).of(twin);
        shown.push(Shown::measure(name, "", value, UTILISATION_ERROR * value));
    }
    shown
}

#[derive(Clone)]
struct Block {
    /// Radius of the clump's spheres over that of the cluster's.
    scale: f64,
    /// Stands on an edge instead of a face.
    is_tilted: bool,
    /// Further keys of its failure.
    failure: String,
    restores: bool,
    is_fed: bool,
    /// Its trigger.
    when: &'static str,
    restitution: f64,
}

impl Block {
    /// It is replaced once, or at least twice if it is restored.
    fn member(&self, what: String, more: Vec<Shown>) -> Member {
        let mut shown = vec![Shown::at_most(Quantity::MomentumError, MOMENTUM_ERROR)];
        if self.restores {
            shown.push(Shown::between(Quantity::Replaced, "", 2.0, MOST_SWAPS));
            shown.push(Shown::between(Quantity::Restored, "", 1.0, MOST_SWAPS));
        } else {
            shown.push(Shown::count(Quantity::Replaced, 1));
            shown.push(Shown::count(Quantity::Restored, 0));
        }
        shown.extend(more);
        Member::ends(what, Trial::of(self.scene(false)), shown)
    }

    /// Centre of a sphere at this place in the block, m: the lowest are at z = 0.
    fn centre_m(&self, place: [usize; 3]) -> [f64; 3] {
        let [x, y, z] = place.map(|k| 2.0 * RADIUS_M * k as f64);
        match self.is_tilted {
            true => [FRAC_1_SQRT_2 * (x - z), y, FRAC_1_SQRT_2 * (x + z)],
            false => [x, y, z],
        }
    }

    /// What the run of the twin gives: the block in the same place, bonded from the start.
    fn twin(&self, interrupted: &AtomicBool) -> Result<Summary> {
        let refused = |said: String| Err(Diagnostic::failed("dem-run stress", said, ""));
        match Trial::of(self.scene(true)).run(interrupted)? {
            Outcome::Ended(summary) => Ok(*summary),
            Outcome::Refused(said) | Outcome::Stopped(said) => refused(said),
        }
    }

    /// The scene of the block, or of its twin, which is bonded from the start.
    fn scene(&self, is_bonded: bool) -> String {
        let Self {
            scale,
            failure,
            restitution,
            ..
        } = self;
        let mut particles = Vec::new();
        let mut bonds = Vec::new();
        for n in 0..EDGE * EDGE * EDGE {
            let place = [n % EDGE, n / EDGE % EDGE, n / (EDGE * EDGE)];
            let [x, y, z] = self.centre_m(place);
            particles.push(format!("[{x}, {y}, {z}, {RADIUS_M}]"));
            for (k, step) in [1, EDGE, EDGE * EDGE].into_iter().enumerate() {
                if place[k] + 1 < EDGE {
                    bonds.push(format!("[{n}, {}]", n + step));
                }
            }
        }
        // An inlet needs room.
        let gap_m = if self.is_fed { 2e-6 } else { 0.0 };
        let lowest_m = RADIUS_M * scale + gap_m;
        let position = match self.is_fed && !is_bonded {
            true => String::new(),
            false => format!("position = [0, 0, {lowest_m}]"),
        };
        let [_, _, height_m] = self.centre_m([EDGE - 1; 3]);
        let top_m = height_m + 2.0 * (RADIUS_M * scale + gap_m);
        let tensile_pa = STRENGTHS_PA[usize::from(self.is_tilted)];
        let shear_pa = 2.0 * tensile_pa;
        // What a restored cluster loses is known as well as leapfrog knows the energy of its
        // fastest motions: to (w dt)^2/4 of it. So is what contacts and broken bonds take.
        let fraction = if self.restores { 0.2 } else { 0.45 };
        let mut scene = format!(
            "version = 1
run = {{ end_time = \"4 ms\", safety_factor = {fraction} }}
materials.rock = {{ density = 2500, young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON} }}
contacts.rock-rock = {{ restitution = {restitution}, friction = 0.3 }}
bonds.rock = {{ young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON}, damping = {{ damping_ratio = 0.1 }}, failure = {{ tensile_strength = {tensile_pa}, shear_strength = {shear_pa}{failure} }} }}
walls.below = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"rock\" }}
walls.above = {{ plane = {{ point = [0, 0, {top_m}], normal = [0, 0, -1] }}, material = \"rock\", velocity = [0, 0, -0.05] }}
[bodies.block]
particles = [{}]
bond_list = [{}]
material = \"rock\"
bonds = \"rock\"
{position}
",
            particles.join(", "),
            bonds.join(", "),
        );
        if !is_bonded {
            scene += &format!(
                "start_as = \"clump\"
clump.scale = {scale}
[replacement.block]
when = {{ {} }}
",
                self.when
            );
        }
        if self.restores && !is_bonded {
            scene += "restore = { leaves = \"far\", min_particles = 2, strain_energy = \"1e6 J/kg\", fluctuation_velocity = \"0.1 m/s\" }
[regions.far]
box = { min = [1, 1, 1], max = [2, 2, 2] }
";
        }
        if self.is_fed && !is_bonded {
            scene += &self.inlet(lowest_m);
        } else {
            scene += "[measures]
largest_utilisation = { of = \"block\", quantity = \"largest_utilisation\", statistic = \"largest\" }
largest_dynamic_utilisation = { of = \"block\", quantity = \"largest_dynamic_utilisation\", statistic = \"largest\" }
";
        }
        scene
    }

    /// An inlet for the block, its lowest centres this high, m.
    fn inlet(&self, lowest_m: f64) -> String {
        let [x, y, z] = self.centre_m([EDGE / 2; 3]);
        let centre = [x, y, z + lowest_m];
        let [from_m, to_m] = [-1e-9, 1e-9].map(|off| centre.map(|x| x + off));
        format!(
            "[regions.gate]
box = {{ min = {from_m:?}, max = {to_m:?} }}
[inlets.gate]
bodies = [\"block\"]
region = \"gate\"
rate = \"1 /s\"
count = 1
"
        )
    }
}
