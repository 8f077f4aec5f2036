//! Every value of a scene in SI, defaults included, for a person.

mod contacts;
mod regions;
mod test;
mod walls;

use std::fmt::Write;

use super::bond::RATES;
use super::measure::TIMES;
use super::run::{INTEGRATORS, START_OVERLAPS};
use super::support::FREEDOMS;
use super::{
    BodyEntry, BodySource, BondKind, BondModel, Factor, Formulation, Hold, Initial, Load, Material,
    Measure, Output, ParticleSet, Pick, Run, Scene, Support, WholeMass,
};
use crate::text::visible;

/// Most items of a list that are written out.
const LISTED: usize = 8;

impl Scene {
    /// All values in SI with their units, defaults included: one line each, `key   value`, aligned.
    pub fn describe(&self) -> String {
        self.described().aligned()
    }

    /// The same as keys and values, in the same order.
    pub fn values(&self) -> Vec<(String, String)> {
        self.described().lines
    }

    fn described(&self) -> Lines {
        let mut lines = Lines::default();
        lines.run(&self.run);
        for (name, material) in &self.materials {
            lines.material(&format!("materials.{name}"), material);
        }
        for contact in &self.contacts {
            lines.contact(contact);
        }
        for (name, kind) in &self.bonds {
            lines.bond_kind(&format!("bonds.{name}"), kind);
        }
        for (name, body) in &self.bodies {
            lines.body(&format!("bodies.{name}"), body);
        }
        for (name, wall) in &self.walls {
            lines.wall(&format!("walls.{name}"), wall);
        }
        for (name, set) in &self.sets {
            lines.set(&format!("sets.{name}"), set);
        }
        for (name, initial) in &self.initial {
            lines.initial(&format!("initial.{name}"), initial);
        }
        for (name, support) in &self.supports {
            lines.support(&format!("supports.{name}"), support);
        }
        for (name, load) in &self.loads {
            lines.load(&format!("loads.{name}"), load);
        }
        for (name, region) in &self.regions {
            lines.region(&format!("regions.{name}"), region);
        }
        for (name, replacement) in &self.replacement {
            lines.replacement(&format!("replacement.{name}"), replacement);
        }
        for (name, inlet) in &self.inlets {
            lines.inlet(&format!("inlets.{name}"), inlet);
        }
        for (name, outlet) in &self.outlets {
            lines.outlet(&format!("outlets.{name}"), outlet);
        }
        for (name, measure) in &self.measures {
            lines.measure(&format!("measures.{name}"), measure);
        }
        lines.about_contacts(self);
        match &self.output {
            Some(output) => lines.output(output),
            None => lines.add("output", "none"),
        }
        if let Some(test) = &self.test {
            lines.test(test);
        }
        lines
    }
}

/// Keys and values, in order.
#[derive(Default)]
struct Lines {
    lines: Vec<(String, String)>,
}

impl Lines {
    fn add(&mut self, key: impl Into<String>, value: impl Into<String>) {
        self.lines.push((key.into(), value.into()));
    }

    fn aligned(&self) -> String {
        let width = self.lines.iter().map(|(key, _)| key.len()).max();
        let width = width.unwrap_or_default();
        let mut text = String::new();
        for (key, value) in &self.lines {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{key:width$}   {}", visible(value));
        }
        text
    }

    fn run(&mut self, run: &Run) {
        let end = Some(run.end_time_s).filter(|end| end.is_finite());
        self.add("run.end_time", optional(end, "s", "that of the test"));
        self.add("run.integrator", word(&INTEGRATORS, run.integrator));
        self.add("run.rest", optional(run.rest, "", "never"));
        self.add("run.time_step", optional(run.time_step_s, "s", "auto"));
        self.add("run.safety", number(run.safety));
        self.add("run.adaptive", run.adaptive.to_string());
        self.add("run.gravity", vector(run.gravity_m_s2, "m/s2"));
        self.add("run.particle_damping", number(run.particle_damping));
        self.add("run.seed", run.seed.to_string());
        let start = word(&START_OVERLAPS, run.start_overlap);
        self.add("run.start_overlap", start);
    }

    fn material(&mut self, path: &str, material: &Material) {
        if material.rigid {
            return self.add(format!("{path}.rigid"), "true");
        }
        self.add(
            format!("{path}.density"),
            optional(material.density_kg_m3, "kg/m3", "from the body's file"),
        );
        self.add(
            format!("{path}.young_modulus"),
            optional(material.young_modulus_pa, "Pa", "none"),
        );
        self.add(
            format!("{path}.poisson_ratio"),
            number(material.poisson_ratio),
        );
    }

    fn bond_kind(&mut self, path: &str, kind: &BondKind) {
        let (model, detail) = match kind.model {
            BondModel::Parallel { kappa } => {
                let kappa = kappa.unwrap_or(2.0 * (1.0 + kind.poisson_ratio));
                ("parallel", Some(("kappa", kappa)))
            }
            BondModel::EulerBernoulli => ("euler-bernoulli", None),
            BondModel::Timoshenko => ("timoshenko", None),
            BondModel::ElasticSolid => ("elastic-solid", None),
            BondModel::ShearCoefficient { alpha } => {
                ("shear-coefficient", Some(("shear_coefficient", alpha)))
            }
        };
        self.add(format!("{path}.model"), model);
        if let Some((key, of_model)) = detail {
            self.add(format!("{path}.{key}"), number(of_model));
        }
        let formulation = match kind.formulation {
            Formulation::Total => "total",
            Formulation::Incremental => "incremental",
        };
        self.add(format!("{path}.formulation"), formulation);
        self.add(
            format!("{path}.young_modulus"),
            value(kind.young_modulus_pa, "Pa"),
        );
        self.add(format!("{path}.poisson_ratio"), number(kind.poisson_ratio));
        self.add(
            format!("{path}.radius_factor"),
            optional(kind.radius_factor, "", "radii of the body"),
        );
        let damping = &kind.damping;
        self.add(format!("{path}.damping.viscous"), number(damping.viscous));
        self.add(
            format!("{path}.damping.each_mode"),
            damping.each_mode.to_string(),
        );
        self.add(
            format!("{path}.damping.force"),
            value(damping.force_n_s_m, "N s/m"),
        );
        self.add(format!("{path}.damping.torque"), number(damping.torque));
        let failure = &kind.failure;
        for (key, limit, unit) in [
            ("tension", failure.tension_pa, "Pa"),
            ("compression", failure.compression_pa, "Pa"),
            ("shear", failure.shear_pa, "Pa"),
            ("von_mises", failure.von_mises_pa, "Pa"),
            (
                "rate_strengthening",
                failure.rate_strengthening_from_1_s,
                "1/s",
            ),
            ("weibull_modulus", failure.weibull_modulus, ""),
        ] {
            self.add(
                format!("{path}.failure.{key}"),
                optional(limit, unit, "none"),
            );
        }
        let rate_of = RATES.iter().find(|(_, of)| *of == failure.rate_of);
        self.add(
            format!("{path}.failure.rate_of"),
            rate_of.map_or("", |(name, _)| name).to_owned(),
        );
    }

    fn body(&mut self, path: &str, body: &BodyEntry) {
        match &body.source {
            BodySource::File(file) => {
                self.add(format!("{path}.file"), file.display().to_string());
            }
            BodySource::Inline { particles, bonds } => {
                self.add(
                    format!("{path}.particles"),
                    format!("{} in the scene", particles.len()),
                );
                self.add(
                    format!("{path}.bond_list"),
                    format!("{} in the scene", bonds.len()),
                );
            }
        }
        self.add(format!("{path}.material"), body.material.clone());
        match body.whole_mass {
            Some(WholeMass::Density(density)) => {
                self.add(format!("{path}.body_density"), value(density, "kg/m3"));
            }
            Some(WholeMass::Mass(mass)) => self.add(format!("{path}.mass"), value(mass, "kg")),
            None => self.add(format!("{path}.mass"), "that of its particles"),
        }
        let bonds = body.bond_kind.as_deref().unwrap_or("none");
        self.add(format!("{path}.bonds"), bonds);
        for (key, components, unit) in [
            ("position", body.position_m, "m"),
            ("rotation", body.rotation_rad, "rad"),
            ("velocity", body.velocity_m_s, "m/s"),
            ("angular_velocity", body.angular_velocity_rad_s, "rad/s"),
        ] {
            self.add(format!("{path}.{key}"), vector(components, unit));
        }
        self.start_as(path, body.start_as);
    }

    fn set(&mut self, path: &str, set: &ParticleSet) {
        let body = set.body.as_deref().unwrap_or("all");
        self.add(format!("{path}.body"), body);
        match &set.pick {
            Pick::All => self.add(format!("{path}.all"), "true"),
            Pick::Particles(picked) => {
                let listed: Vec<String> = picked.iter().take(LISTED).map(u32::to_string).collect();
                let mut text = listed.join(", ");
                if picked.len() > LISTED {
                    let _ = write!(text, ", ... ({} in all)", picked.len());
                }
                self.add(format!("{path}.particles"), text);
            }
            Pick::Box { min, max } => {
                self.add(format!("{path}.box.min"), vector(*min, "m"));
                self.add(format!("{path}.box.max"), vector(*max, "m"));
            }
            Pick::Sphere { centre, radius } => {
                self.add(format!("{path}.sphere.centre"), vector(*centre, "m"));
                self.add(format!("{path}.sphere.radius"), value(*radius, "m"));
            }
        }
    }

    fn initial(&mut self, path: &str, initial: &Initial) {
        self.add(format!("{path}.of"), initial.of.clone());
        for (key, components, unit) in [
            ("velocity", initial.velocity_m_s, "m/s"),
            ("angular_velocity", initial.angular_velocity_rad_s, "rad/s"),
            ("displacement", initial.displacement_m, "m"),
        ] {
            self.add(format!("{path}.{key}"), vector(components, unit));
        }
    }

    fn support(&mut self, path: &str, support: &Support) {
        self.add(format!("{path}.of"), support.of.clone());
        for (at, (freedom, hold)) in FREEDOMS.iter().zip(&support.holds).enumerate() {
            let text = match hold {
                None => "free".to_owned(),
                Some(Hold::Fixed) => "fixed".to_owned(),
                Some(Hold::Velocity(velocity)) => {
                    let unit = if at < 3 { "m/s" } else { "rad/s" };
                    format!("velocity {}", value(*velocity, unit))
                }
                Some(Hold::Displacement(displacement)) => {
                    let unit = if at < 3 { "m" } else { "rad" };
                    format!("displacement {}", value(*displacement, unit))
                }
            };
            self.add(format!("{path}.{freedom}"), text);
        }
        self.factor(path, &support.factor);
        self.add(format!("{path}.end"), optional(support.end_s, "s", "never"));
    }

    fn load(&mut self, path: &str, load: &Load) {
        self.add(format!("{path}.of"), load.of.clone());
        self.add(format!("{path}.force"), vector(load.force_n, "N"));
        self.add(format!("{path}.torque"), vector(load.torque_n_m, "N m"));
        self.factor(path, &load.factor);
        self.add(format!("{path}.end"), optional(load.end_s, "s", "never"));
    }

    fn factor(&mut self, path: &str, factor: &Factor) {
        match factor {
            Factor::One => self.add(format!("{path}.factor"), "1"),
            Factor::Ramp { until_s } => self.add(format!("{path}.ramp"), value(*until_s, "s")),
            Factor::Table(points) => {
                let shown = points.iter().take(LISTED);
                let listed: Vec<String> = shown
                    .map(|[time, factor]| format!("{}: {}", value(*time, "s"), number(*factor)))
                    .collect();
                let mut text = listed.join(", ");
                if points.len() > LISTED {
                    let _ = write!(text, ", ... ({} in all)", points.len());
                }
                self.add(format!("{path}.table"), text);
            }
        }
    }

    fn measure(&mut self, path: &str, measure: &Measure) {
        let unit = measure.quantity.dimension().si;
        self.add(format!("{path}.of"), measure.of.clone());
        self.add(format!("{path}.quantity"), measure.quantity.name());
        if let Some(with) = &measure.with {
            self.add(format!("{path}.with"), with.clone());
        }
        self.add(format!("{path}.at"), word(&TIMES, measure.at));
        self.add(
            format!("{path}.reference"),
            optional(measure.reference, unit, "none"),
        );
        self.add(
            format!("{path}.tolerance"),
            optional(measure.tolerance, "", "none"),
        );
        self.add(
            format!("{path}.tolerance_absolute"),
            optional(measure.tolerance_absolute, unit, "none"),
        );
    }

    fn output(&mut self, output: &Output) {
        let folder = output.folder.as_ref();
        self.add(
            "output.folder",
            folder.map_or_else(
                || "the scene's name with -out".to_owned(),
                |folder| folder.display().to_string(),
            ),
        );
        self.add(
            "output.frames",
            optional(output.frames_s, "s", "first and last"),
        );
        self.add(
            "output.series",
            optional(output.series_s, "s", "a thousandth of the run"),
        );
        self.add("output.pictures", optional(output.pictures_s, "s", "none"));
        self.add(
            "output.view.from",
            output.view_from.map_or_else(
                || "front, right and above".to_owned(),
                |from| vector(from, ""),
            ),
        );
        self.add(
            "output.checkpoint",
            optional(output.checkpoint_s, "s", "at the end"),
        );
    }
}

/// The word that stands for `meant` in a scene.
fn word<T: PartialEq>(known: &[(&'static str, T)], meant: T) -> &'static str {
    let found = known.iter().find(|(_, other)| *other == meant);
    found.map_or("", |(word, _)| *word)
}

/// A number with at most 12 digits, which hides the rounding of units.
fn number(number: f64) -> String {
    let rounded: f64 = format!("{number:.11e}").parse().unwrap_or(number);
    if rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

fn value(of: f64, unit: &str) -> String {
    format!("{} {unit}", number(of)).trim_end().to_owned()
}

fn optional(given: Option<f64>, unit: &str, otherwise: &str) -> String {
    given.map_or_else(|| otherwise.to_owned(), |given| value(given, unit))
}

fn vector(components: [f64; 3], unit: &str) -> String {
    let listed = components.map(number).join(", ");
    format!("[{listed}] {unit}").trim_end().to_owned()
}
