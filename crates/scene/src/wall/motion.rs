//! The motion of a wall: at a velocity, by a displacement, or as a servo.

use crate::factor::{self, Factor, factor, factor_from_zero, over_time};
use crate::field::Field;
use crate::listing::Listing;
use crate::schema::{Kind, table_schema};
use crate::table::Table;
use dem_io::diagnostic::Result;
use dem_io::units::{FORCE, VELOCITY};
use serde::Serialize;

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

/// The types of motion, each with its keys.
const WAYS: [&[&str]; 3] = [
    &["velocity", "angular_velocity"],
    &["displacement", "angular_displacement"],
    &["servo"],
];
const KEYS: [&str; 5] = [
    "velocity",
    "angular_velocity",
    "displacement",
    "angular_displacement",
    "servo",
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
        let remedy = "a wall moves at a velocity, by a displacement or as a servo: remove one";
        return Err(second.fault(format!("cannot be combined with {first}"), remedy));
    }
    if let (Some(field), true) = (wall.get("frequency"), way(first) != Some(1)) {
        let problem = format!("cannot be combined with {first}");
        return Err(field.fault(
            problem,
            "give the amplitude: displacement or angular_displacement",
        ));
    }
    match first {
        "servo" => servo(&field, factor(wall)?),
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
        WallMotion::Bar { factor, .. } => {
            listing.text("motion", "end of a bar");
            factor
        }
        WallMotion::Weight { .. } => return listing.text("motion", "weight"),
    };
    factor::list(factor, listing);
}
