//! A head-on impact of a sphere on a wall or another sphere: overlap, duration and rebound in
//! closed form.
//!
//! Hertz: F = 4/3 E* sqrt(R*) d^(3/2) stops an effective mass m* at the overlap (15 m* v^2 / (16 E*
//! sqrt(R*)))^(2/5) and releases it after 2.943 275 times that over v (Johnson 1985, section 11.4).
//! The required restitution is the ratio of the speeds.

use std::f64::consts::PI;

use super::prediction::{Member, ObservationMethod, Prediction, Shown};
use super::trial::Trial;

/// Duration of an elastic impact times speed over largest overlap: 2 sqrt(pi) Gamma(7/5) /
/// Gamma(9/10).
const DURATION: f64 = 2.943_275_4;
/// Tolerance of speeds relative to the impact speed: with about ten steps per impact, the loss
/// depends on the moment within a step at which the ends meet.
const SPEED: f64 = 1e-2;
/// The same without damping: the step of an impact conserves its energy to about 3e-3, so its
/// speeds to half of that.
const ELASTIC_SPEED: f64 = 2e-3;
/// Tolerance of overlaps and durations: with a quarter of the largest step, w dt = 0.5, the error
/// of leapfrog's frequency is (w dt)^2 / 24.
const TIME: f64 = 0.01;

/// Target of an impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// A plane wall.
    Plane,
    /// A sheet of two triangles, open and without thickness.
    Sheet,
    /// A sphere of this radius, m, at rest and free.
    Sphere(f64),
}

/// An impact.
#[derive(Debug, Clone, Copy)]
pub struct Impact {
    /// m
    pub radius_m: f64,
    /// kg/m3
    pub density_kg_m3: f64,
    /// Modulus of both, Pa. Poisson's ratio is 0.3.
    pub young_modulus_pa: f64,
    /// Speed, m/s, downwards.
    pub speed_m_s: f64,
    /// Restitution, in (0, 1].
    pub restitution: f64,
    /// Target of the impact.
    pub target: Target,
    /// Height of the target, m.
    pub at_m: f64,
    /// Speed of a target sphere, upwards, m/s.
    pub other_m_s: f64,
    /// Distance before the impact, over the radius.
    pub gap: f64,
    /// "bonded" or "clump".
    pub start_as: &'static str,
}

impl Impact {
    /// A sphere of 1 mm and 70 GPa on a plane, elastic.
    pub fn usual() -> Self {
        Self {
            radius_m: 1e-3,
            density_kg_m3: 2500.0,
            young_modulus_pa: 7e10,
            speed_m_s: 1.0,
            restitution: 1.0,
            target: Target::Plane,
            at_m: 0.0,
            other_m_s: 0.0,
            gap: 0.5,
            start_as: "bonded",
        }
    }

    /// Velocity change of each of the two, divided by the relative velocity and by (1 + e): m* over
    /// the mass of the first, and over that of the second.
    fn fractions(&self) -> [f64; 2] {
        match self.target {
            Target::Plane | Target::Sheet => [1.0, 0.0],
            Target::Sphere(other_m) => {
                let cubes = [self.radius_m, other_m].map(|r| r.powi(3));
                let sum = cubes[0] + cubes[1];
                [cubes[1] / sum, cubes[0] / sum]
            }
        }
    }

    /// Speed at which the two meet, m/s.
    fn closing_m_s(&self) -> f64 {
        self.speed_m_s + self.other_m_s
    }

    /// Largest overlap without damping, m.
    pub fn overlap_m(&self) -> f64 {
        let mass_kg = self.density_kg_m3 * 4.0 / 3.0 * PI * self.radius_m.powi(3);
        let reduced_kg = self.fractions()[0] * mass_kg;
        let reduced_m = match self.target {
            Target::Plane | Target::Sheet => self.radius_m,
            Target::Sphere(other_m) => self.radius_m * other_m / (self.radius_m + other_m),
        };
        let reduced_pa = self.young_modulus_pa / (2.0 * (1.0 - 0.3 * 0.3));
        let energy = 15.0 * reduced_kg * self.closing_m_s().powi(2);
        (energy / (16.0 * reduced_pa * reduced_m.sqrt())).powf(0.4)
    }

    /// Without damping, s.
    fn duration_s(&self) -> f64 {
        DURATION * self.overlap_m() / self.closing_m_s()
    }

    /// Time at which the two touch, s.
    fn touched_s(&self) -> f64 {
        self.gap * self.radius_m / self.closing_m_s()
    }

    /// Time of the evaluation, s: some time after the two have separated, even if damping makes
    /// that take longer.
    fn end_s(&self) -> f64 {
        self.touched_s() + 3.0 * self.duration_s()
    }

    /// Its scene. `time_step`: of `[run]`.
    pub fn trial(&self, time_step: &str) -> Trial {
        let mut text = format!(
            "version = 1
run = {{ end_time = {:e}, time_step = {time_step} }}
materials.m = {{ density = {}, young_modulus = {:e}, poisson_ratio = 0.3 }}
contacts.m-m = {{ restitution = {} }}
bodies.ball = {{ particles = [[0, 0, {:e}, {:e}]], material = \"m\", velocity = [0, 0, {}], start_as = \"{}\" }}
measures.rebound = {{ of = \"ball\", quantity = \"velocity_z\" }}
measures.lowest_place = {{ of = \"ball\", quantity = \"position_z\", statistic = \"smallest\" }}
measures.last_place = {{ of = \"ball\", quantity = \"position_z\" }}
output = {{ series = {:e} }}
",
            self.end_s(),
            self.density_kg_m3,
            self.young_modulus_pa,
            self.restitution,
            self.at_m + (1.0 + self.gap) * self.radius_m,
            self.radius_m,
            -self.speed_m_s,
            self.start_as,
            1e-6 * self.end_s(),
        );
        let mut surfaces = Vec::new();
        match self.target {
            Target::Plane => {
                text += &format!(
                    "walls.floor = {{ plane = {{ point = [0, 0, {:e}], normal = [0, 0, 1] }}, material = \"m\" }}\n",
                    self.at_m
                );
            }
            Target::Sheet => {
                text += "walls.floor = { stl = \"sheet.stl\", unit = \"m\", material = \"m\" }\n";
                surfaces.push(("sheet.stl", sheet(4.0 * self.radius_m, self.at_m)));
            }
            Target::Sphere(other_m) => {
                text += &format!(
                    "bodies.other = {{ particles = [[0, 0, {:e}, {other_m:e}]], material = \"m\", velocity = [0, 0, {}] }}
measures.rebound_of_other = {{ of = \"other\", quantity = \"velocity_z\" }}
",
                    self.at_m - other_m,
                    self.other_m_s,
                );
            }
        }
        Trial {
            surfaces,
            ..Trial::of(text)
        }
    }

    /// It rebounds with the required restitution; an elastic one also after the duration of Hertz,
    /// and from a wall at rest from the overlap of Hertz.
    pub fn member(&self, what: String) -> Member {
        let closing = self.closing_m_s();
        let fractions = self.fractions();
        let speed = if self.restitution == 1.0 {
            ELASTIC_SPEED
        } else {
            SPEED
        };
        let gain = fractions.map(|fraction| (1.0 + self.restitution) * fraction * closing);
        let (before, after) = (-self.speed_m_s, gain[0] - self.speed_m_s);
        let mut shown = vec![Shown::measure("rebound", "m/s", after, speed * closing)];
        if let Target::Sphere(_) = self.target {
            let after = self.other_m_s - gain[1];
            shown.push(Shown::measure(
                "rebound_of_other",
                "m/s",
                after,
                SPEED * closing,
            ));
        } else if self.restitution == 1.0 {
            let overlap_m = self.overlap_m();
            let deepest = self.at_m + self.radius_m - overlap_m;
            shown.push(Shown::measure(
                "lowest_place",
                "m",
                deepest,
                TIME * overlap_m,
            ));
        }
        if self.restitution == 1.0 {
            // While the two touch, their common centre of mass moves on.
            let (touched_s, together_s) = (self.touched_s(), self.duration_s());
            let centre = before + fractions[0] * closing;
            let start = self.at_m + (1.0 + self.gap) * self.radius_m;
            let apart_s = self.end_s() - touched_s - together_s;
            let place = start + before * touched_s + centre * together_s + after * apart_s;
            let way = closing * (TIME * together_s + speed * apart_s);
            shown.push(Shown::measure("last_place", "m", place, way));
        }
        Member::ends(what, self.trial("\"auto\""), shown)
    }

    /// It is stopped, or with `is_refused` not even started, with these words. `time_step`: of
    /// `[run]`.
    pub fn ended_by(&self, what: String, trial: Trial, is_refused: bool, words: &[&str]) -> Member {
        let words = words.iter().map(|word| (*word).to_owned()).collect();
        Member {
            what,
            trial,
            way: ObservationMethod::Run,
            prediction: if is_refused {
                Prediction::Refused(words)
            } else {
                Prediction::Stopped(words)
            },
        }
    }
}

/// A square sheet with this half-width, m, at this height, m, as the text of an STL file.
fn sheet(half_m: f64, at_m: f64) -> String {
    let corner = |x: f64, y: f64| format!("vertex {:e} {:e} {at_m:e}\n", x * half_m, y * half_m);
    let facet = |a: String, b: String, c: String| {
        format!("facet normal 0 0 1\nouter loop\n{a}{b}{c}endloop\nendfacet\n")
    };
    let [a, b, c, d] =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| corner(x, y));
    format!(
        "solid sheet\n{}{}endsolid sheet\n",
        facet(a.clone(), b, c.clone()),
        facet(a, c, d)
    )
}

/// At 300 m/s: of glass, as predicted by Hertz; of a gel, whose centre would go through the
/// surface.
pub fn impacts() -> Vec<Member> {
    let hard = Impact {
        speed_m_s: 300.0,
        ..Impact::usual()
    };
    let mut members = Vec::new();
    for restitution in [1.0, 0.5, 0.1] {
        let wall = Impact {
            restitution,
            ..hard
        };
        members.push(wall.member(format!("on a wall, restitution {restitution}")));
        let ball = Impact {
            target: Target::Sphere(1e-3),
            ..wall
        };
        members.push(ball.member(format!("on a sphere, restitution {restitution}")));
    }
    // Slightly different distances before the impact: the result must not depend on when the two
    // are first listed as near.
    for n in 0..36 {
        let gap = 1.03 + f64::from(n) * 0.002;
        let gel = Impact {
            young_modulus_pa: 1e7,
            speed_m_s: 10.0,
            other_m_s: 10.0,
            target: Target::Sphere(1e-3),
            gap,
            ..hard
        };
        members.push(gel.member(format!("of two gel spheres, {gap:.3} radii apart")));
    }
    let soft = Impact {
        young_modulus_pa: 1e7,
        ..hard
    };
    let trial = soft.trial("\"auto\"");
    let gone = ["the centre of particle 0 of the body 'ball' has gone through the wall 'floor'"];
    members.push(soft.ended_by("on a wall, 10 MPa".to_owned(), trial, false, &gone));
    let soft = Impact {
        target: Target::Sphere(1e-3),
        ..soft
    };
    let trial = soft.trial("\"auto\"");
    let gone = [
        "particle 0 of the body 'ball' and particle 0 of the body 'other' are pressed into each other",
    ];
    members.push(soft.ended_by("on a sphere, 10 MPa".to_owned(), trial, false, &gone));
    let absurd = Impact {
        speed_m_s: 1e5,
        ..hard
    };
    let trial = absurd.trial("\"auto\"");
    let gone = ["has gone through the wall 'floor'"];
    members.push(absurd.ended_by("on a wall, 1e5 m/s".to_owned(), trial, false, &gone));
    members
}

/// A sheet that a sphere would jump over with the requested step, which is refused; with force, the
/// run is stopped. With its own step the sphere rebounds.
pub(crate) fn at_mesh() -> Vec<Member> {
    let mut members = Vec::new();
    for restitution in [1.0, 0.5] {
        for speed_m_s in [1.0, 300.0] {
            let impact = Impact {
                target: Target::Sheet,
                speed_m_s,
                restitution,
                ..Impact::usual()
            };
            members.push(impact.member(format!("{speed_m_s} m/s, restitution {restitution}")));
        }
    }
    let fast = Impact {
        target: Target::Sheet,
        speed_m_s: 300.0,
        ..Impact::usual()
    };
    let jump = format!("{:e}", 1.5 * fast.radius_m / fast.speed_m_s);
    let trial = fast.trial(&jump);
    let words = ["run.time_step", "is above the largest stable step of"];
    members.push(fast.ended_by(
        "1.5 radii in a step".to_owned(),
        trial.clone(),
        true,
        &words,
    ));
    let forced = Trial {
        force_step: true,
        ..trial
    };
    let words = [
        "particle 0 of the body 'ball' moves by",
        "contacts would miss it",
    ];
    members.push(fast.ended_by(
        "1.5 radii in a step by force".to_owned(),
        forced,
        false,
        &words,
    ));
    members
}
