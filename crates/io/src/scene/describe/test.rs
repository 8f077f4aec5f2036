//! `[test]`

use super::{Lines, number, optional, value, vector};
use crate::scene::Test;

impl Lines {
    pub(super) fn test(&mut self, test: &Test) {
        self.add("test.kind", test.kind.name());
        self.add("test.body", test.body.clone());
        self.add("test.moves", test.moves.join(", "));
        self.add("test.direction", vector(test.direction, ""));
        self.add("test.stroke", value(test.stroke_m, "m"));
        self.add("test.rate", optional(test.rate_m_s, "m/s", "auto"));
        self.add("test.periods", number(test.periods));
        self.add("test.rate_check", test.rate_check.to_string());
        for (key, given, unit, otherwise) in [
            ("young_modulus", test.young_modulus_pa, "Pa", "none"),
            ("poisson_ratio", Some(test.poisson_ratio), "", ""),
            ("strength", test.strength_pa, "Pa", "none"),
        ] {
            self.add(format!("test.{key}"), optional(given, unit, otherwise));
        }
        for (key, given, unit) in [
            ("span", test.span_m, "m"),
            ("load_distance", test.load_distance_m, "m"),
            ("width", test.width_m, "m"),
            ("height", test.height_m, "m"),
            ("length", test.length_m, "m"),
            ("area", test.area_m2, "m2"),
        ] {
            if test.kind.dimensions().contains(&key) {
                let measured = "measured on walls and body";
                self.add(format!("test.{key}"), optional(given, unit, measured));
            }
        }
    }
}
