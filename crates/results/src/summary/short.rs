//! The summary in about ten lines: what happened, its figures, whether to trust it.

use std::fmt::{self, Write};

use dem_io::text::{counted, visible};
use dem_io::units::significant;

use super::contents::{COARSE, Summary, Trust};
use super::text::{SHOWN, measure_lines};

impl Summary {
    /// The answers of the run in about ten lines; [`Summary`]'s `Display` shows everything.
    pub fn short(&self) -> String {
        let mut text = String::new();
        // Writing to a text does not fail.
        let _ = self.write_short(&mut text);
        text
    }

    fn write_short(&self, out: &mut String) -> fmt::Result {
        match &self.equilibrium {
            Some(_) => self.write_equilibrium_head(out)?,
            None => self.write_head(out)?,
        }
        // An interruption is told by the message at the end.
        if !["end time", "equilibrium", "interruption"].contains(&self.ended_by.as_str()) {
            writeln!(out, "ended by     {}", self.ended_by)?;
        }
        if let Some(change) = &self.resumed_with {
            writeln!(out, "resumed      {change}")?;
        }
        let shown = self.measures.len().min(SHOWN);
        measure_lines(&self.measures[..shown], out)?;
        if self.measures.len() > shown {
            let more = self.measures.len() - shown;
            let s = if more == 1 { "" } else { "s" };
            writeln!(out, "             and {more} more measure{s}")?;
        }
        self.write_test(out)?;
        if self.equilibrium.is_none() {
            self.write_broken(out)?;
            self.write_flow(out)?;
            self.write_fragments(out)?;
            self.write_sizes(out)?;
            writeln!(out, "energy error {}", significant(self.energy_error, 2))?;
        }
        self.write_trust(out)
    }

    /// Bodies fed and discharged.
    fn write_flow(&self, out: &mut String) -> fmt::Result {
        let Some(bodies) = self
            .population
            .as_ref()
            .filter(|p| p.fed + p.discharged > 0)
        else {
            return Ok(());
        };
        let discharged = match bodies.outlets.len() {
            0 => String::new(),
            _ => format!(
                ", {} kg discharged in {} pieces",
                significant(bodies.discharged_kg, 4),
                bodies.discharged
            ),
        };
        let fed = significant(bodies.fed_kg, 4);
        let fines = match bodies.fines_kg {
            0.0 => String::new(),
            fines_kg => format!(", {} kg of fines", significant(fines_kg, 4)),
        };
        writeln!(
            out,
            "bodies       {} fed ({fed} kg){discharged}{fines}",
            bodies.fed
        )?;
        let flows = bodies.outlets.iter().filter_map(|(name, outlet)| {
            let flow_kg_s = significant(outlet.flow_kg_s?, 3);
            Some(format!("{} {flow_kg_s} kg/s", visible(name)))
        });
        let flows: Vec<String> = flows.take(SHOWN).collect();
        if !flows.is_empty() {
            writeln!(out, "flow         {}", flows.join(", "))?;
        }
        if bodies.outlets.len() < 2 {
            return Ok(());
        }
        let outlets = bodies.outlets.iter().take(SHOWN).map(|(name, outlet)| {
            let mass = significant(outlet.mass_kg, 4);
            format!("{} {mass} kg in {}", visible(name), outlet.bodies)
        });
        let outlets: Vec<String> = outlets.collect();
        writeln!(out, "outlets      {}", outlets.join(", "))
    }

    /// The verdict with its reasons, and the page of the run.
    fn write_trust(&self, out: &mut String) -> fmt::Result {
        let (name, reasons) = self.verdict.reasons();
        for reason in reasons.iter().take(SHOWN) {
            writeln!(out, "{name:12} {}", visible(reason))?;
        }
        if reasons.len() > SHOWN {
            writeln!(out, "             and {} more", reasons.len() - SHOWN)?;
        }
        self.write_unresolved(out)?;
        match self.notes.len() {
            0 => {}
            1 => writeln!(out, "note         1: see --verbose or the page")?,
            many => writeln!(out, "notes        {many}: see --verbose or the page")?,
        }
        writeln!(out, "verdict      {}", self.verdict_text())?;
        if let Some(folder) = &self.results {
            writeln!(
                out,
                "page         {}",
                visible(&format!("{folder}/report.html"))
            )?;
        }
        Ok(())
    }

    /// The word of the verdict and what follows from it.
    pub(super) fn verdict_text(&self) -> String {
        match self.verdict.word {
            Trust::Sound => "sound".to_owned(),
            Trust::Coarse => format!("coarse: {COARSE}"),
            Trust::Doubtful => {
                let warnings = counted(self.verdict.warnings.len(), "warning");
                format!("doubtful: {warnings}")
            }
        }
    }
}
