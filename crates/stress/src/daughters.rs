//! Particles that daughters replace while two plates squeeze them.

use super::prediction::{Member, Quantity, Shown};
use super::trial::Trial;

/// Radius of the sphere, m.
const RADIUS_M: f64 = 5e-3;
/// What a replacement may add to the error of the energy: that of the run itself is smaller.
const ENERGY_ERROR: f64 = 1e-3;
/// Largest error of the momentum, as for the energy.
const MOMENTUM_ERROR: f64 = 1e-10;

/// A sphere between plates that close by a sixth of its diameter is replaced by daughters when it
/// has taken in 2 J/kg: loose ones, once or again and again down to a size; ones with bonds; with
/// scattered strengths; as the sphere comes from an inlet. Whatever happens, momentum and energy
/// close.
pub(crate) fn daughters() -> Vec<Member> {
    let again = "smallest_size = \"3 mm\"";
    let members = [
        ("loose", "five", "", false, Some(5)),
        ("loose, fed", "five", "", true, Some(5)),
        ("again down to 3 mm", "five", again, false, None),
        ("halves of halves", "two", again, false, None),
        ("again, fed", "two", again, true, None),
        ("bonded", "glued", "", false, Some(1)),
        ("bonded, breaking", "weak", "", false, None),
        (
            "all impacts, scattered",
            "five",
            "energy = \"all-impacts\"\nweibull_modulus = 4",
            false,
            None,
        ),
    ];
    let member = |(what, class, more, is_fed, pieces): (&str, &str, &str, bool, Option<usize>)| {
        let mut shown = vec![
            Shown::at_most(Quantity::EnergyError, ENERGY_ERROR),
            Shown::at_most(Quantity::MomentumError, MOMENTUM_ERROR),
        ];
        shown.extend(pieces.map(|pieces| Shown::count(Quantity::Fragments, pieces)));
        if class == "weak" {
            shown.push(Shown::count(Quantity::BrokenBonds, 6));
        }
        Member::ends(what, Trial::of(scene(class, more, is_fed)), shown)
    };
    members.map(member).into()
}

fn scene(class: &str, more: &str, is_fed: bool) -> String {
    // An inlet needs room.
    let gap_m = if is_fed { 1e-5 } else { 0.0 };
    let top_m = 2.0 * (RADIUS_M + gap_m);
    let middle_m = RADIUS_M + gap_m;
    let daughters = match class {
        "two" => "particles = [[0, 0, 0, 1], [1.2, 0.3, 0.8, 1]]",
        "five" => {
            "particles = [[0, 0, 0, 1], [2, 0.1, 0, 0.8], [0.9, 1.4, 0.2, 0.6], [1, 0.3, 1.5, 0.7], [0.8, -1.2, -0.4, 0.5]]"
        }
        _ => {
            "particles = [[0, 0, 0, 1], [1.6, 0, 0, 1], [0.8, 1.4, 0, 1], [0.8, 0.5, 1.3, 1]]\nbond_list = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]\nbonds = \"glue\""
        }
    };
    let failure = match class {
        "weak" => ", failure = { tensile_strength = \"2 kPa\", shear_strength = \"2 kPa\" }",
        _ => "",
    };
    let (position, feed) = if is_fed {
        let [from_m, to_m] = [middle_m - 1e-9, middle_m + 1e-9];
        let feed = format!(
            "[regions.gate]
box = {{ min = [0, 0, {from_m}], max = [1e-9, 1e-9, {to_m}] }}
[inlets.gate]
bodies = [\"ball\"]
region = \"gate\"
rate = \"1 /s\"
count = 1
"
        );
        (String::new(), feed)
    } else {
        (format!("position = [0, 0, {middle_m}]"), String::new())
    };
    format!(
        "version = 1
run.end_time = \"3 ms\"
materials.rock = {{ density = 2500, young_modulus = \"100 MPa\" }}
contacts.rock-rock = {{ restitution = 0.5, friction = 0.3 }}
bonds.glue = {{ young_modulus = \"100 MPa\", poisson_ratio = 0.25, damping = {{ damping_ratio = 0.1 }}{failure} }}
walls.below = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"rock\" }}
walls.above = {{ plane = {{ point = [0, 0, {top_m}], normal = [0, 0, -1] }}, material = \"rock\", velocity = [0, 0, -0.5] }}
[bodies.ball]
particles = [[0, 0, 0, {RADIUS_M}]]
material = \"rock\"
start_as = \"clump\"
{position}
[bodies.{class}]
material = \"rock\"
{daughters}
[replacement.ball.daughters]
classes = [{{ from = 2, body = \"{class}\" }}]
{more}
{feed}"
    )
}
