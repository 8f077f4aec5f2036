//! Clumps that are replaced while two plates squeeze them.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use super::prediction::{Member, ObservationMethod, Prediction, Quantity, Shown};
use super::trial::Trial;

/// Radius of the spheres of the block, m.
const RADIUS_M: f64 = 1e-3;
/// Spheres along an edge of the block.
const EDGE: usize = 3;
/// Bonds of the block: those of neighbours along its edges.
const BONDS: usize = 3 * EDGE * EDGE * (EDGE - 1);
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
/// What breaking bonds may add to the error of the energy: the verdict of a run permits as much.
const BREAKAGE_ERROR: f64 = 1e-2;

/// A block between plates that close by a thirtieth of its height becomes a bonded cluster when
/// their squeeze reaches 1 MPa. The swap changes neither momentum nor energy, whatever else the
/// scene asks for: clump spheres that are larger than those of the cluster, whose overlap vanishes
/// with the clump and is booked; a cluster that becomes a clump again at every check, and is
/// replaced at once; a block from an inlet. A tilted block is loaded beyond the strength of its
/// bonds: they soften, break, or hold because the strain rate strengthens them.
pub(crate) fn swaps() -> Vec<Member> {
    let mut members = Vec::new();
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
        let mut add = |what: &str, block: Block, more: Vec<Shown>| {
            members.push(block.member(format!("{what}, clump spheres x {scale}"), more));
        };
        let undamped = Block {
            restitution: 1.0,
            ..upright.clone()
        };
        add("replaced", upright.clone(), whole());
        add("replaced without damping", undamped, freed(scale));
        add(
            "replaced by the force of a contact",
            by_force(&upright),
            whole(),
        );
        add("restored and replaced again", restored(&upright), whole());
        add("fed", fed(&upright), whole());
        add("softening", softens.clone(), damaged());
        add("softening and restored", restored(&softens), damaged());
        add("softening and fed", fed(&softens), damaged());
        add("breaking", tilted(""), broken());
        let strengthens =
            ", rate_strengthening = true, strain_rate_measure = \"relative-velocity\"";
        add("held by its strain rate", tilted(strengthens), held());
    }
    members
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

/// Bonds take up to all of their fracture energy, and at least a hundredth of it, and hold.
fn damaged() -> Vec<Shown> {
    let all_j = BONDS as f64 * FRACTURE_J_M2 * PI * RADIUS_M * RADIUS_M;
    let mut shown = whole();
    shown.push(Shown::between(
        Quantity::BondDamage,
        "J",
        0.01 * all_j,
        all_j,
    ));
    shown
}

/// Some of the bonds break, or all.
fn broken() -> Vec<Shown> {
    vec![
        Shown::at_most(Quantity::EnergyError, BREAKAGE_ERROR),
        Shown::between(Quantity::BrokenBonds, "", 1.0, BONDS as f64),
    ]
}

/// Bonds hold although stresses exceed their strength, at least by a tenth: it is larger by the
/// dynamic increase factor.
fn held() -> Vec<Shown> {
    let mut shown = whole();
    let beyond = Quantity::Measure("largest_utilisation");
    shown.push(Shown::between(beyond, "", 1.1, 5.0));
    shown.push(Shown::between(
        Quantity::Measure("largest_dynamic_utilisation"),
        "",
        0.0,
        1.0,
    ));
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
        Member {
            what,
            trial: Trial::of(self.scene()),
            way: ObservationMethod::Run,
            prediction: Prediction::Ends(shown),
        }
    }

    /// Centre of a sphere at this place in the block, m: the lowest are at z = 0.
    fn centre_m(&self, place: [usize; 3]) -> [f64; 3] {
        let [x, y, z] = place.map(|k| 2.0 * RADIUS_M * k as f64);
        match self.is_tilted {
            true => [FRAC_1_SQRT_2 * (x - z), y, FRAC_1_SQRT_2 * (x + z)],
            false => [x, y, z],
        }
    }

    fn scene(&self) -> String {
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
        let position = match self.is_fed {
            true => String::new(),
            false => format!("position = [0, 0, {}]", RADIUS_M * scale),
        };
        // An inlet needs room.
        let gap_m = if self.is_fed { 2e-6 } else { 0.0 };
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
start_as = \"clump\"
clump.scale = {scale}
{position}
[replacement.block]
when = {{ {} }}
",
            particles.join(", "),
            bonds.join(", "),
            self.when
        );
        if self.restores {
            scene += "restore = { leaves = \"far\", min_particles = 2, strain_energy = \"1e6 J/kg\", fluctuation_velocity = \"100 m/s\" }
[regions.far]
box = { min = [1, 1, 1], max = [2, 2, 2] }
";
        }
        if self.is_fed {
            scene += &self.inlet(RADIUS_M * scale + gap_m);
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
