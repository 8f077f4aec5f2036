//! How a wall moves: at a velocity, by a displacement, or as a servo.

use crate::diagnostic::Result;
use crate::scene::factor::{self, Factor, factor, factor_from_zero, over_time};
use crate::scene::field::Field;
use crate::scene::listing::Listing;
use crate::scene::schema::{Key, Kind, Schema};
use crate::scene::table::Table;
use crate::units::{FORCE, VELOCITY};
use serde::Serialize;

/// How a wall moves.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub enum WallMotion {
    /// Not at all.
    #[default]
    Fixed,
    /// `velocity` and `angular_velocity`, with `ramp` or `table`.
    Velocity {
        /// Of the pivot, m/s. Length 3.
        velocity_m_s: [f64; 3],
        /// About the pivot, which moves along, rad/s. Length 3.
        spin_rad_s: [f64; 3],
        /// On both, over time.
        factor: Factor,
    },
    /// `displacement` and `turn`, with `ramp` or `table`.
    Displacement {
        /// Of the pivot, m. Length 3.
        displacement_m: [f64; 3],
        /// About the pivot, which moves along: `turn = { axis, angle }` as a rotation vector, rad.
        /// Length 3.
        turn_rad: [f64; 3],
        /// On both, over time.
        factor: Factor,
    },
    /// `servo = { force, direction, velocity }`, with `ramp` or `table`: moves along `direction`
    /// such that it pushes as wanted.
    Servo {
        /// `force`: what it is to push with along `direction`, N; below 0 against it.
        force_n: f64,
        /// `direction`, of length 1. Length 3.
        direction: [f64; 3],
        /// `velocity`: its largest, m/s; more than 0.
        largest_velocity_m_s: f64,
        /// On the force, over time.
        factor: Factor,
    },
}

pub(super) static SERVO: Schema = Schema {
    title: "Servo",
    doc: "A wall that moves along a direction such that it pushes as wanted.",
    keys: &[
        Key::quantity(
            "force",
            &FORCE,
            "What it is to push with along `direction`; below 0 against it.",
        )
        .required("\"100 N\""),
        Key::new(
            "direction",
            Kind::Direction("a direction"),
            "Along which it moves; its length does not matter.",
        )
        .required("[0, 0, -1]"),
        Key::quantity("velocity", &VELOCITY, "It is no faster than this.")
            .positive()
            .required("\"10 mm/s\", its largest"),
    ],
};

/// The ways to move, each with its keys.
const WAYS: [&[&str]; 3] = [
    &["velocity", "angular_velocity"],
    &["displacement", "turn"],
    &["servo"],
];
const KEYS: [&str; 5] = [
    "velocity",
    "angular_velocity",
    "displacement",
    "turn",
    "servo",
];

pub(super) fn read(wall: &Table<'_>) -> Result<WallMotion> {
    let mut given = wall.given(&KEYS);
    let Some((first, field)) = given.next() else {
        if let Some(field) = over_time(wall) {
            let problem = format!(
                "{} stands without velocity, displacement or servo, on which it acts",
                field.path
            );
            return Err(field.refuse(problem, "remove it"));
        }
        return Ok(WallMotion::Fixed);
    };
    let way = |key: &str| WAYS.iter().position(|keys| keys.contains(&key));
    if let Some((_, second)) = given.find(|(key, _)| way(key) != way(first)) {
        let problem = format!("{} stands beside {first}", second.path);
        let remedy = "a wall moves at a velocity, by a displacement or as a servo: remove one";
        return Err(second.refuse(problem, remedy));
    }
    match first {
        "servo" => servo(&field, factor(wall)?),
        "displacement" | "turn" => Ok(WallMotion::Displacement {
            displacement_m: wall.read("displacement")?,
            turn_rad: wall.read("turn")?,
            factor: factor_from_zero(wall, &field)?,
        }),
        _ => Ok(WallMotion::Velocity {
            velocity_m_s: wall.read("velocity")?,
            spin_rad_s: wall.read("angular_velocity")?,
            factor: factor(wall)?,
        }),
    }
}

fn servo(field: &Field<'_>, factor: Factor) -> Result<WallMotion> {
    let table = Table::of(field, &SERVO)?;
    Ok(WallMotion::Servo {
        direction: table.read("direction")?,
        force_n: table.read("force")?,
        largest_velocity_m_s: table.read("velocity")?,
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
            turn_rad,
            factor,
        } => {
            listing.value("displacement", displacement_m);
            listing.value("turn", turn_rad);
            factor
        }
        WallMotion::Servo {
            force_n,
            direction,
            largest_velocity_m_s,
            factor,
        } => {
            listing.table("servo", &SERVO, |listing| {
                listing.value("force", force_n);
                listing.value("direction", direction);
                listing.value("velocity", largest_velocity_m_s);
            });
            factor
        }
    };
    factor::list(factor, listing);
}
