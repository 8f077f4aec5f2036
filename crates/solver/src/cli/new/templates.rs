//! The scenes to start from: text, shape, density, spheres, and the one number that defines the
//! situation.

use std::f64::consts::PI;

use clap::ValueEnum;
use dem_io::units::{ANGULAR_VELOCITY, Dimension, LENGTH, VELOCITY};
use dem_io::{Diagnostic, Result};

use super::fill::Value;
use super::shape::{Shape, drum};
use super::surfaces::{Deck, Facet, revolved};

const GRAVITY_M_S2: f64 = 9.81;
/// Of a hollow between the jaws of the crusher, which lean outwards by 10 degrees each: height over
/// width.
const HEIGHT_OVER_WIDTH: f64 = 2.836;

/// The scenes to start from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Template {
    /// A tablet falls onto a plate
    Drop,
    /// A weight falls onto a disc of rock: energy and t10
    DropWeight,
    /// Blocks leave a belt and hit a plate; they break where they hit
    Chute,
    /// A lump between two jaws, one of which swings
    Crusher,
    /// A drum turns with balls and lumps: its power
    Mill,
    /// Pellets run out of a silo through a slot
    Silo,
    /// Ore between a mantle that gyrates and its bowl: product and power
    Cone,
    /// A deck with openings that vibrates: what passes, and what goes over it
    Screen,
    /// Four-point bending of a bar
    Bending,
    /// A disc is pressed across its diameter until it splits
    Brazilian,
    /// Compression of a cylinder between plates
    Compression,
}

/// The number that defines the situation: its option, what it is, its default, and the range in
/// which the scene makes sense.
#[derive(Debug, Clone)]
pub(super) struct Situation {
    pub(super) option: &'static str,
    pub(super) what: &'static str,
    pub(super) dimension: &'static Dimension,
    pub(super) default_si: f64,
    pub(super) range_si: [f64; 2],
}

/// The spheres that a body is packed with, if no diameter is given.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fineness {
    /// Spheres across the thinnest part that are wanted.
    pub(super) across: f64,
    pub(super) most_spheres: usize,
    /// The body cannot break: few spheres across do no harm.
    pub(super) is_rigid: bool,
}

/// The body whose scene is written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measured {
    /// Extents along x, y and z, m.
    pub(super) extent_m: [f64; 3],
    pub(super) mass_kg: f64,
    pub(super) density_kg_m3: f64,
}

impl Measured {
    pub(super) fn size_m(&self) -> f64 {
        self.extent_m.into_iter().fold(0.0, f64::max)
    }
}

impl Situation {
    /// Refuses a number outside the range.
    pub(super) fn check(&self, si: f64) -> Result<()> {
        let [low, high] = self.range_si;
        if (low..=high).contains(&si) {
            return Ok(());
        }
        let [low, si, high] = [low, si, high].map(|si| Value::new(si, self.dimension.si).text());
        let problem = format!("{si} is not between {low} and {high}");
        let remedy = format!("write a {} in this range", self.dimension.name);
        Err(Diagnostic::input("", problem, remedy))
    }
}

impl Template {
    pub(super) fn text(self) -> &'static str {
        match self {
            Self::Drop => include_str!("templates/drop.toml"),
            Self::DropWeight => include_str!("templates/drop-weight.toml"),
            Self::Chute => include_str!("templates/chute.toml"),
            Self::Crusher => include_str!("templates/crusher.toml"),
            Self::Mill => include_str!("templates/mill.toml"),
            Self::Silo => include_str!("templates/silo.toml"),
            Self::Cone => include_str!("templates/cone.toml"),
            Self::Screen => include_str!("templates/screen.toml"),
            Self::Bending => include_str!("templates/bending.toml"),
            Self::Brazilian => include_str!("templates/brazilian.toml"),
            Self::Compression => include_str!("templates/compression.toml"),
        }
    }

    /// As on the command line.
    pub(super) fn name(self) -> String {
        let value = self.to_possible_value();
        value.map_or(String::new(), |value| value.get_name().to_owned())
    }

    /// The option of its situation.
    pub(super) fn option(self) -> Option<&'static str> {
        match self {
            Self::Drop | Self::DropWeight => Some("--height"),
            Self::Chute | Self::Mill => Some("--speed"),
            Self::Crusher | Self::Silo | Self::Cone | Self::Screen => Some("--gap"),
            Self::Bending | Self::Brazilian | Self::Compression => None,
        }
    }

    pub(super) fn shape(self) -> Shape {
        match self {
            Self::Drop => Shape::Cylinder(30.0, 24.0),
            Self::Chute => Shape::Block([50.0, 45.0, 40.0]),
            Self::Crusher => Shape::Disc(60.0, 60.0),
            Self::Mill => Shape::Block([30.0, 25.0, 20.0]),
            Self::Silo => Shape::Cylinder(8.0, 8.0),
            Self::Cone => Shape::Ball(30.0),
            Self::Screen => Shape::Block([20.0, 18.0, 16.0]),
            Self::Bending => Shape::Block([105.0, 30.0, 30.0]),
            Self::DropWeight | Self::Brazilian => Shape::Disc(40.0, 30.0),
            Self::Compression => Shape::Cylinder(30.0, 60.0),
        }
    }

    pub(super) fn density_kg_m3(self) -> f64 {
        match self {
            Self::Drop => 1500.0,
            Self::Chute | Self::Crusher | Self::Bending => 2050.0,
            Self::DropWeight | Self::Brazilian | Self::Compression | Self::Cone | Self::Screen => {
                2650.0
            }
            Self::Mill => 2700.0,
            Self::Silo => 1200.0,
        }
    }

    pub(super) fn fineness(self) -> Fineness {
        let (across, most_spheres) = match self {
            Self::Mill => (3.4, 300),
            Self::Silo | Self::Screen => (3.2, 100),
            Self::Bending => (9.8, 6000),
            _ => (9.8, 3000),
        };
        Fineness {
            across,
            most_spheres,
            is_rigid: matches!(self, Self::Mill | Self::Silo | Self::Screen),
        }
    }

    /// Whether its bodies are single spheres, which have neither shape nor packing.
    pub(super) fn is_ball(self) -> bool {
        self == Self::Cone
    }

    /// None for tests of the laboratory whose walls press until the body breaks.
    pub(super) fn situation(self, body: &Measured) -> Option<Situation> {
        let size_m = body.size_m();
        let critical_rad_s = (GRAVITY_M_S2 / drum_radius_m(body)).sqrt();
        let width_m = body.extent_m[0];
        let (what, dimension, default_si, range_si) = match self {
            Self::Drop => ("of the fall", &LENGTH, 1.0, [1e-3, 1e3]),
            Self::DropWeight => ("of the fall of the weight", &LENGTH, 0.2, [1e-3, 1e2]),
            Self::Chute => ("of the belt", &VELOCITY, 2.0, [0.1, 20.0]),
            Self::Mill => {
                let range = [0.05, 2.0].map(|factor| factor * critical_rad_s);
                (
                    "of the drum",
                    &ANGULAR_VELOCITY,
                    0.7 * critical_rad_s,
                    range,
                )
            }
            Self::Crusher => {
                // Spheres of a tenth of the width pass the lowest when it is closed.
                let range = [0.2, 0.9].map(|factor| factor * width_m);
                ("between the jaws", &LENGTH, width_m / 3.0, range)
            }
            Self::Silo => {
                let range = [1.0, 10.0].map(|factor| factor * size_m);
                ("width of the slot", &LENGTH, 5.0 * size_m, range)
            }
            Self::Cone => {
                let range = [0.2, 0.6].map(|factor| factor * size_m);
                ("at the closed side", &LENGTH, 0.25 * size_m, range)
            }
            Self::Screen => {
                let range = [0.3, 1.5].map(|factor| factor * size_m);
                ("width of the openings", &LENGTH, 0.6 * size_m, range)
            }
            Self::Bending | Self::Brazilian | Self::Compression => return None,
        };
        Some(Situation {
            option: self.option()?,
            what,
            dimension,
            default_si,
            range_si,
        })
    }

    /// Refuses a body that the scene has no use for.
    pub(super) fn check(self, extent_m: [f64; 3]) -> Result<()> {
        let [x, y, z] = extent_m;
        if self != Self::Bending || x >= 3.0 * y.max(z) {
            return Ok(());
        }
        let [x, y, z] = [x, y, z].map(|length| Value::length(length).text());
        let problem =
            format!("it is {x} along x, less than 3 times its width of {y} or its height of {z}");
        let remedy = "take a bar that lies along x and is loaded along z";
        Err(Diagnostic::input("", problem, remedy))
    }

    /// What the marks of the text stand for.
    pub(super) fn values(self, body: &Measured, situation_si: f64) -> Vec<(&'static str, Value)> {
        let [x, y, z] = body.extent_m;
        let size = body.size_m();
        let mut values = vec![
            ("x", Value::length(x)),
            ("y", Value::length(y)),
            ("z", Value::length(z)),
            ("size", Value::length(size)),
        ];
        values.extend(match self {
            Self::Drop => {
                // Waves cross the body in a time that goes with its size.
                let impact = 1e-3 * (size / 30e-3) * (body.density_kg_m3 / 1500.0).sqrt();
                // Chips of a higher fall roll below the body for longer.
                let end = 4.0 * impact * situation_si.clamp(1.0, 3.0);
                let height = ("height", Value::length(situation_si));
                vec![height, ("end", Value::new(end, "s"))]
            }
            Self::DropWeight => {
                let impact = 1e-3 * (size / 40e-3) * (body.density_kg_m3 / 2650.0).sqrt();
                vec![
                    ("height", Value::length(situation_si)),
                    ("impact", Value::new(impact, "s")),
                    ("weight_mass", Value::new(50.0 * body.mass_kg, "kg")),
                ]
            }
            Self::Chute => {
                let reach = 0.1 * situation_si + size;
                let fall = 0.5 * GRAVITY_M_S2 * (reach / situation_si).powi(2);
                vec![
                    ("speed", Value::new(situation_si, "m/s")),
                    ("reach", Value::length(reach)),
                    ("fall", Value::length(fall)),
                    ("ride", Value::new(size / situation_si, "s")),
                    ("second", Value::new(1.0, "s")),
                    ("rate", Value::new(0.2 * situation_si / size, "/s")),
                ]
            }
            Self::Crusher => crusher_values(body, situation_si),
            Self::Mill => vec![
                ("speed", Value::new(situation_si, "rad/s")),
                ("radius", Value::length(drum_radius_m(body))),
                (
                    "ball_mass",
                    Value::new(7800.0 * PI / 6.0 * (0.6 * size).powi(3), "kg"),
                ),
            ],
            Self::Silo => {
                let fall = (40.0 * size / GRAVITY_M_S2).sqrt();
                vec![
                    ("gap", Value::length(situation_si)),
                    ("fall", Value::new(fall, "s")),
                    ("fall_speed", Value::new(GRAVITY_M_S2 * fall, "m/s")),
                    ("rate", Value::new(160.0 / fall, "/s")),
                ]
            }
            Self::Cone => {
                let fall = (40.0 * size / GRAVITY_M_S2).sqrt();
                vec![
                    ("gap", Value::length(situation_si)),
                    ("mass", Value::new(body.mass_kg, "kg")),
                    ("fall", Value::new(fall, "s")),
                    ("fall_speed", Value::new(GRAVITY_M_S2 * fall, "m/s")),
                    ("turns", Value::new(11.0 / fall, "rad/s")),
                    ("rate", Value::new(4.0 / fall, "/s")),
                ]
            }
            Self::Screen => screen_values(body, situation_si),
            Self::Bending | Self::Brazilian | Self::Compression => vec![],
        });
        values
    }

    /// Names and facets of the surfaces of walls, mm.
    pub(super) fn surfaces(
        self,
        body: &Measured,
        situation_si: f64,
    ) -> Vec<(&'static str, Vec<Facet>)> {
        let size = 1e3 * body.size_m();
        match self {
            Self::Mill => vec![("drum.stl", drum(1e3 * drum_radius_m(body), 3.2 * size))],
            Self::Cone => {
                let line = |points: &[[f64; 2]]| {
                    let points = points.iter().map(|point| point.map(|x| x * size));
                    revolved(&points.collect::<Vec<_>>())
                };
                // Along the normal of the mantle, from its middle position.
                let lowest = 1e3 * situation_si / size + CONE_THROW;
                let [low, high] = [(MANTLE[1], lowest), (MANTLE[2], CONE_MOUTH)]
                    .map(|([r, z], gap)| [r + 0.857 * gap, z + 0.515 * gap]);
                let rim = [4.5, 8.0];
                vec![
                    ("mantle.stl", line(&MANTLE)),
                    ("bowl.stl", line(&[rim, high, low])),
                ]
            }
            Self::Screen => vec![("deck.stl", deck(body, situation_si).facets())],
            _ => vec![],
        }
    }
}

/// The outline of the mantle of the cone, radius and height in sizes of the body. Its side leans
/// outwards by 31 degrees.
const MANTLE: [[f64; 2]; 4] = [[0.0, 0.0], [5.0, 0.0], [2.0, 5.0], [0.0, 6.0]];
/// Half the difference between the gaps at the open and at the closed side, in the same.
const CONE_THROW: f64 = 0.1;
/// Gap at the upper end of the side, in the same.
const CONE_MOUTH: f64 = 1.4;

/// The deck of the screen: about 16 sizes long and 5 wide.
fn deck(body: &Measured, opening_m: f64) -> Deck {
    let size = 1e3 * body.size_m();
    let (opening, bar) = (1e3 * opening_m, 0.3 * size);
    let count = |length: f64| (length * size / (opening + bar)).round().max(1.0) as u32;
    Deck {
        openings: [count(16.0), count(5.0)],
        opening,
        bar,
        thickness: 0.25 * size,
    }
}

fn crusher_values(body: &Measured, gap_m: f64) -> Vec<(&'static str, Value)> {
    let [x, _, z] = body.extent_m;
    let nip = HEIGHT_OVER_WIDTH * (1.06 * x - gap_m);
    // The jaw is as long again above the lump as below it: near its pivot it would hardly move.
    let top = 2.0 * nip + 1.3 * z;
    // It closes by 0.4 of the gap, so that single spheres pass.
    let swing_deg = (0.4 * gap_m / top).to_degrees().min(3.0);
    // A lump falls by its own size in a time that goes with the root of its size.
    let stroke = 0.2 * (body.size_m() / 60e-3).sqrt();
    vec![
        ("stroke", Value::new(stroke, "s")),
        ("frequency", Value::new(1.0 / stroke, "Hz")),
        ("gap", Value::length(gap_m)),
        ("nip", Value::length(nip)),
        ("top", Value::length(top)),
        ("swing", Value::new(swing_deg, "deg")),
    ]
}

fn screen_values(body: &Measured, opening_m: f64) -> Vec<(&'static str, Value)> {
    let size = body.size_m();
    let fall = (40.0 * size / GRAVITY_M_S2).sqrt();
    let radius = 0.15 * size;
    let deck = deck(body, opening_m);
    let [length, width] = deck
        .openings
        .map(|count| 1e-3 * f64::from(count) * (deck.opening + deck.bar));
    let (sine, cosine) = 14_f64.to_radians().sin_cos();
    let fine_kg = body.density_kg_m3 * PI / 6.0 * (0.4 * size).powi(3);
    vec![
        ("gap", Value::length(opening_m)),
        ("radius", Value::length(radius)),
        // The acceleration of the deck is 2.2 times gravity.
        (
            "turns",
            Value::new((2.2 * GRAVITY_M_S2 / radius).sqrt(), "rad/s"),
        ),
        ("width", Value::length(width)),
        ("reach", Value::length(0.5 * cosine * length)),
        ("drop", Value::length(0.5 * sine * length)),
        ("fine_mass", Value::new(fine_kg, "kg")),
        ("fall", Value::new(fall, "s")),
        ("fall_speed", Value::new(GRAVITY_M_S2 * fall, "m/s")),
        ("coarse_rate", Value::new(6.0 / fall, "/s")),
        ("fine_rate", Value::new(48.0 / fall, "/s")),
    ]
}

fn drum_radius_m(body: &Measured) -> f64 {
    5.0 * body.size_m()
}

#[cfg(test)]
mod tests {
    use super::super::fill::filled;
    use super::*;

    /// Every mark of every text has a value.
    #[test]
    fn texts_are_filled() {
        for template in Template::value_variants() {
            let body = Measured {
                extent_m: [0.03, 0.02, 0.01],
                mass_kg: 0.01,
                density_kg_m3: 2000.0,
            };
            let situation = template.situation(&body);
            assert_eq!(
                situation.as_ref().map(|known| known.option),
                template.option()
            );
            let si = situation.map_or(0.0, |situation| situation.default_si);
            let text = filled(template.text(), "mass = 1", &template.values(&body, si));
            for wrong in ["@", "NaN", "inf"] {
                assert!(!text.contains(wrong), "{template:?}: {text}");
            }
        }
    }
}
