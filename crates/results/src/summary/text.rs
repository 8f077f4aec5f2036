//! The summary in words.

use std::fmt::{self, Write};

use dem_io::body::mass::mass_lines;
use dem_io::text::visible;
use dem_io::units::significant;

use super::contents::Summary;
use super::equilibrium::EquilibriumSummary;
use super::measured::Measured;
use super::parts::PopulationSummary;
use super::sizes::{RESOLVED_DIAMETERS, SizeSummary};

/// Number of measures, and of reasons for the verdict, that the short text shows; the others are
/// counted.
pub(super) const SHOWN: usize = 4;

/// Most bodies of which each has a line with its sizes.
const MOST_BODIES: usize = 4;

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(equilibrium) = &self.equilibrium {
            return self.write_equilibrium(equilibrium, f);
        }
        self.write_head(f)?;
        measure_lines(&self.measures, f)?;
        self.write_test(f)?;
        self.write_steps(f)?;
        self.write_broken(f)?;
        self.write_population(f)?;
        for (name, taken) in &self.taken_in {
            writeln!(
                f,
                "taken in     {name} {} J/kg at most; daughters replace it from {} J/kg",
                significant(taken.largest_j_kg, 4),
                significant(taken.needed_j_kg, 4),
            )?;
        }
        if let Some(sleep) = &self.sleep {
            writeln!(
                f,
                "asleep       {} bodies at the end; {:.0} % of particle updates skipped",
                sleep.bodies,
                100.0 * sleep.particle_updates_skipped,
            )?;
        }
        self.write_strained(f)?;
        self.write_fragments(f)?;
        self.write_sizes(f)?;
        self.write_masses(f)?;
        writeln!(f, "inactive     {}", self.inactive_stages.join(", "))?;
        self.write_verdict(f)
    }
}

impl Summary {
    /// Scene, simulated and wall time.
    pub(super) fn write_head(&self, f: &mut impl Write) -> fmt::Result {
        let results = self
            .results
            .as_ref()
            .map_or(String::new(), |r| format!(" -> {}", visible(r)));
        writeln!(
            f,
            "{}: {} s simulated{} in {} s on {} thread{}{results}",
            visible(&self.scene),
            significant(self.simulated_s, 6),
            self.resumed_at_s.map_or(String::new(), |at_s| {
                let last = significant(self.simulated_s - at_s, 3);
                format!(", the last {last} s of it")
            }),
            significant(self.wall_s, 3),
            self.threads,
            if self.threads == 1 { "" } else { "s" },
        )
    }

    /// The answer of a laboratory test with the verdict, and its figures.
    pub(super) fn write_test(&self, f: &mut impl Write) -> fmt::Result {
        let Some(test) = &self.test else {
            return Ok(());
        };
        let word = self.verdict.word.word();
        writeln!(f, "answer       {}; {word}", test.answer())?;
        f.write_str(&test.text(&self.verdict.unresolved))
    }

    /// Whether no body could break: none had bonds, and daughters replaced none.
    fn is_rigid(&self) -> bool {
        let ever_bonded = self.bonds > 0 || self.broken_bonds > 0 || self.largest_bond_strain > 0.0;
        let replaced = |bodies: &PopulationSummary| {
            bodies.replaced + bodies.replaced_by_daughters > 0 || bodies.fines_kg > 0.0
        };
        !ever_bonded && !self.population.as_ref().is_some_and(replaced)
    }

    /// Broken, damaged and yielded bonds.
    pub(super) fn write_broken(&self, f: &mut impl Write) -> fmt::Result {
        let of_all = match self.population {
            Some(_) if self.is_rigid() => return Ok(()),
            Some(_) => String::new(),
            None if self.bonds > 0 => format!(" of {}", self.bonds),
            None => return Ok(()),
        };
        let causes = match self.broken_bonds {
            0 => String::new(),
            _ => format!(": {}", self.broken_by_cause),
        };
        let counted = |count: Option<usize>, how: &str| {
            count.map_or(String::new(), |count| format!("; {count} {how}"))
        };
        let damaged = counted(self.damaged_bonds, "damaged");
        let yielded = counted(self.yielded_bonds, "yielded");
        writeln!(
            f,
            "broken       {}{of_all} bonds{causes}{damaged}{yielded}",
            self.broken_bonds
        )
    }

    /// Largest deformations.
    fn write_strained(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
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
        Ok(())
    }

    /// Fragments and the largest of them.
    pub(super) fn write_fragments(&self, f: &mut impl Write) -> fmt::Result {
        let Some(fragments) = self.fragments.as_ref().filter(|_| !self.is_rigid()) else {
            return Ok(());
        };
        let discharged = self.population.as_ref().map_or(0, |p| p.discharged);
        let inside = match discharged {
            0 => String::new(),
            _ => format!(", {} of them inside", fragments.inside),
        };
        // A measure has said it above.
        let told = fragments.mass_fraction_of_largest;
        let mut measures = self.measures.iter().take(SHOWN);
        if measures.any(|measure| measure.unit.is_empty() && measure.value == told) {
            return writeln!(f, "fragments    {}{inside}", fragments.count);
        }
        writeln!(
            f,
            "fragments    {}{inside}, the largest {} of the mass",
            fragments.count,
            significant(fragments.mass_fraction_of_largest, 3)
        )
    }

    /// Errors, steps and speed.
    fn write_steps(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "error        energy {}   momentum {}   angular momentum {}",
            significant(self.energy_error, 2),
            significant(self.momentum_error, 2),
            significant(self.angular_momentum_error, 2),
        )?;
        if let Some(part) = &self.part_error {
            let error = significant(part.energy_error, 2);
            writeln!(
                f,
                "             energy {error} of {} by itself",
                part.named()
            )?;
        }
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
        if p.has_changed() {
            writeln!(
                f,
                "bodies       {} fed ({} kg), {} replaced{}, {} restored, {} discharged, fragments included ({} kg), {}{} clumps{} at the end",
                p.fed,
                significant(p.fed_kg, 4),
                p.replaced,
                match p.replaced_by_daughters {
                    0 => String::new(),
                    count => format!(", {count} by daughters"),
                },
                p.restored,
                p.discharged,
                significant(p.discharged_kg, 4),
                match p.fines_kg {
                    0.0 => String::new(),
                    fines_kg => format!("{} kg of fines, ", significant(fines_kg, 4)),
                },
                p.clumps,
                match p.single_sphere_bodies {
                    0 => String::new(),
                    1 => " and 1 body of one sphere".to_owned(),
                    count => format!(" and {count} bodies of one sphere"),
                },
            )?;
        }
        if p.outlets.len() > 1 || p.outlets.values().any(|outlet| outlet.flow_kg_s.is_some()) {
            let outlets = p.outlets.iter().map(|(name, outlet)| {
                let flow = outlet.flow_kg_s.map_or(String::new(), |flow_kg_s| {
                    format!(", {} kg/s", significant(flow_kg_s, 3))
                });
                format!(
                    "{name} {} ({} kg{flow})",
                    outlet.bodies,
                    significant(outlet.mass_kg, 4)
                )
            });
            let outlets: Vec<String> = outlets.collect();
            writeln!(f, "outlets      {}", outlets.join(", "))?;
        }
        let hidden = match 100.0 * p.inner_sphere_fraction {
            fraction if fraction >= 0.5 => {
                format!("; {fraction:.0} % of the spheres of clumps, which nothing can touch")
            }
            _ => String::new(),
        };
        if p.rigid_parts > 0 || p.released > 0 {
            writeln!(
                f,
                "rigid parts  {} at the end; {} spheres released, {} joined again",
                p.rigid_parts, p.released, p.rejoined
            )?;
        }
        writeln!(
            f,
            "skipped      {:.0} % of bond updates, as their bodies were rigid{hidden}",
            100.0 * p.bond_updates_skipped,
        )
    }

    /// Scene, time of the equilibrium, and wall time.
    pub(super) fn write_equilibrium_head(&self, f: &mut impl Write) -> fmt::Result {
        let results = self.results.as_ref();
        writeln!(
            f,
            "{}: equilibrium at {} s in {} s{}",
            visible(&self.scene),
            significant(self.simulated_s, 6),
            significant(self.wall_s, 3),
            results.map_or(String::new(), |folder| format!(" -> {}", visible(folder))),
        )
    }

    /// The text of the summary of a static run.
    fn write_equilibrium(
        &self,
        found: &EquilibriumSummary,
        f: &mut fmt::Formatter<'_>,
    ) -> fmt::Result {
        self.write_equilibrium_head(f)?;
        measure_lines(&self.measures, f)?;
        self.write_test(f)?;
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

    /// Sizes of all fragments, if any body has broken.
    pub(super) fn write_sizes(&self, f: &mut impl Write) -> fmt::Result {
        let has_split = self.fragments.is_some_and(|fragments| fragments.splits > 0);
        let Some(sizes) = self.sizes.as_ref().filter(|_| has_split) else {
            return Ok(());
        };
        let mm = |size_m: f64| significant(size_m * 1e3, 3);
        let mut line = |name: &str, of: &str, sizes: &SizeSummary| {
            let marks = [
                sizes.unresolved.d10,
                sizes.unresolved.d50,
                sizes.unresolved.d80,
            ];
            let marks = marks.map(|is_unresolved| if is_unresolved { "*" } else { "" });
            let t10 = sizes.t10.map_or("not resolved".to_owned(), |t10| {
                significant(t10, 3) + if sizes.unresolved.t10 { "*" } else { "" }
            });
            writeln!(
                f,
                "{name:12} d10 {} mm{}   d50 {} mm{}   d80 {} mm{}   t10 {t10}{of}",
                mm(sizes.d10_m),
                marks[0],
                mm(sizes.d50_m),
                marks[1],
                mm(sizes.d80_m),
                marks[2],
            )
        };
        if let Some(all) = sizes.all.get("both") {
            line("sizes", "", all)?;
        }
        if let Some(left) = sizes.all.get("discharged") {
            line("", "   of what left", left)?;
        }
        if (2..=MOST_BODIES).contains(&sizes.bodies.len()) {
            for (name, body) in &sizes.bodies {
                if let Some(both) = body.get("both") {
                    line("", &format!("   of {name}"), both)?;
                }
            }
        }
        Ok(())
    }

    /// Two lines for each body: its masses.
    fn write_masses(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, line) in mass_lines(&self.bodies) {
            writeln!(f, "{name:12} {line}")?;
        }
        Ok(())
    }

    /// Notes, and the verdict.
    fn write_verdict(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for note in &self.notes {
            writeln!(f, "note         {}", visible(note))?;
        }
        let verdict = &self.verdict;
        for (name, all) in [("warning", &verdict.warnings), ("coarse", &verdict.coarse)] {
            for reason in all {
                writeln!(f, "{name:12} {}", visible(reason))?;
            }
        }
        self.write_unresolved(f)?;
        writeln!(f, "verdict      {}", self.verdict_text())
    }

    /// What the marks of sizes mean, if there are any.
    pub(super) fn write_unresolved(&self, f: &mut impl Write) -> fmt::Result {
        let all = self.sizes.as_ref().and_then(|sizes| sizes.all.get("both"));
        let Some(all) = all.filter(|_| !self.verdict.unresolved.is_empty()) else {
            return Ok(());
        };
        writeln!(
            f,
            "* unresolved {} of the fragments: below {RESOLVED_DIAMETERS} sphere diameters ({} mm) the spheres decide, not the material",
            self.verdict.unresolved.join(", "),
            significant(1e3 * all.resolved_from_m, 3)
        )
    }
}

pub(super) fn measure_lines(measures: &[Measured], f: &mut impl Write) -> fmt::Result {
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
        _ if value.is_nan() => "no value".to_owned(),
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
