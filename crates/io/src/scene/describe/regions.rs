//! Regions, and clumps, inlets and outlets, which they are for.

use super::{Lines, number, optional, value, vector, word};
use crate::scene::clump::MASSES;
use crate::scene::inlet::ORIENTATIONS;
use crate::scene::replacement::NEEDS;
use crate::scene::{FeedRate, Inlet, Outlet, Region, Replacement, StartAs};

impl Lines {
    pub(super) fn start_as(&mut self, path: &str, start_as: StartAs) {
        match start_as {
            StartAs::Bonded => self.add(format!("{path}.start_as"), "bonded"),
            StartAs::Clump(clump) => {
                self.add(format!("{path}.start_as"), "clump");
                self.add(format!("{path}.clump.scale"), number(clump.scale));
                self.add(format!("{path}.clump.mass"), word(&MASSES, clump.mass));
            }
        }
    }

    pub(super) fn region(&mut self, path: &str, region: &Region) {
        match region {
            Region::Box { min_m, max_m } => {
                self.add(format!("{path}.box.min"), vector(*min_m, "m"));
                self.add(format!("{path}.box.max"), vector(*max_m, "m"));
            }
            Region::Sphere { centre_m, radius_m } => {
                self.add(format!("{path}.sphere.centre"), vector(*centre_m, "m"));
                self.add(format!("{path}.sphere.radius"), value(*radius_m, "m"));
            }
            Region::Cylinder {
                from_m,
                to_m,
                radius_m,
            } => {
                self.add(format!("{path}.cylinder.from"), vector(*from_m, "m"));
                self.add(format!("{path}.cylinder.to"), vector(*to_m, "m"));
                self.add(format!("{path}.cylinder.radius"), value(*radius_m, "m"));
            }
            Region::Stl { file, unit_m } => {
                self.add(format!("{path}.stl"), file.display().to_string());
                self.add(format!("{path}.unit"), value(*unit_m, "m"));
            }
        }
    }

    pub(super) fn replacement(&mut self, path: &str, replacement: &Replacement) {
        let enters = replacement.enters.as_deref().unwrap_or("not asked");
        self.add(format!("{path}.when.enters"), enters);
        for (key, limit, unit) in [
            ("force", replacement.force_n, "N"),
            ("impact_energy", replacement.impact_energy_j, "J"),
            ("time", replacement.time_s, "s"),
        ] {
            self.add(
                format!("{path}.when.{key}"),
                optional(limit, unit, "not asked"),
            );
        }
        self.add(format!("{path}.need"), word(&NEEDS, replacement.needs_all));
        let Some(back) = &replacement.back else {
            self.add(format!("{path}.back"), "never");
            return;
        };
        self.add(format!("{path}.back.leaves"), back.leaves.clone());
        self.add(
            format!("{path}.back.min_particles"),
            back.min_particles.to_string(),
        );
        self.add(
            format!("{path}.back.strain_energy"),
            value(back.strain_energy_j_kg, "J/kg"),
        );
        self.add(
            format!("{path}.back.inner_speed"),
            value(back.inner_speed_m_s, "m/s"),
        );
    }

    pub(super) fn inlet(&mut self, path: &str, inlet: &Inlet) {
        let shares = inlet.bodies.iter();
        let listed: Vec<String> = shares
            .map(|(body, share)| format!("{body}: {}", number(*share)))
            .collect();
        self.add(format!("{path}.bodies"), listed.join(", "));
        self.add(format!("{path}.region"), inlet.region.clone());
        match inlet.rate {
            FeedRate::Number(rate) => self.add(format!("{path}.rate"), value(rate, "1/s")),
            FeedRate::Mass(rate) => self.add(format!("{path}.mass_rate"), value(rate, "kg/s")),
        }
        for (key, components, unit) in [
            ("velocity", inlet.velocity_m_s, "m/s"),
            ("angular_velocity", inlet.angular_velocity_rad_s, "rad/s"),
        ] {
            self.add(format!("{path}.{key}"), vector(components, unit));
        }
        let orientation = word(&ORIENTATIONS, inlet.random_orientation);
        self.add(format!("{path}.orientation"), orientation);
        self.add(format!("{path}.start"), value(inlet.start_s, "s"));
        let end = Some(inlet.end_s).filter(|end| end.is_finite());
        self.add(format!("{path}.end"), optional(end, "s", "never"));
        let count = inlet.count.map(|count| count.to_string());
        self.add(
            format!("{path}.count"),
            count.unwrap_or_else(|| "no limit".to_owned()),
        );
    }

    pub(super) fn outlet(&mut self, path: &str, outlet: &Outlet) {
        let side = if outlet.removes_outside {
            "outside"
        } else {
            "inside"
        };
        self.add(format!("{path}.{side}"), outlet.region.clone());
    }
}
