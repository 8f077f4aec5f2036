//! The contents of the summary, and the verdict on them.

use std::collections::BTreeMap;
use std::path::Path;

use dem_io::Diagnostic;
use dem_io::body::mass::BodyMass;
use dem_io::units::{show_length, significant};
use dem_laboratory::TestType;
use dem_laboratory::test_result::TestResult;
use dem_physics::bond::failure::CauseCounts;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::balance::Balance;
use super::by_name;
use super::equilibrium::EquilibriumSummary;
use super::inputs::Inputs;
use super::measured::Measured;
use super::parts::{
    AdaptiveSummary, BodyFlow, FragmentSummary, PartError, PopulationSummary, SleepSummary,
    TakenIn, WallLoadSummary, WallSummary,
};
use super::sizes::{RESOLVED_DIAMETERS, SizeSummary, Sizes};
use crate::json::from_json;

/// Program and version.
const PROGRAM: &str = concat!("dem-run ", env!("CARGO_PKG_VERSION"));

/// Smallest energy error that is reported.
const LARGE_ENERGY_ERROR: f64 = 0.01;
/// What to do against it, unless a run has found another reason.
const SMALLER_STEP: &str = "take a smaller step (run.safety_factor)";

/// Summary of a run. SI units.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Summary {
    /// The scene's file.
    pub scene: String,
    /// Program and version.
    pub program: String,
    /// The program that has computed the results, if it is another one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub engine: Option<String>,
    /// Reason for its end: "end time", "rest", "measure" (one with `end_run_above`), or for a
    /// laboratory test "breakage", "end of the stroke" or, if it is dynamic, "end of the test".
    pub ended_by: String,
    /// The problem, if it did not reach its end: `ended_by` is "instability" or "interruption".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
    /// Inputs of the run.
    pub inputs: Inputs,
    /// Simulated time, s.
    pub simulated_s: f64,
    /// Time at which the run was resumed, s: wall time, processor time and the times of stages are
    /// those of what follows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resumed_at_s: Option<f64>,
    /// Wall time, s.
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
    /// Unbroken bonds that are damaged. None: no bond softens beyond its strength.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damaged_bonds: Option<usize>,
    /// Unbroken bonds that have yielded. None: no bond has a yield strength.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yielded_bonds: Option<usize>,
    /// Largest strain at the edge of a bond, by elongation and bending or by shear and torsion.
    pub largest_bond_strain: f64,
    /// Largest ratio of contact overlap to the radius of the smaller sphere.
    pub largest_overlap: f64,
    /// Broken bonds by cause of failure.
    #[serde(
        serialize_with = "CauseCounts::serialize_by_name",
        deserialize_with = "CauseCounts::deserialize_by_name"
    )]
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
    /// Masses of each body fed, discharged and inside, by name, if any are fed or discharged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flows: Option<BTreeMap<String, BodyFlow>>,
    /// Energies that the particles of bodies with daughters took in, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub taken_in: BTreeMap<String, TakenIn>,
    /// What contacts have done to each wall with `loads`, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub wall_loads: BTreeMap<String, WallLoadSummary>,
    /// Walls that move, or whose surfaces do, by name; not those of a laboratory test.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub walls: BTreeMap<String, WallSummary>,
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
    /// That of bodies apart from all others, by themselves, if it is larger.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part_error: Option<PartError>,
    /// Largest relative momentum error of the run.
    pub momentum_error: f64,
    /// Largest relative angular momentum error of the run.
    pub angular_momentum_error: f64,
    /// Energies, works and momenta at the end.
    pub balance: Balance,
    /// Results of the measures; by name in JSON.
    #[serde(
        serialize_with = "measures_by_name",
        deserialize_with = "measures_from_names"
    )]
    pub measures: Vec<Measured>,
    /// Fraction of each stage in the time of a step; by name in JSON.
    #[serde(with = "by_name")]
    pub time_by_stage: Vec<(String, f64)>,
    /// Stages that the scene does not need.
    pub inactive_stages: Vec<String>,
    /// What is unusual but harmless in the scene.
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
            verdict: Verdict::new(vec![problem.to_string()], Vec::new()),
        }
    }
}

/// Whether the result of a run can be trusted, in one word.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Trust {
    /// Yes.
    Sound,
    /// It is the result of these spheres: with smaller ones it would be another.
    Coarse,
    /// There is something to mend first.
    #[default]
    Doubtful,
}

impl Trust {
    /// "sound", "coarse" or "doubtful".
    pub fn word(self) -> &'static str {
        match self {
            Self::Sound => "sound",
            Self::Coarse => "coarse",
            Self::Doubtful => "doubtful",
        }
    }
}

/// What a coarse result means, after the word.
pub const COARSE: &str = "the result is that of these spheres, smaller ones would give another";

/// Reliability of the result of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "Stored", into = "Stored")]
pub struct Verdict {
    /// In one word.
    pub word: Trust,
    /// Reasons to doubt it, a sentence each.
    pub warnings: Vec<String>,
    /// Why it depends on the size of the spheres, a sentence each.
    pub coarse: Vec<String>,
    /// Names of figures of the fragments that the size of the spheres decides, not the material.
    pub unresolved: Vec<String>,
}

/// A verdict as it is written, and read, perhaps from a program that had no word for it.
#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct Stored {
    word: Option<Trust>,
    /// Whether this word is "sound".
    sound: bool,
    warnings: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    coarse: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unresolved: Vec<String>,
}

impl From<Stored> for Verdict {
    fn from(stored: Stored) -> Self {
        let word = match stored.sound {
            true => Trust::Sound,
            false => Trust::Doubtful,
        };
        Self {
            word: stored.word.unwrap_or(word),
            warnings: stored.warnings,
            coarse: stored.coarse,
            unresolved: stored.unresolved,
        }
    }
}

impl From<Verdict> for Stored {
    fn from(verdict: Verdict) -> Self {
        Self {
            word: Some(verdict.word),
            sound: verdict.word == Trust::Sound,
            warnings: verdict.warnings,
            coarse: verdict.coarse,
            unresolved: verdict.unresolved,
        }
    }
}

impl Verdict {
    /// Doubtful for these reasons, or coarse for those, or sound.
    pub fn new(warnings: Vec<String>, coarse: Vec<String>) -> Self {
        let word = match (warnings.is_empty(), coarse.is_empty()) {
            (true, true) => Trust::Sound,
            (true, false) => Trust::Coarse,
            (false, _) => Trust::Doubtful,
        };
        Self {
            word,
            warnings,
            coarse,
            unresolved: Vec::new(),
        }
    }

    /// What the reasons why it is not sound are called, and these: the warnings of a doubtful one,
    /// those of a coarse one otherwise.
    pub fn reasons(&self) -> (&'static str, &[String]) {
        match self.word {
            Trust::Doubtful => ("warning", &self.warnings),
            Trust::Coarse | Trust::Sound => ("coarse", &self.coarse),
        }
    }
}

impl Summary {
    /// Whether the run has come so far as to have results: one that failed at its start has none.
    pub fn has_results(&self) -> bool {
        !matches!(self.ended_by.as_str(), "" | "failure")
    }

    /// Reads that of a run from its file. None: there is none.
    pub fn read(file: &Path) -> Option<Self> {
        let json = serde_json::from_slice(&std::fs::read(file).ok()?).ok()?;
        from_json(json).ok()
    }

    /// Sets the verdict: reasons from the run to doubt it or to call it coarse, and those from the
    /// summary itself. `is_granular`: fragments are grains, whatever their size. `energy_remedy`:
    /// what to do against an energy error, if the run knows better than to take a smaller step.
    pub fn judge(
        &mut self,
        warnings: Vec<String>,
        coarse: Vec<String>,
        is_granular: bool,
        energy_remedy: Option<&str>,
    ) {
        let warnings = (self.problem.iter().cloned())
            .chain(warnings)
            .chain(self.doubts(energy_remedy.unwrap_or(SMALLER_STEP)))
            .collect();
        let small = self.small_fragments().filter(|_| !is_granular);
        let coarse = coarse.into_iter().chain(small).collect();
        self.verdict = Verdict {
            unresolved: self.unresolved(),
            ..Verdict::new(warnings, coarse)
        };
    }

    /// A sentence on fragments of which half the mass is near the size of a sphere. None as well: the
    /// run was a test whose results have no fragment sizes.
    fn small_fragments(&self) -> Option<String> {
        let all = self.sizes_if_split()?;
        let asks = (self.test.as_ref()).is_none_or(|test| test.kind == TestType::DropWeight);
        (all.unresolved.d50 && asks).then(|| {
            format!(
                "half the mass is in fragments of {} or less, below {RESOLVED_DIAMETERS} sphere diameters ({}): their sizes reflect the spheres rather than the material; use smaller spheres",
                show_length(all.d50_m),
                show_length(all.resolved_from_m)
            )
        })
    }

    /// Names of figures of all fragments that are below the size that the spheres resolve.
    fn unresolved(&self) -> Vec<String> {
        let all = self.sizes_if_split();
        let names = all.map_or(Vec::new(), |all| all.unresolved.names());
        names.into_iter().map(str::to_owned).collect()
    }

    /// Sizes of all fragments. None: no body has split.
    fn sizes_if_split(&self) -> Option<&SizeSummary> {
        let has_split = self.fragments.is_some_and(|fragments| fragments.splits > 0);
        self.sizes.as_ref().filter(|_| has_split)?.all.get("both")
    }

    /// Reasons in the summary to doubt the result.
    fn doubts(&self, energy_remedy: &str) -> Vec<String> {
        let mut doubts = Vec::new();
        if self.energy_error > LARGE_ENERGY_ERROR {
            doubts.push(format!(
                "the energy is off by {} of the largest energy, {} J, where {LARGE_ENERGY_ERROR} is allowed: {energy_remedy}",
                significant(self.energy_error, 2),
                significant(self.balance.energy_scale_j, 3)
            ));
        }
        let part = self.part_error.as_ref();
        if let Some(part) = part.filter(|part| part.energy_error > LARGE_ENERGY_ERROR) {
            doubts.push(format!(
                "the energy of {} by itself is off by {} of its largest energy, {} J, where {LARGE_ENERGY_ERROR} is allowed: {energy_remedy}",
                part.named(),
                significant(part.energy_error, 2),
                significant(part.energy_scale_j, 3)
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
}

/// A test with its answer, and its sentences, each after its name.
fn with_sentences<S: Serializer>(test: &Option<TestResult>, to: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Said<'a> {
        #[serde(flatten)]
        test: &'a TestResult,
        answer: String,
        sentences: Vec<(String, String)>,
    }
    let said = test.as_ref().map(|test| Said {
        test,
        answer: test.answer(),
        sentences: test.sentences(),
    });
    said.serialize(to)
}

fn measures_by_name<S: Serializer>(measures: &[Measured], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(measures.iter().map(|measure| (&measure.name, measure)))
}

fn measures_from_names<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Measured>, D::Error> {
    let named = BTreeMap::<String, Measured>::deserialize(from)?.into_iter();
    let named = named.map(|(name, measure)| Measured { name, ..measure });
    Ok(named.collect())
}
