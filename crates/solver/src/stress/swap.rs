//! Clumps that are replaced while two plates squeeze them.

use super::prediction::{Member, ObservationMethod, Prediction, Quantity, Shown};
use super::trial::Trial;

/// Radius of the spheres of the block, m.
const RADIUS_M: f64 = 1e-3;
/// Spheres along an edge of the block.
const EDGE: usize = 3;
/// What a swap may add to the error of the energy: that of the run itself is smaller.
const ENERGY_ERROR: f64 = 1e-3;
/// The same for the momentum.
const MOMENTUM_ERROR: f64 = 1e-10;

/// A block between plates that close by a thirtieth of its height becomes a bonded cluster when
/// their squeeze reaches 1 MPa. The swap changes neither momentum nor energy, whatever else the
/// scene asks for: clump spheres that are larger than those of the cluster, whose overlap vanishes
/// with the clump and is booked; a cluster that becomes a clump again at every check, and is
/// replaced at once; a block from an inlet; bonds that strengthen or soften.
pub(crate) fn swaps() -> Vec<Member> {
    let mut members = Vec::new();
    for scale in [1.0, 1.02] {
        let mut add = |what: &str, block: Block| {
            members.push(block.member(format!("{what}, clump spheres x {scale}")));
        };
        let plain = Block {
            scale,
            failure: "",
            restores: false,
            is_fed: false,
        };
        add("replaced", plain);
        add(
            "restored and replaced again",
            Block {
                restores: true,
                ..plain
            },
        );
        add(
            "fed",
            Block {
                is_fed: true,
                ..plain
            },
        );
        let failure = ", rate_strengthening = true";
        add("rate strengthening", Block { failure, ..plain });
        let failure = ", fracture_energy = \"200 J/m2\"";
        add("softening", Block { failure, ..plain });
    }
    members
}

#[derive(Clone, Copy)]
struct Block {
    /// Radius of the clump's spheres over that of the cluster's.
    scale: f64,
    /// Further keys of its failure.
    failure: &'static str,
    restores: bool,
    is_fed: bool,
}

impl Block {
    fn member(self, what: String) -> Member {
        Member {
            what,
            trial: Trial::of(self.scene()),
            way: ObservationMethod::Run,
            prediction: Prediction::Ends(vec![
                Shown::at_most(Quantity::EnergyError, ENERGY_ERROR),
                Shown::at_most(Quantity::MomentumError, MOMENTUM_ERROR),
                Shown::count(Quantity::BrokenBonds, 0),
                Shown::count(Quantity::Fragments, 1),
            ]),
        }
    }

    fn scene(self) -> String {
        let Self { scale, failure, .. } = self;
        let at = |k: usize| 2.0 * RADIUS_M * k as f64;
        let mut particles = Vec::new();
        let mut bonds = Vec::new();
        for n in 0..EDGE * EDGE * EDGE {
            let place = [n % EDGE, n / EDGE % EDGE, n / (EDGE * EDGE)];
            let [x, y, z] = place.map(at);
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
        let top_m = at(EDGE - 1) + 2.0 * (RADIUS_M * scale + gap_m);
        let mut scene = format!(
            "version = 1
run.end_time = \"4 ms\"
materials.rock = {{ density = 2500, young_modulus = \"1 GPa\" }}
contacts.rock-rock = {{ restitution = 0.5, friction = 0.3 }}
bonds.rock = {{ young_modulus = \"1 GPa\", poisson_ratio = 0.25, damping = {{ damping_ratio = 0.1 }}, failure = {{ tensile_strength = \"2 MPa\", shear_strength = \"4 MPa\"{failure} }} }}
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
when = {{ principal_stress = \"1 MPa\" }}
",
            particles.join(", "),
            bonds.join(", ")
        );
        if self.restores {
            scene += "restore = { leaves = \"far\", min_particles = 2, strain_energy = \"1e6 J/kg\", fluctuation_velocity = \"100 m/s\" }
[regions.far]
box = { min = [1, 1, 1], max = [2, 2, 2] }
";
        }
        if self.is_fed {
            let [middle_m, height_m] = [at(1), at(1) + RADIUS_M * scale + gap_m];
            let [from_m, to_m] = [middle_m - 1e-9, middle_m + 1e-9];
            scene += &format!(
                "[regions.gate]
box = {{ min = [{from_m}, {from_m}, {}], max = [{to_m}, {to_m}, {}] }}
[inlets.gate]
bodies = [\"block\"]
region = \"gate\"
rate = \"1 /s\"
count = 1
",
                height_m - 1e-9,
                height_m + 1e-9
            );
        }
        scene
    }
}
