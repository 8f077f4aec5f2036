//! Which bonds are left and which have broken, from the two dumps of bonds.

use dem_io::Result;

use super::dump::{Dump, Section};
use super::exported::Exported;
use super::files::{BROKEN, DATA, FRAMES};

/// What to do about dumps that contradict each other.
const AGAIN: &str = "run LAMMPS again, or copy all dumps again: those of one run";

/// A bond that broke in LAMMPS.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Break {
    /// Number of the time step.
    pub step: u64,
    /// Number of the bond.
    pub bond: usize,
    /// Middle between its particles, m.
    pub place_m: [f64; 3],
}

/// The bonds that broke until this step, and after that of the frame before, by step. None: the dump
/// ends before. `is_broken`: those that had broken before.
pub(super) fn breaks_until(
    dump: &mut Dump<'_>,
    step: u64,
    before: Option<u64>,
    exported: &Exported,
    is_broken: &[bool],
) -> Result<Option<Vec<Break>>> {
    let Some(section) = section_at(dump, step)? else {
        return Ok(None);
    };
    // fix store/local names its columns by number: time step, ids of the atoms, place.
    let columns = section.find([1, 2, 3, 4, 5, 6].map(|n| format!("f_broken[{n}]")))?;
    let mut breaks: Vec<Break> = Vec::with_capacity(section.rows.len());
    for row in &section.rows {
        let [at, a, b, x, y, z] = columns.map(|column| row[column]);
        let bond = exported.bond_between([a, b], &section)?;
        let is_in_time = at >= 0.0
            && at <= section.step as f64
            && before.is_none_or(|before| at > before as f64);
        if at.fract() != 0.0 || !is_in_time {
            let problem = format!("the bond of the atoms {a} and {b} broke in step {at}");
            return Err(section.refused(problem, AGAIN));
        }
        if is_broken[bond] || breaks.iter().any(|known| known.bond == bond) {
            let problem = format!("the bond of the atoms {a} and {b} breaks twice");
            return Err(section.refused(problem, AGAIN));
        }
        breaks.push(Break {
            step: at as u64,
            bond,
            place_m: [x, y, z],
        });
    }
    breaks.sort_by_key(|one| (one.step, one.bond));
    Ok(Some(breaks))
}

/// Checks that the unbroken bonds at a step are those that have not broken. None: the dump ends
/// before.
pub(super) fn check_unbroken(
    dump: &mut Dump<'_>,
    step: u64,
    exported: &Exported,
    is_broken: &[bool],
) -> Result<Option<()>> {
    let Some(section) = section_at(dump, step)? else {
        return Ok(None);
    };
    let [a, b] = section.find([1, 2].map(|n| format!("c_bonds[{n}]")))?;
    let mut is_there = vec![false; is_broken.len()];
    for row in &section.rows {
        is_there[exported.bond_between([row[a], row[b]], &section)?] = true;
    }
    let Some(bond) = (0..is_broken.len()).find(|at| is_there[*at] == is_broken[*at]) else {
        return Ok(Some(()));
    };
    let [a, b] = exported.atoms_of(bond);
    let problem = match is_there[bond] {
        true => format!("the bond of the atoms {a} and {b} is there, and {BROKEN} has it broken"),
        false => format!(
            "the bond of the atoms {a} and {b}, which {DATA} has, is missing, and {BROKEN} has not that it broke"
        ),
    };
    Err(section.refused(problem, AGAIN))
}

/// The next section, which must be of this step. None: the dump ends before.
fn section_at(dump: &mut Dump<'_>, step: u64) -> Result<Option<Section>> {
    let section = dump.section()?;
    match section {
        Some(section) if section.step != step => {
            Err(section.refused(format!("{FRAMES} has step {step} there"), AGAIN))
        }
        section => Ok(section),
    }
}
