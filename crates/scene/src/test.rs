//! `[test]`: a laboratory test, quasi-static or dynamic.

mod confined;
mod dynamic;
mod targets;

pub use confined::{Confinement, NormalStress};
pub use dynamic::{Bars, Gauges, Weight};
pub use targets::MeasuredReference;
use targets::targets;

use std::collections::BTreeMap;
use std::ops::Bound::{Included, Unbounded};

use super::field::Field;
use super::group::ParticleGroup;
use super::listing::Listing;
use super::names::suggestion;
use super::presence::Presence;
use super::run::{Integrator, Run};
use super::schema::{Key, Kind, table_schema, words_of};
use super::support::Support;
use super::table::Table;
use super::wall::{Wall, WallMotion};
use dem_io::diagnostic::Result;
use dem_io::units::{AREA, LENGTH, STRESS, VELOCITY, show_quantity};
use std::path::Path;

use super::paths::named_path;
use dem_laboratory::{Dimensions, MeasuredMaterial, TestType, read_material};

table_schema! {
    /// A laboratory test. `run.end_time` is then optional.
    pub(super) static TEST = "[test]";

    /// Type of test.
    new("type", Kind::Word(|| words_of(&TestType::NAMES))).required("\"four-point-bending\"");
    /// Body under test.
    text("body", "a name in [bodies]").otherwise("the only one");
    /// Walls that load the body and have no other motion; for tension, groups that are gripped and
    /// pulled; for direct shear, the half of the body that is driven.
    new(
        "crosshead",
        Kind::List(&Kind::Text("a name in [walls], for tension and direct shear in [groups]"))
    )
    .required("[\"NAME\"], walls that load the body");
    /// Direction of loading; for tension, direct shear and triaxial compression along x, y or z.
    /// Its length does not matter.
    new("direction", Kind::Direction("a direction")).required("[0, 0, -1], in which they move");
    /// Maximum travel of the crosshead or of the weight; the run ends early when the body has
    /// broken, or when the weight has come back. Not for bars.
    quantity("stroke", &LENGTH).positive().sometimes_required("\"4 mm\"");
    /// Crosshead velocity; with `auto` the stroke takes `periods`.
    new("rate", Kind::Auto(&VELOCITY))
        .positive()
        .remedy("write \"auto\" or a velocity such as \"0.2 mm/s\"")
        .or_word("auto");
    /// Duration of the stroke in periods of the body's lowest natural frequency.
    number("periods")
        .within(Included(1.0), Unbounded)
        .remedy("a usual value is 20: more are slower, and nearer to rest")
        .or(20.0);
    /// Repeat the test at twice the rate and compare.
    flag("rate_check", true);
    /// Young's modulus of the entire body, for comparison.
    quantity("young_modulus", &STRESS).positive();
    /// Poisson's ratio of the entire body, for its shear in bending.
    poisson_ratio().or(0.3);
    /// Strength of the entire body, for comparison.
    quantity("strength", &STRESS).positive();
    /// Measured material: its modulus and strength are the reference values unless `young_modulus`
    /// and `strength` are given, above which a file stands that `--set` names. Its mean curve is
    /// drawn with the simulated one.
    text("measured", "a file written by dem-run lab");
    /// End of the bar behind the body, whose bar in front of it is the crosshead: a wall, or for
    /// tension a group.
    text("transmission_bar", "a name in [walls], for tension in [groups]")
        .sometimes_required("\"NAME\"");
    /// The two bars of a split-Hopkinson test.
    table("bars", &dynamic::BARS)
        .sometimes_required("{ density = \"7850 kg/m3\", young_modulus = \"210 GPa\", diameter = \"20 mm\" }");
    /// The striker of a split-Hopkinson test.
    table("striker", &dynamic::STRIKER)
        .sometimes_required("{ length = \"200 mm\", velocity = \"10 m/s\" }");
    /// The weight of a drop-weight test: the crosshead.
    table("weight", &dynamic::WEIGHT).sometimes_required("{ mass = \"5 kg\", height = \"0.5 m\" }");
    /// Planes on the sides of a triaxial test, in one or two opposite pairs, without another
    /// motion.
    new("lateral_walls", Kind::List(&Kind::Text("a name in [walls]")))
        .sometimes_required("[\"left\", \"right\", \"front\", \"back\"]");
    /// Pressure that these walls keep on the sides of the body.
    quantity("confining_pressure", &STRESS).positive().sometimes_required("\"1 MPa\"");
    /// Stress on the plane of a direct shear test, kept constant: the driven half is pressed with
    /// it times the area.
    quantity("normal_stress", &STRESS).not_negative().sometimes_required("\"50 kPa\"");
    /// Direction in which the driven half is pressed, square to `direction`, along x, y or z. Its
    /// length does not matter.
    new("normal", Kind::Direction("a direction")).sometimes_required("[0, 0, -1]");
    /// Distance between the supports of a beam.
    size("support_span");
    /// Distance between the two loading pins.
    size("loading_span");
    /// Width of a beam, or thickness of a disc.
    size("width");
    /// Height of a beam, or diameter of a disc.
    size("height");
    /// Length of a body that is pressed or pulled; of a dog bone, that of its neck, which is
    /// required.
    size("length");
    /// Area of its cross-section, or of the shear plane; of a dog bone, that of its neck, which is
    /// required.
    quantity("area", &AREA).positive().otherwise(MEASURED);
}

const MEASURED: &str = "measured on walls and body";

impl Key {
    /// A length of the test.
    const fn size(name: &'static str, doc: &'static str) -> Self {
        Self::quantity(name, &LENGTH, doc)
            .positive()
            .otherwise(MEASURED)
    }
}

/// A test: the moving parts, their motion, and the reference values.
#[derive(Debug, Clone, PartialEq)]
pub struct Test {
    /// `type`
    pub kind: TestType,
    /// `body`: the tested body; the only one unless given.
    pub body: String,
    /// `crosshead`: walls that load, which do not move otherwise; for tension, groups that are
    /// pulled. At least one.
    pub crosshead: Vec<String>,
    /// `direction` of their motion, of length 1; for tension along x, y or z. Length 3.
    pub direction: [f64; 3],
    /// `stroke`: largest displacement of the crosshead, m; infinite for bars.
    pub stroke_m: f64,
    /// `rate`: velocity of the crosshead, m/s. None, "auto": such that the stroke takes `periods`,
    /// or the test is dynamic.
    pub rate_m_s: Option<f64>,
    /// `periods` of the body's lowest frequency, 20 unless given. At least 1.
    pub periods: f64,
    /// `rate_check`: the test is also done at twice the rate. True unless given; false for a
    /// dynamic test.
    pub rate_check: bool,
    /// `bars`, `striker` and `transmission_bar` of a split-Hopkinson test.
    pub bars: Option<Bars>,
    /// `weight` of a drop-weight test.
    pub weight: Option<Weight>,
    /// `lateral_walls` and `confining_pressure` of a triaxial test.
    pub confinement: Option<Confinement>,
    /// `normal_stress` and `normal` of a direct shear test.
    pub normal_stress: Option<NormalStress>,
    /// `young_modulus`: target modulus of the entire body, Pa. None: not compared.
    pub young_modulus_pa: Option<f64>,
    /// `poisson_ratio` of the entire body, for its shear in bending; 0.3 unless given.
    pub poisson_ratio: f64,
    /// `strength`: target strength of the entire body, by the formula of the test, Pa. None: not
    /// compared.
    pub strength_pa: Option<f64>,
    /// `measured`: the measured material of the test. None: nothing is compared with a curve.
    pub measured: Option<MeasuredReference>,
    /// `support_span` between the supports of a beam, m. None: that of the walls.
    pub support_span_m: Option<f64>,
    /// `loading_span` between the two loading pins, m. None: that of the walls.
    pub loading_span_m: Option<f64>,
    /// `width` of a beam, or thickness of a disc, m. None: that of the body.
    pub width_m: Option<f64>,
    /// `height` of a beam, or diameter of a disc, m. None: that of the body.
    pub height_m: Option<f64>,
    /// `length` of a compressed or pulled body, m. None: that of the body.
    pub length_m: Option<f64>,
    /// `area` of its section, m2. None: volume of the body's shape over its length or, if no file
    /// gives a volume, the product of its other two sides.
    pub area_m2: Option<f64>,
}

/// What a test says twice: targets of its own beside those of its measured material.
pub(super) fn conflicts(field: &Field<'_>, test: Option<&Test>) -> Result<Vec<String>> {
    let table = Table::of(field, &TEST)?;
    let measured = test.and_then(|test| Some((test.kind, test.measured.as_ref()?)));
    measured.map_or(Ok(Vec::new()), |(kind, measured)| {
        targets::conflicts(&table, kind, measured)
    })
}

/// The names that a test can use.
pub(super) struct Known<'a> {
    /// Folder of the scene.
    pub(super) folder: &'a Path,
    pub(super) run: &'a Run,
    pub(super) presence: &'a Presence<'a>,
    pub(super) groups: &'a BTreeMap<String, ParticleGroup>,
    pub(super) walls: &'a BTreeMap<String, Wall>,
    pub(super) supports: &'a BTreeMap<String, Support>,
}

pub(super) fn read(field: &Field<'_>, known: &Known<'_>) -> Result<Test> {
    let table = Table::of(field, &TEST)?;
    let kind = table.need("type")?.choice(&TestType::NAMES)?;
    refuse_dimensions(&table, kind)?;
    refuse_others(&table, kind)?;
    refuse_run(&table, kind, known.run)?;
    let grips = kind.grips();
    let example = if grips {
        "[\"NAME\"], groups that are pulled"
    } else {
        "[\"NAME\"], walls that load the body"
    };
    let field = table.need_such("crosshead", example)?;
    let crosshead = all_moved(&field, grips, known)?;
    if kind.is_dynamic() && crosshead.len() > 1 {
        let limit = format!("one name, as a {} test has one", kind.name());
        return Err(field.wrong(&limit, "remove the others"));
    }
    let direction: [f64; 3] = table.read("direction")?;
    if grips && !confined::is_along_an_axis(direction) {
        let remedy = "write [1, 0, 0], [0, 1, 0], [0, 0, 1] or the opposite";
        let along = table.need("direction")?;
        return Err(along.wrong("along x, y or z, as what a support moves", remedy));
    }
    let bars = if kind.has_bars() {
        let behind = transmission(&table, &crosshead, grips, known)?;
        Some(dynamic::bars(&table, behind)?)
    } else {
        None
    };
    let weight = (kind == TestType::DropWeight)
        .then(|| dynamic::weight(&table, direction, known.run))
        .transpose()?;
    let confinement = (kind == TestType::TriaxialCompression)
        .then(|| {
            let field = table.need("lateral_walls")?;
            let names = all_moved(&field, false, known)?;
            confined::confinement(&table, names, &crosshead, direction, known.walls)
        })
        .transpose()?;
    let normal_stress = (kind == TestType::DirectShear)
        .then(|| confined::normal_stress(&table, direction))
        .transpose()?;
    if kind == TestType::DogBone {
        table.need_such("length", "\"20 mm\", that of the neck")?;
        table.need_such("area", "\"100 mm2\", that of the neck")?;
    }
    let measured = measured(&table, kind, known.folder)?;
    let [young_modulus, strength] = targets(&table, measured.as_ref())?;
    Ok(Test {
        kind,
        body: body(&table, known)?,
        crosshead,
        direction,
        stroke_m: if kind.has_bars() {
            f64::INFINITY
        } else {
            table.read("stroke")?
        },
        rate_m_s: table.read("rate")?,
        periods: table.read("periods")?,
        rate_check: !kind.is_dynamic() && table.read("rate_check")?,
        bars,
        weight,
        confinement,
        normal_stress,
        young_modulus_pa: young_modulus.taken_pa(),
        poisson_ratio: table.read("poisson_ratio")?,
        strength_pa: strength.taken_pa(),
        measured,
        support_span_m: table.read("support_span")?,
        loading_span_m: table.read("loading_span")?,
        width_m: table.read("width")?,
        height_m: table.read("height")?,
        length_m: table.read("length")?,
        area_m2: table.read("area")?,
    })
}

pub(super) fn list(test: &Test, listing: &mut Listing) {
    listing.text("type", test.kind.name());
    listing.text("body", &test.body);
    listing.text("crosshead", test.crosshead.join(", "));
    listing.value("direction", &test.direction);
    if let Some(bars) = &test.bars {
        dynamic::list_bars(bars, listing);
    } else {
        listing.value("stroke", &test.stroke_m);
    }
    if let Some(weight) = &test.weight {
        dynamic::list_weight(weight, listing);
    }
    if let Some(confinement) = &test.confinement {
        confined::list_confinement(confinement, listing);
    }
    if let Some(normal) = &test.normal_stress {
        confined::list_normal_stress(normal, listing);
    }
    if !test.kind.is_dynamic() {
        listing.value("rate", &test.rate_m_s);
        listing.value("periods", &test.periods);
        listing.value("rate_check", &test.rate_check);
    }
    listing.value("young_modulus", &test.young_modulus_pa);
    listing.value("poisson_ratio", &test.poisson_ratio);
    listing.value("strength", &test.strength_pa);
    let file = test
        .measured
        .as_ref()
        .map(|measured| measured.file.display());
    listing.text(
        "measured",
        file.map_or("none".to_owned(), |file| file.to_string()),
    );
    for (key, given) in [
        ("support_span", test.support_span_m),
        ("loading_span", test.loading_span_m),
        ("width", test.width_m),
        ("height", test.height_m),
        ("length", test.length_m),
        ("area", test.area_m2),
    ] {
        if test.kind.dimensions().contains(&key) {
            listing.value(key, &given);
        }
    }
}

/// The measured material of a test, which has to be of the same type.
fn measured(table: &Table<'_>, kind: TestType, folder: &Path) -> Result<Option<MeasuredReference>> {
    let Some(field) = table.get("measured") else {
        return Ok(None);
    };
    let file = named_path(&field, folder)?;
    let material = read_material(&file).map_err(|error| {
        field.refuse(
            format!("{}: {}: {}", field.path, error.place, error.problem),
            error.remedy,
        )
    })?;
    if material.test != kind {
        let problem = format!(
            "is of the type \"{}\", not \"{}\"",
            material.test.name(),
            kind.name()
        );
        return Err(field.fault(problem, "name a material measured in the same test"));
    }
    refuse_other_pressure(table, &field, &material)?;
    Ok(Some(MeasuredReference { file, material }))
}

/// Refuses a material that was measured under another pressure than that of the test.
fn refuse_other_pressure(
    table: &Table<'_>,
    field: &Field<'_>,
    material: &MeasuredMaterial,
) -> Result<()> {
    let (Some(name), Some(measured_pa)) =
        (material.test.pressure(), material.dimensions.pressure_pa())
    else {
        return Ok(());
    };
    let own_pa: Option<f64> = table.read(name)?;
    match own_pa {
        Some(own_pa) if (own_pa - measured_pa).abs() > SAME_PRESSURE * measured_pa => {
            let [own, measured] = [own_pa, measured_pa].map(|value| show_quantity(value, "Pa"));
            let name = name.replace('_', " ");
            let problem = format!("was measured under a {name} of {measured}, not {own}");
            Err(field.fault(problem, "name a material measured under the same"))
        }
        _ => Ok(()),
    }
}

/// Largest difference of a measured pressure from that of the test, relative to it.
const SAME_PRESSURE: f64 = 0.01;

/// Refuses dimensions that do not apply to this type of test.
fn refuse_dimensions(table: &Table<'_>, kind: TestType) -> Result<()> {
    let known = kind.dimensions();
    match table
        .given(&Dimensions::SIZES)
        .find(|(key, _)| !known.contains(key))
    {
        Some((_, field)) => {
            let problem = format!("does not apply to \"{}\"", kind.name());
            let remedy = format!("remove it; known here: {}", known.join(", "));
            Err(field.fault(problem, remedy))
        }
        None => Ok(()),
    }
}

/// Refuses the keys of other types of test.
fn refuse_others(table: &Table<'_>, kind: TestType) -> Result<()> {
    let mut others: Vec<&'static str> = Vec::new();
    if kind.is_dynamic() {
        others.extend(["rate", "periods", "rate_check", "measured"]);
    }
    if kind.has_bars() {
        others.push("stroke");
    } else {
        others.extend(["transmission_bar", "bars", "striker"]);
    }
    if kind != TestType::DropWeight {
        others.push("weight");
    }
    if kind != TestType::TriaxialCompression {
        others.extend(["lateral_walls", "confining_pressure"]);
    }
    if kind != TestType::DirectShear {
        others.extend(["normal_stress", "normal"]);
    }
    match table.given(&others).next() {
        Some((_, field)) => Err(field.fault(
            format!("does not apply to \"{}\"", kind.name()),
            "remove it",
        )),
        None => Ok(()),
    }
}

/// Refuses settings of the run with which bars and weights, or walls that keep a pressure, cannot
/// move, and of which a test takes none of its loads.
fn refuse_run(table: &Table<'_>, kind: TestType, run: &Run) -> Result<()> {
    let has_no_statics = kind.is_dynamic() || kind.has_residual();
    if run.integrator != Integrator::Static || !has_no_statics {
        return Ok(());
    }
    let problem = format!(
        "a {} test cannot be combined with run.integrator = \"static\"",
        kind.name()
    );
    Err(table.refuse(problem, "remove it"))
}

/// The end of the transmission bar: a wall at rest, or a group, other than the crosshead.
fn transmission(
    table: &Table<'_>,
    crosshead: &[String],
    grips: bool,
    known: &Known<'_>,
) -> Result<String> {
    let field = table.need("transmission_bar")?;
    let name = moved(&field, grips, known)?;
    if crosshead.contains(&name) {
        let problem = format!("is \"{name}\", which is the crosshead");
        return Err(field.fault(problem, "name what the body rests on"));
    }
    Ok(name)
}

/// The named body, or the only one.
fn body(table: &Table<'_>, known: &Known<'_>) -> Result<String> {
    let bodies = known.presence.bodies;
    if let Some(field) = table.get("body") {
        let name = field.reference(bodies.keys(), "bodies")?;
        known.presence.refuse_body(&field, &name)?;
        return Ok(name);
    }
    let mut names = bodies.keys();
    match (names.next(), names.next()) {
        (Some(only), None) => {
            known.presence.refuse_only(table, only)?;
            Ok(only.clone())
        }
        _ => {
            let problem = format!("{}.body is missing, and there are several", table.path);
            let names: Vec<&str> = bodies.keys().map(String::as_str).collect();
            Err(table.refuse(problem, format!("name one of {}", names.join(", "))))
        }
    }
}

/// The objects named by `crosshead`, each once.
fn all_moved(field: &Field<'_>, grips: bool, known: &Known<'_>) -> Result<Vec<String>> {
    let mut moves: Vec<String> = Vec::new();
    for item in field.items()? {
        let name = moved(&item, grips, known)?;
        if moves.contains(&name) {
            let problem = format!("is \"{name}\", which is in the list already");
            return Err(item.fault(problem, "remove one of them"));
        }
        moves.push(name);
    }
    Ok(moves)
}

/// The object named by an item of `crosshead`: a fixed wall, or a group without a support.
fn moved(item: &Field<'_>, grips: bool, known: &Known<'_>) -> Result<String> {
    let name = item.text()?;
    if grips {
        if !known.groups.contains_key(name) {
            let problem = format!("is \"{name}\", but no group has this name");
            let names = known.groups.keys().map(String::as_str);
            return Err(item.fault(problem, suggestion(name, names)));
        }
        if let Some((support, _)) = known.supports.iter().find(|(_, s)| s.group == name) {
            let problem = format!("is \"{name}\", which [supports.{support}] holds");
            return Err(item.fault(problem, "remove that support: the test moves the group"));
        }
        return Ok(name.to_owned());
    }
    let Some(wall) = known.walls.get(name) else {
        let problem = format!("is \"{name}\", but no wall has this name");
        let names = known.walls.keys().map(String::as_str);
        return Err(item.fault(problem, suggestion(name, names)));
    };
    if wall.motion != WallMotion::Fixed {
        let remedy = format!("take velocity, displacement or servo from [walls.{name}]");
        return Err(item.fault(format!("is \"{name}\", which moves by itself"), remedy));
    }
    Ok(name.to_owned())
}
