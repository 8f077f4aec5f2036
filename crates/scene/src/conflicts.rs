//! What does not go together: one table, from which scenes are refused and a page is written.

use super::field::Field;
use super::table::Table;
use super::tree::Value;
use dem_io::diagnostic::Result;
use dem_io::units::NUMBER;

/// What the keys of one table do not go with.
pub(super) struct Conflicts {
    /// The table with the keys: `bonds.*`; empty for the scene.
    pub(super) of: &'static str,
    /// The table with what they do not go with, in the same way.
    pub(super) with: &'static str,
    /// The first that applies is refused.
    pub(super) rows: &'static [Conflict],
}

/// Keys that do not go with others.
pub(super) struct Conflict(
    /// The table with the keys, within the one at hand: `run`, or `bodies.*` for each of them;
    /// empty for the table at hand itself.
    pub(super) &'static str,
    /// `KEY`, or `KEY = WORD` for this value alone. The first one is refused: of the tables of a
    /// scene in the order of the file, of the keys of a table in this order.
    pub(super) &'static [&'static str],
    /// All that has to be given, `PATH`, `PATH = WORD` or `PATH > 0`, or left out, `no PATH`.
    pub(super) &'static [&'static str],
    /// Problem: `{}` stands for the path of the key, `{with}` for that of the first it conflicts
    /// with.
    &'static str,
    /// Remedy: `{table}` stands for the path of the table with the key.
    pub(super) &'static str,
);

/// All of them, for the page.
#[rustfmt::skip]
pub(super) static ALL: [&Conflicts; 8] =
    [&STATIC, &CONTACT_BESIDE_BOND, &BESIDE_CONTACT_BESIDE_BOND, &ZONE, &BODY, &BOND, &FLAT_JOINT, &FAILURE];

const STATICS: &str = "run.integrator = static";
const NOT_STATIC: &str = "remove it, or write run.integrator = \"leapfrog\"";
const UNAVAILABLE: &str = "[{}] is not available with run.integrator = \"static\", which handles bonded bodies, loads, supports and laboratory tests only";
const IDLE: &str = "{} has no effect with run.integrator = \"static\"";
const IDLE_IN_TEST: &str = "{} has no effect on a [test] with run.integrator = \"static\"";
const OVER: &str =
    "remove it, or the whole [{table}] if it is over; or write run.integrator = \"leapfrog\"";

/// What moves, is fed, or remembers the way to its load, in a static equilibrium.
#[rustfmt::skip]
pub(super) static STATIC: Conflicts = Conflicts { of: "", with: "", rows: &[
    Conflict("", &["initial", "replacement", "inlets", "outlets", "sleep"], &[STATICS], UNAVAILABLE, NOT_STATIC),
    Conflict("", &["contacts", "walls"], &[STATICS, "no test"], UNAVAILABLE, NOT_STATIC),
    Conflict("", &["loads"], &[STATICS, "test"], IDLE_IN_TEST, NOT_STATIC),
    Conflict("walls.*", &["loads"], &[STATICS], IDLE, NOT_STATIC),
    Conflict("run", &["impact_accuracy"], &[STATICS], IDLE, NOT_STATIC),
    Conflict("run", &["gravity"], &[STATICS, "test"], IDLE_IN_TEST, NOT_STATIC),
    Conflict("supports.*", &["displacement", "velocity"], &[STATICS, "test"], IDLE_IN_TEST, NOT_STATIC),
    Conflict("supports.*", &["end"], &[STATICS], IDLE, OVER),
    Conflict("loads.*", &["end"], &[STATICS], IDLE, OVER),
    Conflict("bonds.*", &["formulation = incremental"], &[STATICS],
        "{} is \"incremental\": its forces follow from steps, of which run.integrator = \"static\" makes none",
        "write formulation = \"total\", or run.integrator = \"leapfrog\""),
    Conflict("bodies.*", &["bonded_within"], &[STATICS],
        "{} is not available with run.integrator = \"static\", which bonds all of a body", NOT_STATIC),
    Conflict("contacts.*", &["liquid_bridge"], &[STATICS],
        "{} has no part in run.integrator = \"static\", in which contacts only press", NOT_STATIC),
    Conflict("bonds.*", &["plasticity"], &[STATICS],
        "{} needs the way to a load, and run.integrator = \"static\" goes straight to its equilibrium", NOT_STATIC),
    Conflict("bonds.*", &["model = flat-joint"], &[STATICS],
        "{} is \"flat-joint\": elements fail on the way to a load, and run.integrator = \"static\" goes straight to its equilibrium",
        "take another model, or write run.integrator = \"leapfrog\""),
    Conflict("bodies.*", &["start_as = clump"], &[STATICS],
        "{} is \"clump\", and run.integrator = \"static\" has nothing to do for a rigid body",
        "write start_as = \"bonded\", or run.integrator = \"leapfrog\""),
] };

/// Contacts beside bonds in a scene without them.
#[rustfmt::skip]
pub(super) static CONTACT_BESIDE_BOND: Conflicts = Conflicts { of: "bonds.*", with: "", rows: &[
    Conflict("", &["contact_beside_bond = true"], &[STATICS],
        "{} has no part in run.integrator = \"static\", in which bonds alone act between bonded ends", NOT_STATIC),
    Conflict("", &["contact_beside_bond = true"], &["no contacts"],
        "{} needs a contact law", "add the pair of its material to [contacts]"),
] };

const TOGETHER: &str = "{} does not go together with {with}";
const BESIDE: &str = "contact_beside_bond = true";

/// Bodies that come, go, sleep or are rigid, liquid bridges and adhesion, beside contacts beside
/// bonds.
#[rustfmt::skip]
pub(super) static BESIDE_CONTACT_BESIDE_BOND: Conflicts = Conflicts { of: "", with: "bonds.*", rows: &[
    Conflict("", &["inlets", "outlets", "replacement", "sleep"], &[BESIDE], TOGETHER, "remove one of them"),
    Conflict("bodies.*", &["start_as = clump", "bonded_within"], &[BESIDE], TOGETHER, "remove one of them"),
    Conflict("contacts.*", &["liquid_bridge", "work_of_adhesion"], &[BESIDE], TOGETHER, "remove one of them"),
] };

/// A body that is bonded in a region only.
#[rustfmt::skip]
pub(super) static ZONE: Conflicts = Conflicts { of: "bodies.*", with: "", rows: &[
    Conflict("", &["bonded_within"], &["sleep"],
        "{} cannot be combined with [sleep]: bodies with rigid parts do not sleep", "remove it, or [sleep]"),
    Conflict("", &["bonded_within"], &["test"],
        "{} cannot be combined with [test]: a laboratory test bonds the whole body", "remove it, or [test]"),
    Conflict("", &["bonded_within"], &["replacement.*.daughters"],
        "{} cannot be combined with [{with}]: what a particle takes in from a rigid part is not counted",
        "remove one of the two"),
    Conflict("", &["bonded_within"], &["replacement.*.breakage"],
        "{} cannot be combined with [{with}]: what a particle takes in from a rigid part is not counted",
        "remove one of the two"),
] };

const HAS_NO_MOMENTS: &str = "{} has a strength of a moment, and the model \"pin\" has no moments";
const NO_MOMENTS: &str =
    "remove torsion_yield_strength and bending_yield_strength, or take another model";

/// Bonds that yield, soften, sum their forces step by step, or are damped.
#[rustfmt::skip]
pub(super) static BOND: Conflicts = Conflicts { of: "bonds.*", with: "bonds.*", rows: &[
    Conflict("", &["plasticity"], &["formulation = incremental"],
        "{} does not go with formulation = \"incremental\"", "write formulation = \"total\", or remove plasticity"),
    Conflict("", &["plasticity"], &["failure.fracture_energy"],
        "{} does not go with failure.fracture_energy: a bond softens or flows", "remove fracture_energy or plasticity"),
    Conflict("", &["plasticity"], &["model = pin", "plasticity.torsion_yield_strength"], HAS_NO_MOMENTS, NO_MOMENTS),
    Conflict("", &["plasticity"], &["model = pin", "plasticity.bending_yield_strength"], HAS_NO_MOMENTS, NO_MOMENTS),
    Conflict("", &["formulation = incremental"], &["failure.fracture_energy"],
        "{} does not go with failure.fracture_energy", "write formulation = \"total\", or remove fracture_energy"),
    Conflict("damping", &["per_mode"], &["no damping.damping_ratio"],
        "{} has no effect without damping_ratio", "add damping_ratio = 0.1, or remove per_mode"),
    Conflict("", &["size_correction = true"], &["no calibrated_across"],
        "{} needs calibrated_across, the spheres across with which the bonds were calibrated",
        "add it, or remove size_correction; dem-run calibrate writes it"),
] };

/// Keys that act on a section as a whole, on the elements of a flat joint.
#[rustfmt::skip]
pub(super) static FLAT_JOINT: Conflicts = Conflicts { of: "bonds.*", with: "bonds.*", rows: &[
    Conflict("", &["formulation = incremental"], &["model = flat-joint"],
        "{} does not go with the model \"flat-joint\"", "write formulation = \"total\", or take another model"),
    Conflict("", &["damping"], &["model = flat-joint", "damping.structural_damping > 0"],
        "{}.structural_damping does not go with the model \"flat-joint\"", "use damping_ratio, or take another model"),
    Conflict("", &["plasticity"], &["model = flat-joint"],
        "{} does not go with the model \"flat-joint\"", "remove it, or take another model"),
    Conflict("", &["joint_friction"], &["no failure"],
        "{} has no effect without failure", "add failure = { tensile_strength = \"1 MPa\" }, or remove joint_friction"),
] };

/// Keys of failure that need others.
#[rustfmt::skip]
pub(super) static FAILURE: Conflicts = Conflicts { of: "bonds.*.failure", with: "bonds.*.failure", rows: &[
    Conflict("", &["cohesion"], &["no friction_angle"],
        "{} needs friction_angle", "add friction_angle = \"35 deg\", or write shear_strength instead"),
    Conflict("", &["friction_angle"], &["no cohesion"],
        "{} has no effect without cohesion", "add cohesion = \"1 MPa\", or remove friction_angle"),
    Conflict("", &["equivalent_stress"], &["no von_mises_strength"],
        "{} has no effect without von_mises_strength",
        "add von_mises_strength = \"0.185 MPa\", or remove equivalent_stress"),
    Conflict("", &["strain_rate_measure"], &["no rate_strengthening"],
        "{} has no effect without rate_strengthening", "add rate_strengthening = true, or remove strain_rate_measure"),
    Conflict("", &["keeps_largest_factor = true"], &["no rate_strengthening"],
        "{} has no effect without rate_strengthening", "add rate_strengthening = true, or remove keeps_largest_factor"),
    Conflict("", &["fracture_energy"], &["no tensile_strength", "no shear_strength", "no cohesion", "no von_mises_strength"],
        "{} has no effect without tensile_strength, shear_strength, cohesion or von_mises_strength, beyond which a bond softens",
        "add tensile_strength = \"1 MPa\", or remove fracture_energy"),
] };

/// What a body weighs, where it comes from, how it starts.
#[rustfmt::skip]
pub(super) static BODY: Conflicts = Conflicts { of: "bodies.*", with: "bodies.*", rows: &[
    Conflict("", &["body_density"], &["mass"],
        "{} cannot be combined with mass", "either says what the body weighs: remove the other"),
    Conflict("", &["particles", "bond_list"], &["file"],
        "{} cannot be combined with file", "a body comes from one of them: remove the other"),
    Conflict("", &["velocity"], &["drop"],
        "{} cannot be combined with drop", "either gives the speed at the start: remove the other"),
    Conflict("", &["clump"], &["no start_as = clump"],
        "{} has no effect without start_as = \"clump\"", "add start_as = \"clump\", or remove it"),
] };

impl Conflicts {
    /// Refuses the keys of `table` that do not go with what is in `other`.
    pub(super) fn refuse(&self, table: &Table<'_>, other: &Table<'_>) -> Result<()> {
        let mut rows = self.rows.iter();
        rows.try_for_each(|row| row.refuse(table, other))
    }

    /// Refuses `key`, as it stands in these rows, if it does not go with others of its table.
    pub(super) fn refuse_key(&self, key: &str, table: &Table<'_>) -> Result<()> {
        let mut rows = self.rows.iter().filter(|row| row.1.contains(&key));
        rows.try_for_each(|row| row.refuse(table, table))
    }
}

impl Conflict {
    fn refuse(&self, table: &Table<'_>, other: &Table<'_>) -> Result<()> {
        let Self(of, keys, _, problem, remedy) = self;
        let Some(with) = self.met(other)? else {
            return Ok(());
        };
        for one in tables(table, of)? {
            if let Some(field) = first(&one, keys) {
                let problem = problem.replace("{}", &field.path).replace("{with}", &with);
                return Err(field.refuse(problem, remedy.replace("{table}", &one.path)));
            }
        }
        Ok(())
    }

    /// The path of the first that is given of what the keys do not go with, if all of it is as it
    /// says.
    fn met(&self, other: &Table<'_>) -> Result<Option<String>> {
        let mut path = None;
        for condition in self.2 {
            let (is_absent, setting) = match condition.strip_prefix("no ") {
                Some(setting) => (true, setting),
                None => (false, *condition),
            };
            let (of, key) = setting.rsplit_once('.').unwrap_or(("", setting));
            let tables = tables(other, of)?;
            let found = tables.iter().find_map(|table| given(table, key));
            if found.is_some() == is_absent {
                return Ok(None);
            }
            path = path.or(found.map(|field| field.path));
        }
        Ok(Some(path.unwrap_or_default()))
    }
}

/// The tables that `of` names within `table`.
fn tables<'a>(table: &Table<'a>, of: &str) -> Result<Vec<Table<'a>>> {
    if of.is_empty() {
        return Ok(vec![table.clone()]);
    }
    match of.strip_suffix(".*") {
        Some(name) => {
            let named = table.named(name)?;
            named.iter().map(|(_, field)| Table::any(field)).collect()
        }
        None => table.get(of).iter().map(Table::any).collect(),
    }
}

fn first<'a>(table: &Table<'a>, keys: &[&'static str]) -> Option<Field<'a>> {
    if table.path.is_empty() {
        return table.given(keys).next().map(|(_, field)| field);
    }
    keys.iter().find_map(|key| given(table, key))
}

/// The value of a key, if it is there and as `setting` says.
fn given<'a>(table: &Table<'a>, setting: &str) -> Option<Field<'a>> {
    if let Some(key) = setting.strip_suffix(" > 0") {
        let field = table.get(key)?;
        return field
            .quantity(&NUMBER)
            .ok()
            .filter(|value| *value > 0.0)
            .map(|_| field);
    }
    let Some((key, word)) = setting.split_once(" = ") else {
        return table.get(setting);
    };
    table.get(key).filter(|field| match &field.node.value {
        Value::Text(text) => text == word,
        Value::Boolean(boolean) => boolean.to_string() == word,
        _ => false,
    })
}
