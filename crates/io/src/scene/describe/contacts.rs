//! Contacts, and the tables that say how they are found.

use super::{Lines, number, optional, value};
use crate::scene::{Clusters, Contact, ContactLaw, Relaxation, Rolling, Scene, Search};

impl Lines {
    pub(super) fn contact(&mut self, contact: &Contact) {
        let path = format!("contacts.{}", contact.materials.join("-"));
        match contact.law {
            ContactLaw::HertzMindlin => self.add(format!("{path}.law"), "hertz-mindlin"),
            ContactLaw::Linear {
                normal_n_m,
                tangential_ratio,
            } => {
                self.add(format!("{path}.law"), "linear");
                self.add(format!("{path}.normal_stiffness"), value(normal_n_m, "N/m"));
                self.add(format!("{path}.tangential_ratio"), number(tangential_ratio));
            }
        }
        self.add(format!("{path}.restitution"), number(contact.restitution));
        self.add(format!("{path}.friction"), number(contact.friction));
        let (law, friction, damping) = match contact.rolling {
            Rolling::None => ("none", None, None),
            Rolling::ConstantTorque { friction } => ("constant-torque", Some(friction), None),
            Rolling::SpringDashpot { friction, damping } => {
                ("spring-dashpot", Some(friction), Some(damping))
            }
        };
        self.add(format!("{path}.rolling"), law);
        for (key, of_rolling) in [("rolling_friction", friction), ("rolling_damping", damping)] {
            if let Some(of_rolling) = of_rolling {
                self.add(format!("{path}.{key}"), number(of_rolling));
            }
        }
    }

    /// `[clusters]`, `[relaxation]` and `[search]`: where anything can touch, or where they say
    /// something; `[sleep]` where it is there.
    pub(super) fn about_contacts(&mut self, scene: &Scene) {
        let touches = !scene.contacts.is_empty() || !scene.walls.is_empty();
        let clusters = &scene.clusters;
        if touches || *clusters != Clusters::default() {
            let force_every = match clusters.force_every {
                0 => "never".to_owned(),
                intervals => format!("{intervals} intervals"),
            };
            self.add("clusters.interval", format!("{} steps", clusters.interval));
            self.add("clusters.min_broken", clusters.min_broken.to_string());
            self.add("clusters.force_every", force_every);
        }
        let relaxation = &scene.relaxation;
        if touches || *relaxation != Relaxation::default() {
            self.add("relaxation.enabled", relaxation.enabled.to_string());
            self.add("relaxation.min_overlap", number(relaxation.min_overlap));
        }
        if touches || scene.search != Search::default() {
            let skin = optional(scene.search.skin, "", "chosen by the program");
            self.add("search.skin", skin);
        }
        if let Some(sleep) = &scene.sleep {
            self.add("sleep.speed", value(sleep.speed_m_s, "m/s"));
            self.add("sleep.after", value(sleep.after_s, "s"));
        }
    }
}
