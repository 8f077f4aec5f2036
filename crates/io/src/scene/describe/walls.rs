//! Walls.

use super::{Lines, number, value, vector};
use crate::scene::{Wall, WallMotion, WallShape};

impl Lines {
    pub(super) fn wall(&mut self, path: &str, wall: &Wall) {
        self.shape(path, &wall.shape);
        self.add(format!("{path}.material"), wall.material.clone());
        for (key, components, unit) in [
            ("pivot", wall.pivot_m, "m"),
            ("rotation", wall.rotation_rad, "rad"),
        ] {
            self.add(format!("{path}.{key}"), vector(components, unit));
        }
        self.add(format!("{path}.tilt"), value(wall.tilt_rad, "rad"));
        self.add(
            format!("{path}.surface_velocity"),
            vector(wall.surface_velocity_m_s, "m/s"),
        );
        self.motion(path, &wall.motion);
    }

    fn shape(&mut self, path: &str, shape: &WallShape) {
        match shape {
            WallShape::Plane { point_m, normal } => {
                self.add(format!("{path}.plane.point"), vector(*point_m, "m"));
                self.add(format!("{path}.plane.normal"), vector(*normal, ""));
            }
            WallShape::Box { min, max } => {
                self.add(format!("{path}.box.min"), vector(*min, "m"));
                self.add(format!("{path}.box.max"), vector(*max, "m"));
            }
            WallShape::Cylinder {
                from_m,
                to_m,
                radius_m,
            } => {
                self.add(format!("{path}.cylinder.from"), vector(*from_m, "m"));
                self.add(format!("{path}.cylinder.to"), vector(*to_m, "m"));
                self.add(format!("{path}.cylinder.radius"), value(*radius_m, "m"));
            }
            WallShape::Stl {
                path: file,
                unit_m,
                scale,
            } => {
                self.add(format!("{path}.stl"), file.display().to_string());
                self.add(format!("{path}.unit"), value(*unit_m, "m"));
                self.add(format!("{path}.scale"), number(*scale));
            }
        }
    }

    fn motion(&mut self, path: &str, motion: &WallMotion) {
        match motion {
            WallMotion::Fixed => self.add(format!("{path}.motion"), "fixed"),
            WallMotion::Velocity {
                velocity_m_s,
                spin_rad_s,
                factor,
            } => {
                let spin = vector(*spin_rad_s, "rad/s");
                self.add(format!("{path}.velocity"), vector(*velocity_m_s, "m/s"));
                self.add(format!("{path}.angular_velocity"), spin);
                self.factor(path, factor);
            }
            WallMotion::Displacement {
                displacement_m,
                turn_rad,
                factor,
            } => {
                let displacement = vector(*displacement_m, "m");
                self.add(format!("{path}.displacement"), displacement);
                self.add(format!("{path}.turn"), vector(*turn_rad, "rad"));
                self.factor(path, factor);
            }
            WallMotion::Servo {
                force_n,
                direction,
                largest_velocity_m_s,
                factor,
            } => {
                let velocity = value(*largest_velocity_m_s, "m/s");
                self.add(format!("{path}.servo.force"), value(*force_n, "N"));
                self.add(format!("{path}.servo.direction"), vector(*direction, ""));
                self.add(format!("{path}.servo.velocity"), velocity);
                self.factor(path, factor);
            }
        }
    }
}
