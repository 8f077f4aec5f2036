//! A trial of the beginning of a scene whose bodies come, go or are replaced: the run time that
//! follows from it, and for how long bodies are bonded before they touch anything.

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use dem_engine::clock::StageClock;
use dem_engine::state::State;
use dem_engine::state::events::PopulationEvent;
use dem_engine::step::step;
use dem_io::units::significant;
use dem_plan::Plan;

/// Time for a trial, s.
const TRIAL_S: f64 = 5.0;
/// Time between two samples, s.
const SAMPLE_S: f64 = 0.05;
/// Largest growth of the number of bodies over the last half of a trial of a steady flow.
const STEADY: f64 = 1.2;
/// Shortest time for which a body is bonded before a touch that is worth a note, s.
const WORTH_A_NOTE_S: f64 = 1e-3;

/// The state of a trial at a moment.
#[derive(Debug, Clone, Copy)]
struct Sample {
    time_s: f64,
    /// Run time so far, s.
    spent_s: f64,
    /// Bodies and pieces in the scene.
    inside: f64,
    /// Bodies and pieces that have left.
    left: u32,
}

/// What a trial has shown.
pub(super) struct FlowTrial {
    /// Shortest and longest run time to expect, s.
    pub(super) range_s: [f64; 2],
    /// Mean time of a step, s.
    pub(super) per_step_s: f64,
    pub(super) clock: StageClock,
    /// For each body the longest time, s, for which it was bonded before it touched anything that
    /// it had not touched before.
    bonded_early_s: BTreeMap<String, f64>,
}

impl FlowTrial {
    /// Steps a copy of the state until `end_s` or the end of the trial. If the step is adaptive, it
    /// is that of bonded bodies from the first replacement on.
    pub(super) fn of(plan: &Plan, end_s: f64) -> Self {
        let mut copy = plan.state.clone();
        let mut waiting = Waiting::default();
        let clock = Instant::now();
        let mut following = Duration::ZERO;
        let mut samples = vec![sample(&copy, 0.0)];
        while copy.time_s < end_s && clock.elapsed().as_secs_f64() < TRIAL_S {
            step(&mut copy);
            if waiting.has_work(&copy) {
                let began = Instant::now();
                waiting.follow(&copy);
                following += began.elapsed();
                copy.time_step_s = copy.time_step_s.min(plan.step.replaced.step_s);
            }
            let spent_s = clock.elapsed().saturating_sub(following).as_secs_f64();
            if spent_s >= samples[samples.len() - 1].spent_s + SAMPLE_S {
                samples.push(sample(&copy, spent_s));
            }
        }
        let spent_s = clock.elapsed().saturating_sub(following).as_secs_f64();
        samples.push(sample(&copy, spent_s));
        Self {
            range_s: run_time_s(&samples, end_s),
            per_step_s: spent_s / (copy.steps - plan.state.steps).max(1) as f64,
            clock: copy.scratch.clock,
            bonded_early_s: waiting.longest_s,
        }
    }

    /// Bodies that are bonded before they can break, a sentence each.
    pub(super) fn notes(&self) -> impl Iterator<Item = String> {
        let worth_it = |&(_, &s): &(&String, &f64)| s > WORTH_A_NOTE_S;
        self.bonded_early_s.iter().filter(worth_it).map(|(body, s)| {
            format!(
                "'{body}' is bonded for {} ms before it touches anything: a trigger by touch, replacement.{body}.when.touches, starts with the touch",
                significant(1e3 * s, 2)
            )
        })
    }
}

fn sample(state: &State, spent_s: f64) -> Sample {
    let clusters = state.clusters.as_ref();
    let outlets = state.population.outlets.iter();
    Sample {
        time_s: state.time_s,
        spent_s,
        inside: clusters.map_or(0.0, |clusters| clusters.living().count() as f64),
        left: outlets.map(|outlet| outlet.bodies).sum(),
    }
}

/// Shortest and longest run time until `end_s`, from the last half of the trial: as if the number of
/// bodies stayed, and as if it grew on.
fn run_time_s(samples: &[Sample], end_s: f64) -> [f64; 2] {
    let [Some(first), Some(last)] = [samples.first(), samples.last()] else {
        return [f64::NAN; 2];
    };
    let rest_s = end_s - last.time_s;
    if rest_s <= 0.0 {
        return [last.spent_s; 2];
    }
    let half_s = 0.5 * (first.time_s + last.time_s);
    let half = samples.iter().find(|sample| sample.time_s >= half_s);
    let half = half.filter(|half| half.time_s < last.time_s);
    let half = half.unwrap_or(first);
    let for_s = last.time_s - half.time_s;
    let per_s = (last.spent_s - half.spent_s) / for_s;
    let least_s = last.spent_s + rest_s * per_s;
    let leave = last.left > half.left;
    if leave && last.inside <= STEADY * half.inside {
        return [least_s; 2];
    }
    let growth_1_s = (last.inside - half.inside).max(0.0) / (last.inside.max(1.0) * for_s);
    [
        least_s,
        least_s + 0.5 * rest_s * rest_s * per_s * growth_1_s,
    ]
}

/// Bodies that have become bonded and have not touched anything new since.
#[derive(Default)]
struct Waiting {
    /// By their clusters.
    bodies: BTreeMap<u32, Bonded>,
    longest_s: BTreeMap<String, f64>,
}

/// A body that has become bonded.
struct Bonded {
    name: String,
    since_s: f64,
    /// What it touched then.
    touched: BTreeSet<Other>,
}

/// What a body can touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Other {
    /// By its number.
    Wall(usize),
    /// By the number of its cluster.
    Body(u32),
}

impl Waiting {
    /// Whether bodies wait, or have become bonded or rigid in this step.
    fn has_work(&self, state: &State) -> bool {
        !self.bodies.is_empty() || !state.scratch.events.population.is_empty()
    }

    fn follow(&mut self, state: &State) {
        let Some(clusters) = &state.clusters else {
            return;
        };
        let mut begun = BTreeMap::new();
        for event in &state.scratch.events.population {
            match event {
                PopulationEvent::Restored { cluster, .. } => {
                    self.bodies.remove(cluster);
                }
                PopulationEvent::Replaced {
                    cluster,
                    body,
                    cause: "enters" | "time",
                    ..
                } => {
                    begun.insert(*cluster, body.clone());
                }
                _ => {}
            }
        }
        let ids = self.bodies.keys().chain(begun.keys()).copied().collect();
        let mut touched = touched_by(state, &clusters.of_particle, &ids);
        let longest_s = &mut self.longest_s;
        self.bodies.retain(|cluster, bonded| {
            let now = touched.remove(cluster).unwrap_or_default();
            let is_intact = clusters.history[*cluster as usize].ended_s.is_none();
            let waits = is_intact && now.is_subset(&bonded.touched);
            if !waits {
                let longest_s = longest_s.entry(bonded.name.clone()).or_default();
                *longest_s = longest_s.max(state.time_s - bonded.since_s);
            }
            waits
        });
        for (cluster, name) in begun {
            let bonded = Bonded {
                name,
                since_s: state.time_s,
                touched: touched.remove(&cluster).unwrap_or_default(),
            };
            self.bodies.insert(cluster, bonded);
        }
    }
}

/// What each of some clusters touches. `of_particle`: the cluster of each particle.
fn touched_by(
    state: &State,
    of_particle: &[u32],
    ids: &BTreeSet<u32>,
) -> BTreeMap<u32, BTreeSet<Other>> {
    let mut touched: BTreeMap<u32, BTreeSet<Other>> = BTreeMap::new();
    let mut note = |cluster: u32, other: Other| {
        if ids.contains(&cluster) {
            touched.entry(cluster).or_default().insert(other);
        }
    };
    for (number, wall) in state.walls.iter().enumerate() {
        let touching = wall.touching.iter();
        for touch in touching.filter(|touch| touch.history.overlap_m() > 0.0) {
            note(of_particle[touch.particle as usize], Other::Wall(number));
        }
    }
    if let Some(contacts) = &state.contacts {
        let touching = contacts.pairs.iter().zip(&contacts.histories);
        for (pair, _) in touching.filter(|(_, history)| history.overlap_m() > 0.0) {
            let [a, b] = pair.map(|particle| of_particle[particle as usize]);
            if a != b {
                note(a, Other::Body(b));
                note(b, Other::Body(a));
            }
        }
    }
    touched
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of a flow at these times with these numbers inside and left, of which a body costs
    /// 0.1 s per second.
    fn samples(of: &[(f64, f64, u32)]) -> Vec<Sample> {
        let mut spent_s = 0.0;
        let mut before_s = 0.0;
        let sample = |&(time_s, inside, left): &(f64, f64, u32)| {
            spent_s += 0.1 * inside * (time_s - before_s);
            before_s = time_s;
            Sample {
                time_s,
                spent_s,
                inside,
                left,
            }
        };
        of.iter().map(sample).collect()
    }

    #[test]
    fn a_steady_flow_goes_on_as_it_is() {
        let of = samples(&[
            (0.0, 0.0, 0),
            (1.0, 5.0, 0),
            (2.0, 10.0, 2),
            (3.0, 10.0, 7),
            (4.0, 10.0, 12),
        ]);
        // 0.5 s and 1 s in the first two seconds, then 1 s per second.
        let [least_s, most_s] = run_time_s(&of, 60.0);
        assert!(
            (least_s - 59.5).abs() < 1e-9 && most_s == least_s,
            "{least_s} {most_s}"
        );
    }

    #[test]
    fn a_flow_that_only_grows_lies_between_as_now_and_growing_on() {
        let of: Vec<_> = (0..=10).map(|n| (f64::from(n), f64::from(n), 0)).collect();
        let [least_s, most_s] = run_time_s(&samples(&of), 100.0);
        // One body a second: the sum of 0.1 n over n up to 100 is 505 s.
        assert!(least_s < 100.0, "{least_s}");
        assert!((400.0..600.0).contains(&most_s), "{most_s}");
    }

    #[test]
    fn a_first_step_longer_than_the_trial_tells_the_rest() {
        let of = samples(&[(0.0, 1.0, 0), (1.0, 1.0, 0), (1.0, 1.0, 0)]);
        assert_eq!(run_time_s(&of, 10.0).map(|s| (1e9 * s).round()), [1e9; 2]);
    }

    #[test]
    fn a_trial_that_reaches_the_end_is_the_run() {
        let of = samples(&[(0.0, 1.0, 0), (1.0, 1.0, 0)]);
        assert_eq!(run_time_s(&of, 1.0), [0.1; 2]);
    }
}
