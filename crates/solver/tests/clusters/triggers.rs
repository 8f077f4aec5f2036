//! When clusters are searched.

use dem_run::state::clusters::Triggers;

/// Steps from 1 to 400 with a search, if one bond breaks at each of these steps.
fn searches(triggers: Triggers, breaks: &[u64]) -> Vec<u64> {
    let mut broken = 0;
    let mut found = Vec::new();
    for step in 1..=400 {
        broken += breaks.iter().filter(|b| **b == step).count() as u64;
        if triggers.due(step, broken) {
            found.push(step);
            broken = 0;
        }
    }
    found
}

const BREAKS: [u64; 6] = [3, 3, 7, 60, 170, 390];

#[test]
fn the_four_triggers_of_platzer() {
    assert_eq!(
        searches(Triggers::every_step(), &BREAKS),
        [3, 7, 60, 170, 390]
    );
    assert_eq!(searches(Triggers::after_more_than(2), &BREAKS), [7, 390]);
    assert_eq!(
        searches(Triggers::at_interval(50), &BREAKS),
        [50, 100, 200, 400]
    );
    assert_eq!(searches(Triggers::combined(50, 1, 0), &BREAKS), [50, 200]);
    assert_eq!(
        searches(Triggers::combined(50, 1, 3), &BREAKS),
        [50, 150, 300]
    );
    assert_eq!(
        searches(Triggers::default(), &BREAKS),
        searches(Triggers::at_interval(50), &BREAKS)
    );
}

#[test]
fn nothing_broken_is_nothing_to_search_for() {
    for triggers in [Triggers::every_step(), Triggers::combined(1, 0, 1)] {
        assert!(searches(triggers, &[]).is_empty());
    }
    // An interval of 0 counts as 1, and a threshold of no bonds is ignored.
    let odd = Triggers {
        interval: 0,
        min_broken: 0,
        force_every: 0,
    };
    assert_eq!(searches(odd, &[5]), [5]);
}
