//! The cases of the suite: their extreme feature, and their members.

use std::sync::atomic::AtomicBool;

use dem_io::{Diagnostic, Result};

use super::prediction::Member;
use super::{
    adhesion, bars, beside, breakage, bridges, daughters, families, friction, impact, joints,
    limit_map, long, softening, swap, yielding, zones,
};

/// A case of the suite.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Its name on the command line.
    pub name: &'static str,
    /// Its extreme feature, a sentence.
    pub extreme: &'static str,
    members: fn(&AtomicBool) -> Result<Vec<Member>>,
}

impl Case {
    /// Its members with their predictions, from closed forms and from plans; if one run is
    /// predicted from another, that other is run.
    pub fn members(&self, interrupted: &AtomicBool) -> Result<Vec<Member>> {
        (self.members)(interrupted)
    }
}

/// All cases.
pub const CASES: [Case; 26] = [
    Case {
        name: "stiffness-ratio",
        extreme: "neighbouring bonds whose stiffnesses differ by 100 to 1e6",
        members: |_| families::stiffness_ratios(),
    },
    Case {
        name: "mass-ratio",
        extreme: "bonded and colliding spheres whose masses differ by 1e3 to 1e6",
        members: |_| families::mass_ratios(),
    },
    Case {
        name: "damping",
        extreme: "bonds damped by nothing to ten times the critical damping",
        members: |_| limit_map::map(),
    },
    Case {
        name: "step",
        extreme: "a time step of 0.98 and of 1.02 of the limit",
        members: |_| limit_map::beside_the_limit(),
    },
    Case {
        name: "overlap",
        extreme: "spheres that overlap by up to 0.9 when all bonds fail",
        members: |_| breakage::overlaps(),
    },
    Case {
        name: "shatter",
        extreme: "more than 1e5 bonds that fail in one step",
        members: |_| breakage::shatter(),
    },
    Case {
        name: "softening",
        extreme: "bonds that break at 1.5 to 1e4 times the opening at their strength",
        members: |_| Ok(softening::softening()),
    },
    Case {
        name: "yielding",
        extreme: "bonds that flow under up to 1e4 times the energy at which they yield",
        members: |_| Ok(yielding::yielding()),
    },
    Case {
        name: "beside",
        extreme: "contacts beside bonds, up to a million times softer or harder than these",
        members: |_| Ok(beside::beside()),
    },
    Case {
        name: "friction",
        extreme: "bonds sheared under 0.01 to 100 times their cohesion, and their friction after the break",
        members: |_| Ok(friction::friction()),
    },
    Case {
        name: "joints",
        extreme: "flat joints of 3 to 2500 elements that fail, rub, open and close",
        members: |_| Ok(joints::joints()),
    },
    Case {
        name: "swap",
        extreme: "clumps replaced and restored while plates squeeze them",
        members: swap::swaps,
    },
    Case {
        name: "daughters",
        extreme: "spheres that daughters replace while plates squeeze them",
        members: |_| Ok(daughters::daughters()),
    },
    Case {
        name: "zones",
        extreme: "rigid parts that a fast zone, a hard or soft border, or a load takes apart",
        members: |_| zones::zones(),
    },
    Case {
        name: "one-particle",
        extreme: "clusters and clumps of one particle",
        members: |_| breakage::one_particle(),
    },
    Case {
        name: "spin",
        extreme: "a spin of 1e4 rad/s for 1e6 steps",
        members: |_| long::spin(),
    },
    Case {
        name: "impact",
        extreme: "impacts at 300 m/s, on what is hard and on what is soft",
        members: |_| Ok(impact::impacts()),
    },
    Case {
        name: "adhesion",
        extreme: "spheres of 1e-6 m to 1e-2 m that adhesion holds on a wall",
        members: |_| Ok(adhesion::grains()),
    },
    Case {
        name: "bridges",
        extreme: "spheres of 1e-4 m to 1e-2 m that liquid holds on a wall or lets go",
        members: |_| Ok(bridges::drops()),
    },
    Case {
        name: "bars",
        extreme: "a row between bars of 1e-6 to 1e6 times its impedance",
        members: |_| Ok(bars::bars()),
    },
    Case {
        name: "mesh-wall",
        extreme: "a sphere faster than its radius per step against a sheet of triangles",
        members: |_| Ok(impact::at_mesh()),
    },
    Case {
        name: "coordinates",
        extreme: "1e6 m from the origin",
        members: |_| families::coordinates(),
    },
    Case {
        name: "size",
        extreme: "particles of 1e-6 m to 1e3 m",
        members: |_| families::sizes(),
    },
    Case {
        name: "modulus",
        extreme: "Young's modulus of 1 kPa to 1 TPa",
        members: |_| families::moduli(),
    },
    Case {
        name: "short-bonds",
        extreme: "bonds down to a billionth of a radius long",
        members: |_| families::short_bonds(),
    },
    Case {
        name: "rest",
        extreme: "a day at rest",
        members: long::rest,
    },
];

/// The cases with these names, in the order of the suite; all if no names are given. Refuses an
/// unknown name.
pub fn chosen(names: &[String]) -> Result<Vec<Case>> {
    if let Some(unknown) = names
        .iter()
        .find(|name| CASES.iter().all(|case| case.name != **name))
    {
        let known: Vec<&str> = CASES.iter().map(|case| case.name).collect();
        return Err(Diagnostic::input(
            "dem-run stress",
            format!("there is no case '{unknown}'"),
            format!("take some of {}; none means all", known.join(", ")),
        ));
    }
    let is_chosen = |case: &&Case| names.is_empty() || names.iter().any(|name| name == case.name);
    Ok(CASES.iter().filter(is_chosen).copied().collect())
}
