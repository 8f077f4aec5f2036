//! Beams of concrete, bars and discs of alumina beside what was measured.

use super::rows::{Pick, Row, picked};
use crate::bench::Failed;
use crate::concrete::PAGE;

const BEAM: [&str; 2] = ["mixed mode, predicted", "mixed mode, measured"];
const BARS: [&str; 2] = ["bonds found on them", "measured"];
const BEAM_SOURCE: &str = "Garcia-Alvarez et al. 2012, measured band";
const BAR_SOURCE: &str = "Farsi et al. 2017, measured";

const fn of(
    case: &'static str,
    source: &'static str,
    section: &'static str,
    [row, theirs]: [&'static str; 2],
    column: &'static str,
) -> Pick {
    Pick {
        case,
        source,
        page: PAGE,
        section,
        row,
        ours: column,
        theirs: [theirs, column],
        time: "",
    }
}

const CASES: [Pick; 8] = [
    of(
        "mixed-mode beam of concrete, bonds found on another beam: largest load, N",
        BEAM_SOURCE,
        "Concrete",
        BEAM,
        "largest load, N",
    ),
    of(
        "the same: load at an opening of 50 um, N",
        BEAM_SOURCE,
        "Concrete",
        BEAM,
        "at 50 um",
    ),
    of(
        "the same: load at an opening of 100 um, N",
        BEAM_SOURCE,
        "Concrete",
        BEAM,
        "at 100 um",
    ),
    of(
        "the same: work on the opening up to 100 um, mJ",
        BEAM_SOURCE,
        "Concrete",
        BEAM,
        "work up to 100 um, mJ",
    ),
    of(
        "bars of porous alumina, bonds found on their force and modulus: deflection at failure, um",
        BAR_SOURCE,
        "Bars of alumina",
        BARS,
        "deflection at failure, um",
    ),
    of(
        "the same: modulus in tension, GPa",
        "Farsi et al. 2017, by ultrasound",
        "Bars of alumina",
        BARS,
        "modulus in tension, packing 1, GPa",
    ),
    of(
        "disc of porous alumina, bonds of the bars times modulus and strength of both: load, kN",
        "Farsi et al. 2016, from the measured strength",
        "Discs of alumina",
        ["solid, bonds of the bars times", "solid, measured"],
        "largest load, kN",
    ),
    of(
        "disc with four holes: load between them over load through two",
        "Farsi et al. 2016, simulated",
        "Discs of alumina",
        ["here", "simulated by Farsi"],
        "strong over weak",
    ),
];

pub(super) fn rows() -> Result<Vec<Row>, Failed> {
    CASES.iter().map(picked).collect()
}
