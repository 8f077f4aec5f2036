//! Bonds that harden: their loadings.

use super::forces::any_bond;
use crate::stages::stage::{Need, Stage};
use crate::state::State;

/// Bonds whose strengths rise with each loading.
pub(crate) const HARDENING: Stage = Stage {
    bytes: |state| size_of_val(&state.bonds.histories.loadings[..]),
    ..Stage::new("hardening of bonds", |state, _| {
        Need::of(
            any_bond(state, |rule| rule.law.hardening().is_some()),
            || "strengths of bonds rise with each loading".to_owned(),
            "no bond hardens",
        )
    })
};

/// Counts the loadings of bonds, and raises their strengths. Returns the number of bonds that
/// harden.
pub(crate) fn harden_bonds(state: &mut State) -> usize {
    let (bonds, poses) = (&mut state.bonds, &state.particles.poses);
    let mut hardening = 0;
    for at in 0..bonds.histories.loadings.len() {
        let law = bonds.rules[bonds.rule_of(at)].law.hardening();
        let Some(law) = law.filter(|_| !bonds.is_broken(at)) else {
            continue;
        };
        hardening += 1;
        let strain = bonds.stretch_m(at, poses) / bonds.initial_length_m(at);
        let mut now = bonds.histories.loadings[at].at_strain(strain);
        if now.count > now.applied {
            let rise = law.factor(now.count) / law.factor(now.applied);
            bonds.set_strength_factor(at, rise * bonds.strength_factor(at));
            now.applied = now.count;
        }
        bonds.histories.loadings[at] = now;
    }
    hardening
}
