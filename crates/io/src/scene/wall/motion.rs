//! How a wall moves: at a velocity, by a displacement, or as a servo.

use crate::Result;
use crate::scene::direction::{direction, rotation};
use crate::scene::field::Field;
use crate::scene::load::{factor, factor_from_zero, over_time};
use crate::scene::table::Table;
use crate::scene::{Factor, WallMotion};
use crate::units::{ANGULAR_VELOCITY, FORCE, LENGTH, VELOCITY};

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
            displacement_m: wall
                .read("displacement", |field| field.vector(&LENGTH))?
                .unwrap_or_default(),
            turn_rad: wall
                .read("turn", |field| rotation(&field))?
                .unwrap_or_default(),
            factor: factor_from_zero(wall, &field)?,
        }),
        _ => Ok(WallMotion::Velocity {
            velocity_m_s: wall
                .read("velocity", |field| field.vector(&VELOCITY))?
                .unwrap_or_default(),
            spin_rad_s: wall
                .read("angular_velocity", |field| field.vector(&ANGULAR_VELOCITY))?
                .unwrap_or_default(),
            factor: factor(wall)?,
        }),
    }
}

fn servo(field: &Field<'_>, factor: Factor) -> Result<WallMotion> {
    let table = field.table(&["force", "direction", "velocity"])?;
    let along = table.need("direction", "[0, 0, -1]")?;
    Ok(WallMotion::Servo {
        force_n: table.need("force", "\"100 N\"")?.quantity(&FORCE)?,
        direction: direction(&along, "a direction")?,
        largest_velocity_m_s: table
            .need("velocity", "\"10 mm/s\", its largest")?
            .positive(&VELOCITY)?,
        factor,
    })
}
