//! The summary of a run: its results, their reliability, and the time spent in each stage.

use std::collections::BTreeMap;
use std::fmt;

use dem_io::Diagnostic;
use dem_io::body::mass::BodyMass;
use dem_io::text::visible;
use dem_io::units::significant;
use serde::{Serialize, Serializer};

use super::equilibrium::EquilibriumSummary;
use super::fragments::FragmentSummary;
use super::sizes::Sizes;
use crate::laboratory::evaluate::TestResult;
use crate::measure::Measured;
use crate::physics::bond::failure::CauseCounts;
use crate::plan::inputs::Inputs;
use crate::plan::masses;
use crate::stages::ledger::{Balance, over};
use crate::state::State;
use crate::state::sleep::Sleep;

/// Program and version.
const PROGRAM: &str = concat!("dem-run ", env!("CARGO_PKG_VERSION"));

/// Smallest energy error that is reported.
const LARGE_ENERGY_ERROR: f64 = 0.01;

/// Summary of a run. SI units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// The scene's file.
    pub scene: String,
    /// Program and version.
    pub program: String,
    /// Reason for its end: "end time", "rest", or for a laboratory test "breakage" or "end of the
    /// stroke".
    pub ended_by: String,
    /// The problem, if it did not reach its end: `ended_by` is "instability" or "interruption".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
    /// Inputs of the run.
    pub inputs: Inputs,
    /// Simulated time, s.
    pub simulated_s: f64,
    /// Wall time, s; that since the last checkpoint for a run that was resumed.
    pub wall_s: f64,
    /// Processor time of the same, s, all threads together.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub processor_s: Option<f64>,
    /// Number of threads.
    pub threads: usize,
    /// Processor and number of cores.
    pub machine: String,
    /// Number of particles.
    pub particles: usize,
    /// Number of bonds, including broken ones; if bodies are added or removed, of those that exist
    /// at the end.
    pub bonds: usize,
    /// Mass of each body at the start, by name.
    pub bodies: BTreeMap<String, BodyMass>,
    /// Bonds that broke.
    pub broken_bonds: u64,
    /// Largest strain at the edge of a bond, by elongation and bending or by shear and torsion.
    pub largest_bond_strain: f64,
    /// Largest ratio of contact overlap to the radius of the smaller sphere.
    pub largest_overlap: f64,
    /// Broken bonds by cause of failure.
    #[serde(serialize_with = "CauseCounts::serialize_by_name")]
    pub broken_by_cause: CauseCounts,
    /// Fragmentation of the bodies, if they can break.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fragments: Option<FragmentSummary>,
    /// Sizes of the fragments, if bodies can break.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sizes: Option<Sizes>,
    /// Bodies added, removed and replaced, if any can be.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub population: Option<PopulationSummary>,
    /// Sleeping bodies, if any can sleep.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sleep: Option<SleepSummary>,
    /// Steps from the start.
    pub steps: u64,
    /// Last step, s.
    pub time_step_s: f64,
    /// Range of an adaptive step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub adaptive: Option<AdaptiveSummary>,
    /// Largest stable step, s.
    pub limit_s: f64,
    /// Ratio of the step to the limit.
    pub fraction_of_limit: f64,
    /// Steps per second of wall time.
    pub steps_per_s: f64,
    /// Bond updates per second of wall time.
    pub bond_steps_per_s: f64,
    /// Largest relative energy error of the run.
    pub energy_error: f64,
    /// Largest relative momentum error of the run.
    pub momentum_error: f64,
    /// Largest relative angular momentum error of the run.
    pub angular_momentum_error: f64,
    /// Energies, works and momenta at the end.
    pub balance: Balance,
    /// Results of the measures; by name in JSON.
    #[serde(serialize_with = "by_name")]
    pub measures: Vec<Measured>,
    /// Fraction of each stage in the time of a step; by name in JSON.
    #[serde(serialize_with = "pairs_by_name")]
    pub time_by_stage: Vec<(String, f64)>,
    /// Stages that the scene does not need.
    pub inactive_stages: Vec<String>,
    /// Harmless peculiarities of the scene.
    pub notes: Vec<String>,
    /// Reliability of the result.
    pub verdict: Verdict,
    /// Folder of the results.
    pub results: Option<String>,
    /// The change of the time step, if the run was resumed with another one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resumed_with: Option<String>,
    /// Result of the scene's laboratory test.
    #[serde(
        skip_serializing_if = "Option::is_none",
        serialize_with = "with_sentences"
    )]
    pub test: Option<TestResult>,
    /// Data on the equilibrium of a static run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub equilibrium: Option<EquilibriumSummary>,
}

/// Summary of a run that ended before there were any results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Unfinished {
    /// The scene's file.
    pub scene: String,
    /// Program and version.
    pub program: String,
    /// Always "failure".
    pub ended_by: String,
    /// The problem.
    pub problem: String,
    /// Inputs of the run.
    pub inputs: Inputs,
    /// Empty.
    pub measures: BTreeMap<String, f64>,
    /// Not sound, because of the problem.
    pub verdict: Verdict,
}

impl Unfinished {
    /// For a scene that failed with this problem.
    pub fn new(scene: &str, inputs: Inputs, problem: &Diagnostic) -> Self {
        Self {
            scene: scene.to_owned(),
            program: PROGRAM.to_owned(),
            ended_by: "failure".to_owned(),
            problem: problem.to_string(),
            inputs,
            measures: BTreeMap::new(),
            verdict: Verdict {
                sound: false,
                warnings: vec![problem.to_string()],
            },
        }
    }
}

/// Reliability of the result of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Verdict {
    /// There are no reasons to doubt it.
    pub sound: bool,
    /// Reasons to doubt it, a sentence each.
    pub warnings: Vec<String>,
}

/// Bodies added, removed and replaced.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PopulationSummary {
    /// Rigid clumps of two or more spheres at the end.
    pub clumps: usize,
    /// Single loose spheres of clumps and inlets at the end.
    pub single_spheres: usize,
    /// Clumps that became bonded clusters.
    pub replaced: u32,
    /// Clusters and fragments that became rigid clumps again.
    pub restored: u32,
    /// Bodies fed by inlets.
    pub fed: u32,
    /// Their mass, kg.
    pub fed_kg: f64,
    /// Bodies that had to wait for a free position.
    pub delayed: u32,
    /// Bodies that inlets have still to feed at the end.
    pub waiting: u32,
    /// Bodies and fragments discharged through outlets.
    pub discharged: u32,
    /// Their mass, kg.
    pub discharged_kg: f64,
    /// Fraction of bond updates that was skipped because bodies were clumps.
    pub bond_updates_skipped: f64,
    /// Fraction of the spheres of a clump that nothing can touch, the mean of all templates.
    pub inner_sphere_fraction: f64,
}

/// Range of an adaptive step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct AdaptiveSummary {
    /// Smallest step, s.
    pub smallest_step_s: f64,
    /// Largest step, s.
    pub largest_step_s: f64,
    /// Number of its changes.
    pub changes: u64,
}

/// Sleeping bodies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SleepSummary {
    /// Bodies asleep at the end.
    pub bodies: usize,
    /// Fraction of particle updates that was skipped because their bodies slept.
    pub particle_updates_skipped: f64,
}

impl SleepSummary {
    /// From the data at the end.
    pub fn of(sleep: &Sleep) -> Self {
        let [done, left_out] = sleep.particle_steps.map(|count| count as f64);
        Self {
            bodies: sleep.bodies,
            particle_updates_skipped: over(left_out, done + left_out),
        }
    }
}

impl PopulationSummary {
    /// From a state at its end. None: no body can be added, removed or replaced.
    pub fn of(state: &State) -> Option<Self> {
        let (rules, clumps) = (&state.model.rules, &state.clumps);
        let population = &state.population;
        if !state.bodies_change() {
            return None;
        }
        let several = clumps.of_several_spheres();
        let [done, left_out] = population.bond_steps.map(|count| count as f64);
        let inner = clumps.templates.iter();
        let inner: f64 = inner
            .map(|t| 1.0 - t.outer.len() as f64 / t.spheres.len() as f64)
            .sum();
        Some(Self {
            clumps: several,
            single_spheres: clumps.all.len() - several,
            replaced: population.replaced,
            restored: population.restored,
            fed: population.inlets.iter().map(|come| come.bodies).sum(),
            fed_kg: (population.inlets.iter()).fold(0.0, |sum, come| sum + come.mass_kg),
            delayed: population.inlets.iter().map(|come| come.delayed).sum(),
            waiting: (rules.inlets.iter().zip(&population.inlets))
                // Bodies that are due at the very end have not been tried.
                .map(|(inlet, come)| inlet.owed(come, state.time_s - state.time_step_s))
                .sum(),
            discharged: population.outlets.iter().map(|left| left.bodies).sum(),
            discharged_kg: (population.outlets.iter()).fold(0.0, |sum, left| sum + left.mass_kg),
            bond_updates_skipped: over(left_out, done + left_out),
            inner_sphere_fraction: over(inner, clumps.templates.len() as f64),
        })
    }
}

impl Summary {
    /// Errors, steps and speed.
    fn write_steps(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "error        energy {}   momentum {}   angular momentum {}",
            significant(self.energy_error, 2),
            significant(self.momentum_error, 2),
            significant(self.angular_momentum_error, 2),
        )?;
        writeln!(
            f,
            "steps        {} of {} s, {}; ended by {}",
            self.steps,
            significant(self.time_step_s, 4),
            if self.limit_s.is_finite() {
                format!("{} of the limit", significant(self.fraction_of_limit, 3))
            } else {
                "without a limit".to_owned()
            },
            self.ended_by,
        )?;
        if let Some(adaptive) = &self.adaptive {
            writeln!(
                f,
                "             adaptive: {} to {} s, changed {} times",
                significant(adaptive.smallest_step_s, 4),
                significant(adaptive.largest_step_s, 4),
                adaptive.changes,
            )?;
        }
        if let Some(change) = &self.resumed_with {
            writeln!(f, "resumed      {change}")?;
        }
        writeln!(
            f,
            "speed        {} steps/s, {} million bond-steps/s",
            significant(self.steps_per_s, 3),
            significant(self.bond_steps_per_s * 1e-6, 3),
        )?;
        let fractions: Vec<String> = self
            .time_by_stage
            .iter()
            .filter(|(_, share)| *share >= 0.005)
            .map(|(name, share)| format!("{name} {:.0} %", 100.0 * share))
            .collect();
        writeln!(f, "time         {}", fractions.join("   "))
    }

    /// Bodies added, removed and replaced.
    fn write_population(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(p) = &self.population else {
            return Ok(());
        };
        writeln!(
            f,
            "bodies       {} fed ({} kg), {} replaced, {} restored, {} discharged ({} kg), {} clumps{} at the end",
            p.fed,
            significant(p.fed_kg, 4),
            p.replaced,
            p.restored,
            p.discharged,
            significant(p.discharged_kg, 4),
            p.clumps,
            match p.single_spheres {
                0 => String::new(),
                count => format!(" and {count} single spheres"),
            },
        )?;
        let hidden = match 100.0 * p.inner_sphere_fraction {
            fraction if fraction >= 0.5 => {
                format!("; {fraction:.0} % of the spheres of clumps, which nothing can touch")
            }
            _ => String::new(),
        };
        writeln!(
            f,
            "skipped      {:.0} % of bond updates, as their bodies were rigid{hidden}",
            100.0 * p.bond_updates_skipped,
        )
    }

    /// The text of the summary of a static run.
    ///
    /// # Errors
    /// Those of the formatter.
    fn write_equilibrium(
        &self,
        found: &EquilibriumSummary,
        f: &mut fmt::Formatter<'_>,
    ) -> fmt::Result {
        let results = self.results.as_ref();
        writeln!(
            f,
            "{}: equilibrium at {} s in {} s{}",
            visible(&self.scene),
            significant(self.simulated_s, 6),
            significant(self.wall_s, 3),
            results.map_or(String::new(), |folder| format!(" -> {}", visible(folder))),
        )?;
        measure_lines(&self.measures, f)?;
        if let Some(test) = &self.test {
            write!(f, "{test}")?;
        }
        let steps = |count: usize, what: &str| {
            format!("{count} {what}{}", if count == 1 { "" } else { "s" })
        };
        writeln!(
            f,
            "equilibrium  in {}{}, residual {} of the largest bond force",
            steps(found.newton_steps, "Newton iteration"),
            match found.load_steps {
                1 => String::new(),
                many => format!(" and {many} load steps"),
            },
            significant(found.residual, 2),
        )?;
        writeln!(
            f,
            "solved       {} unknowns; {} freedoms held",
            found.unknowns, found.held
        )?;
        self.write_masses(f)?;
        self.write_verdict(f)
    }

    /// Sets the verdict: `warnings` from the run, and those from the summary itself.
    pub(crate) fn judge(&mut self, warnings: Vec<String>) {
        let warnings: Vec<String> = (self.problem.iter().cloned())
            .chain(warnings)
            .chain(self.doubts())
            .collect();
        self.verdict = Verdict {
            sound: warnings.is_empty(),
            warnings,
        };
    }

    /// Reasons in the summary to doubt the result.
    fn doubts(&self) -> Vec<String> {
        let mut doubts = Vec::new();
        if self.energy_error > LARGE_ENERGY_ERROR {
            doubts.push(format!(
                "the energy is off by {} of the largest energy: take a smaller step (run.safety_factor)",
                significant(self.energy_error, 2)
            ));
        }
        if self.fraction_of_limit > 1.0 {
            doubts.push("the time step is above the largest stable one".to_owned());
        }
        if let Some(population) = self.population.as_ref().filter(|p| p.waiting > 0) {
            let waiting = match population.waiting {
                1 => "1 body still waits".to_owned(),
                many => format!("{many} bodies still wait"),
            };
            doubts.push(format!(
                "{waiting} for a place at an inlet: make its region larger or put it farther from walls, its bodies faster, or its rate smaller"
            ));
        }
        doubts.extend(self.measures.iter().filter_map(|m| m.missing.clone()));
        let off = |m: &&Measured| m.missing.is_none() && !m.is_good();
        for measure in self.measures.iter().filter(off) {
            doubts.push(format!("{} is outside its tolerance", measure.name));
        }
        doubts.extend(self.test.iter().flat_map(TestResult::doubts));
        let is_test = self.test.is_some();
        doubts.extend((self.equilibrium.iter()).flat_map(|found| found.doubts(is_test)));
        doubts
    }

    /// Sizes of all fragments, if any body has broken.
    fn write_sizes(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let has_split = self.fragments.is_some_and(|fragments| fragments.splits > 0);
        let sizes = self.sizes.as_ref().and_then(|sizes| sizes.all.get("both"));
        let Some(sizes) = sizes.filter(|_| has_split) else {
            return Ok(());
        };
        let mm = |size_m: f64| significant(size_m * 1e3, 3);
        writeln!(
            f,
            "sizes        d10 {} mm   d50 {} mm   d80 {} mm   t10 {}",
            mm(sizes.d10_m),
            mm(sizes.d50_m),
            mm(sizes.d80_m),
            significant(sizes.t10, 3)
        )
    }

    /// Two lines for each body: its masses.
    ///
    /// # Errors
    /// Those of the formatter.
    pub(crate) fn write_masses(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, line) in masses::lines(&self.bodies) {
            writeln!(f, "{name:12} {line}")?;
        }
        Ok(())
    }

    /// Notes, and the verdict.
    ///
    /// # Errors
    /// Those of the formatter.
    pub(crate) fn write_verdict(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for note in &self.notes {
            writeln!(f, "note         {}", visible(note))?;
        }
        for warning in &self.verdict.warnings {
            writeln!(f, "warning      {}", visible(warning))?;
        }
        let verdict = match (self.verdict.warnings.len(), self.notes.len()) {
            (0, 0) => "sound: no warnings".to_owned(),
            (0, _) => "sound: no warnings, but see the notes".to_owned(),
            (1, _) => "doubtful: 1 warning".to_owned(),
            (many, _) => format!("doubtful: {many} warnings"),
        };
        writeln!(f, "verdict      {verdict}")
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(equilibrium) = &self.equilibrium {
            return self.write_equilibrium(equilibrium, f);
        }
        let results = self
            .results
            .as_ref()
            .map_or(String::new(), |r| format!(" -> {}", visible(r)));
        writeln!(
            f,
            "{}: {} s simulated in {} s on {} thread{}{results}",
            visible(&self.scene),
            significant(self.simulated_s, 6),
            significant(self.wall_s, 3),
            self.threads,
            if self.threads == 1 { "" } else { "s" },
        )?;
        measure_lines(&self.measures, f)?;
        if let Some(test) = &self.test {
            write!(f, "{test}")?;
        }
        self.write_steps(f)?;
        let causes = match self.broken_bonds {
            0 => String::new(),
            _ => format!(": {}", self.broken_by_cause),
        };
        if self.population.is_some() {
            writeln!(f, "broken       {} bonds{causes}", self.broken_bonds)?;
        } else if self.bonds > 0 {
            writeln!(
                f,
                "broken       {} of {} bonds{causes}",
                self.broken_bonds, self.bonds
            )?;
        }
        self.write_population(f)?;
        if let Some(sleep) = &self.sleep {
            writeln!(
                f,
                "asleep       {} bodies at the end; {:.0} % of particle updates skipped",
                sleep.bodies,
                100.0 * sleep.particle_updates_skipped,
            )?;
        }
        let strained = [
            ("bonds", self.largest_bond_strain, "edge strain"),
            ("contacts", self.largest_overlap, "of the smaller radius"),
        ];
        let strained: Vec<String> = (strained.iter().filter(|(_, largest, _)| *largest > 0.0))
            .map(|(what, largest, of)| format!("{what} {} {of}", significant(*largest, 3)))
            .collect();
        if !strained.is_empty() {
            writeln!(f, "deformed     {} at most", strained.join("   "))?;
        }
        if let Some(fragments) = &self.fragments {
            writeln!(
                f,
                "fragments    {}, the largest {} of the mass",
                fragments.count,
                significant(fragments.mass_fraction_of_largest, 3)
            )?;
        }
        self.write_sizes(f)?;
        self.write_masses(f)?;
        writeln!(f, "inactive     {}", self.inactive_stages.join(", "))?;
        self.write_verdict(f)
    }
}

/// A test with its sentences, each after its name.
fn with_sentences<S: Serializer>(test: &Option<TestResult>, to: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Said<'a> {
        #[serde(flatten)]
        test: &'a TestResult,
        sentences: Vec<(String, String)>,
    }
    let said = test.as_ref().map(|test| Said {
        test,
        sentences: test.sentences(),
    });
    said.serialize(to)
}

fn by_name<S: Serializer>(measures: &[Measured], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(measures.iter().map(|measure| (&measure.name, measure)))
}

fn pairs_by_name<S: Serializer>(pairs: &[(String, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().map(|(name, value)| (name, value)))
}

/// A line for each measure.
///
/// # Errors
/// Those of the formatter.
pub(crate) fn measure_lines(measures: &[Measured], f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let names = measures.iter().map(|m| m.name.chars().count());
    let width = names.max().unwrap_or(0).max(12);
    for measure in measures {
        writeln!(f, "{}", measure_text(measure, width))?;
    }
    Ok(())
}

/// One line for a measure: value, and reference and error where there is one.
fn measure_text(measure: &Measured, width: usize) -> String {
    let show = |value: f64| match measure.unit.as_str() {
        "m" if value.abs() < 1.0 => format!("{} mm", significant(value * 1e3, 6)),
        unit => format!("{} {unit}", significant(value, 6))
            .trim_end()
            .to_owned(),
    };
    let mut text = format!("{:width$} {}", measure.name, show(measure.value));
    if let (Some(reference), Some(error)) = (measure.reference, measure.error) {
        text += &format!(
            "   theory {}   error {}",
            show(reference),
            significant(error, 3)
        );
    }
    text
}
