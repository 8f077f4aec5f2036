//! The motion of a wall: at a velocity, by a displacement, or as a servo.

use crate::factor::{self, Factor, factor, factor_from_zero, over_time};
use crate::field::Field;
use crate::listing::Listing;
use crate::schema::{Kind, table_schema};
use crate::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{ANGLE, ANGULAR_VELOCITY, FORCE, FREQUENCY, LENGTH, VELOCITY};
use dem_physics::machine::{Gyration, Orbit};
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;
use std::ops::Bound::Excluded;

/// The motion of a wall.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub enum WallMotion {
    /// Fixed.
    #[default]
    Fixed,
    /// `velocity` and `angular_velocity`, with `ramp` or `table`.
    Velocity {
        /// Velocity of the pivot, m/s. Length 3.
        velocity_m_s: [f64; 3],
        /// Angular velocity about the pivot, which moves along, rad/s. Length 3.
        spin_rad_s: [f64; 3],
        /// Factor on both, over time.
        factor: Factor,
    },
    /// `displacement` and `angular_displacement`, with `ramp` or `table`.
    Displacement {
        /// Displacement of the pivot, m. Length 3.
        displacement_m: [f64; 3],
        /// Rotation about the pivot, which moves along: `angular_displacement = { axis, angle }` as
        /// a rotation vector, rad. Length 3.
        angular_displacement_rad: [f64; 3],
        /// Factor on both, over time.
        factor: Factor,
    },
    /// `servo = { force, direction, max_velocity }`, with `ramp` or `table`: moves along
    /// `direction` so that it exerts a given force.
    Servo {
        /// `force`: force to exert along `direction`, N; below 0 against it.
        force_n: f64,
        /// `direction`, of length 1. Length 3.
        direction: [f64; 3],
        /// `max_velocity`, m/s; more than 0.
        max_velocity_m_s: f64,
        /// Factor on the force, over time.
        factor: Factor,
    },
    /// `orbit = { axis, towards, radius, frequency }`: goes round a circle without turning. It is
    /// drawn at the centre of the circle.
    Orbit(Orbit),
    /// `gyration = { axis, towards, angle, frequency, spin }`: its axis goes round a cone, with the
    /// tip at the pivot. It is drawn upright.
    Gyration(Gyration),
    /// The end of a long elastic bar, which a `[test]` makes of its walls: it pushes the body with
    /// Z (2 v_I - v) and moves at v, both along `direction`.
    Bar {
        /// Towards the body, or away from it behind the body, of length 1. Length 3.
        direction: [f64; 3],
        /// Impedance Z, N s/m.
        impedance_n_s_m: f64,
        /// Velocity v_I of the incident pulse, m/s; 0: none.
        incident_m_s: f64,
        /// Factor on it, over time.
        factor: Factor,
    },
    /// A weight that a `[test]` makes of its wall: it moves freely along `direction`.
    Weight {
        /// Of length 1. Length 3.
        direction: [f64; 3],
        /// Mass, kg.
        mass_kg: f64,
        /// Velocity at the start, m/s.
        velocity_m_s: f64,
        /// Acceleration by gravity along `direction`, m/s2.
        gravity_m_s2: f64,
    },
}

impl WallMotion {
    /// Whether the wall turns.
    pub fn turns(&self) -> bool {
        match self {
            Self::Velocity { spin_rad_s, .. } => *spin_rad_s != [0.0; 3],
            Self::Displacement {
                angular_displacement_rad,
                ..
            } => *angular_displacement_rad != [0.0; 3],
            Self::Gyration(_) => true,
            _ => false,
        }
    }
}

table_schema! {
    /// A servo-controlled wall: it moves along a direction such that it exerts a given force.
    pub(crate) static SERVO = "Servo";

    /// Force to exert along `direction`; negative values act against it.
    quantity("force", &FORCE).required("\"100 N\"");
    /// Direction of motion; its length does not matter.
    new("direction", Kind::Direction("a direction")).required("[0, 0, -1]");
    /// Maximum velocity.
    quantity("max_velocity", &VELOCITY).positive().required("\"10 mm/s\", its largest");
}

table_schema! {
    /// Circular vibration: every point of the wall goes round a circle, and the wall does not turn.
    /// The wall is drawn at the centre of the circle.
    pub(crate) static ORBIT = "Orbit";

    /// Axis of the circle, which the wall goes round right-handed; its length does not matter.
    new("axis", Kind::Direction("an axis")).required("[0, 1, 0]");
    /// From the centre of the circle to the wall at the start; its part normal to the axis counts.
    new("towards", Kind::Direction("a direction")).required("[1, 0, 0]");
    /// Radius of the circle: half the stroke.
    quantity("radius", &LENGTH).positive().required("\"4 mm\"");
    /// Frequency.
    quantity("frequency", &FREQUENCY).positive().required("\"900 rpm\"");
}

table_schema! {
    /// Gyration of a cone crusher's mantle: the axis of the wall goes round a cone, the tip of which
    /// is the `pivot`. The wall is drawn upright, its axis along `axis`.
    pub(crate) static GYRATION = "Gyration";

    /// Axis of the cone, which the axis of the wall goes round right-handed; its length does not
    /// matter.
    new("axis", Kind::Direction("an axis")).required("[0, 0, 1]");
    /// Direction in which the axis of the wall leans at the start, seen from the pivot along `axis`;
    /// its part normal to the axis counts.
    new("towards", Kind::Direction("a direction")).required("[1, 0, 0]");
    /// Angle between the two axes.
    quantity("angle", &ANGLE).within(Excluded(0.0), Excluded(FRAC_PI_2)).required("\"1 deg\"");
    /// Frequency.
    quantity("frequency", &FREQUENCY).positive().required("\"300 rpm\"");
    /// Angular velocity of the wall about its own axis: at 0 it rocks without turning; at the
    /// frequency of the gyration it turns as a whole about `axis`.
    quantity("spin", &ANGULAR_VELOCITY).or(0.0);
}

/// Sine of the smallest angle between an axis and a direction away from it.
const SMALLEST_SINE: f64 = 1e-6;

/// The types of motion, each with its keys.
const WAYS: [&[&str]; 5] = [
    &["velocity", "angular_velocity"],
    &["displacement", "angular_displacement"],
    &["servo"],
    &["orbit"],
    &["gyration"],
];
const KEYS: [&str; 7] = [
    "velocity",
    "angular_velocity",
    "displacement",
    "angular_displacement",
    "servo",
    "orbit",
    "gyration",
];

pub(super) fn read(wall: &Table<'_>) -> Result<WallMotion> {
    if let (Some(field), None) = (wall.get("phase"), wall.get("frequency")) {
        return Err(field.fault(
            "has no effect without frequency",
            "add frequency = \"4 Hz\"",
        ));
    }
    let mut given = wall.given(&KEYS);
    let Some((first, field)) = given.next() else {
        if let Some(field) = over_time(wall).or_else(|| wall.get("frequency")) {
            let problem = "has no effect without velocity, displacement or servo";
            return Err(field.fault(problem, "remove it"));
        }
        return Ok(WallMotion::Fixed);
    };
    let way = |key: &str| WAYS.iter().position(|keys| keys.contains(&key));
    if let Some((_, second)) = given.find(|(key, _)| way(key) != way(first)) {
        let remedy = "a wall moves at a velocity, by a displacement, as a servo, on an orbit or by a gyration: remove one";
        return Err(second.fault(format!("cannot be combined with {first}"), remedy));
    }
    let is_machine = matches!(first, "orbit" | "gyration");
    if let (Some(field), true) = (wall.get("frequency"), way(first) != Some(1)) {
        let problem = format!("cannot be combined with {first}");
        let remedy = match is_machine {
            true => format!("write it as {first}.frequency"),
            false => "give the amplitude: displacement or angular_displacement".to_owned(),
        };
        return Err(field.fault(problem, remedy));
    }
    if let (Some(field), true) = (over_time(wall), is_machine) {
        let problem = format!("cannot be combined with {first}");
        return Err(field.fault(
            problem,
            "remove it: the motion begins at its full frequency",
        ));
    }
    match first {
        "servo" => servo(&field, factor(wall)?),
        "orbit" => orbit(&field).map(WallMotion::Orbit),
        "gyration" => gyration(&field).map(WallMotion::Gyration),
        "displacement" | "angular_displacement" => Ok(WallMotion::Displacement {
            displacement_m: wall.read("displacement")?,
            angular_displacement_rad: wall.read("angular_displacement")?,
            factor: of_displacement(wall, &field)?,
        }),
        _ => Ok(WallMotion::Velocity {
            velocity_m_s: wall.read("velocity")?,
            spin_rad_s: wall.read("angular_velocity")?,
            factor: factor(wall)?,
        }),
    }
}

/// The factor of the displacement given by `moved`.
fn of_displacement(wall: &Table<'_>, moved: &Field<'_>) -> Result<Factor> {
    let Some(field) = wall.get("frequency") else {
        return factor_from_zero(wall, moved);
    };
    if over_time(wall).is_some() {
        let problem = "cannot be combined with ramp or table";
        return Err(field.fault(problem, "the motion follows one of them: remove the other"));
    }
    Ok(Factor::Oscillation {
        frequency_hz: wall.read("frequency")?,
        phase_rad: wall.read("phase")?,
    })
}

fn orbit(field: &Field<'_>) -> Result<Orbit> {
    let table = Table::of(field, &ORBIT)?;
    let axis = table.read("axis")?;
    Ok(Orbit {
        axis,
        towards: normal_to(axis, &table)?,
        radius_m: table.read("radius")?,
        frequency_hz: table.read("frequency")?,
    })
}

fn gyration(field: &Field<'_>) -> Result<Gyration> {
    let table = Table::of(field, &GYRATION)?;
    let axis = table.read("axis")?;
    Ok(Gyration {
        axis,
        towards: normal_to(axis, &table)?,
        angle_rad: table.read("angle")?,
        frequency_hz: table.read("frequency")?,
        spin_rad_s: table.read("spin")?,
    })
}

/// The part of `towards` normal to the axis, of length 1.
fn normal_to(axis: [f64; 3], table: &Table<'_>) -> Result<[f64; 3]> {
    let towards: [f64; 3] = table.read("towards")?;
    let along: f64 = (0..3).map(|k| axis[k] * towards[k]).sum();
    let normal = [0, 1, 2].map(|k| towards[k] - along * axis[k]);
    let length = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
    if length < SMALLEST_SINE {
        let problem = "is parallel to the axis";
        let remedy = "give a direction away from the axis";
        return Err(table.need("towards")?.fault(problem, remedy));
    }
    Ok(normal.map(|c| c / length))
}

fn servo(field: &Field<'_>, factor: Factor) -> Result<WallMotion> {
    let table = Table::of(field, &SERVO)?;
    Ok(WallMotion::Servo {
        direction: table.read("direction")?,
        force_n: table.read("force")?,
        max_velocity_m_s: table.read("max_velocity")?,
        factor,
    })
}

pub(super) fn list(motion: &WallMotion, listing: &mut Listing) {
    let factor = match motion {
        WallMotion::Fixed => return listing.text("motion", "fixed"),
        WallMotion::Velocity {
            velocity_m_s,
            spin_rad_s,
            factor,
        } => {
            listing.value("velocity", velocity_m_s);
            listing.value("angular_velocity", spin_rad_s);
            factor
        }
        WallMotion::Displacement {
            displacement_m,
            angular_displacement_rad,
            factor,
        } => {
            listing.value("displacement", displacement_m);
            listing.value("angular_displacement", angular_displacement_rad);
            factor
        }
        WallMotion::Servo {
            force_n,
            direction,
            max_velocity_m_s,
            factor,
        } => {
            listing.table("servo", &SERVO, |listing| {
                listing.value("force", force_n);
                listing.value("direction", direction);
                listing.value("max_velocity", max_velocity_m_s);
            });
            factor
        }
        WallMotion::Orbit(orbit) => return list_orbit(orbit, listing),
        WallMotion::Gyration(gyration) => return list_gyration(gyration, listing),
        WallMotion::Bar { factor, .. } => {
            listing.text("motion", "end of a bar");
            factor
        }
        WallMotion::Weight { .. } => return listing.text("motion", "weight"),
    };
    factor::list(factor, listing);
}

fn list_orbit(orbit: &Orbit, listing: &mut Listing) {
    listing.table("orbit", &ORBIT, |listing| {
        listing.value("axis", &orbit.axis);
        listing.value("towards", &orbit.towards);
        listing.value("radius", &orbit.radius_m);
        listing.value("frequency", &orbit.frequency_hz);
    });
}

fn list_gyration(gyration: &Gyration, listing: &mut Listing) {
    listing.table("gyration", &GYRATION, |listing| {
        listing.value("axis", &gyration.axis);
        listing.value("towards", &gyration.towards);
        listing.value("angle", &gyration.angle_rad);
        listing.value("frequency", &gyration.frequency_hz);
        listing.value("spin", &gyration.spin_rad_s);
    });
}
