//! doc/process.md: the process with and without replacement, and its mass flows.

use std::collections::BTreeMap;
use std::path::PathBuf;

use dem_io::body::read_body;

use crate::bench::{Bench, Failed, ONE_THREAD, Run, body, sets};
use crate::cells::mean;
use crate::table::{Table, write};

/// Cakes and lumps can break: bodies, and their shapes.
const BREAKABLE: [(&str, &str); 2] = [("cake", "filter-cake"), ("lump", "bar")];
/// How they are bonded: words, and the text of their `[replacement]`.
const WAYS: [(&str, &str); 5] = [
    ("rigid throughout", "{ when = { time = \"1000 s\" } }"),
    (
        "replaced from the first touch or a hard hit on, until no bond breaks, as in the scene",
        "{ when = { touches = \"plate\", principal_stress = \"100 kPa\" }, restore = { unbroken_for = \"5 ms\", min_particles = 2, strain_energy = \"0.1 J/kg\", fluctuation_velocity = \"0.2 m/s\" } }",
    ),
    (
        "replaced at the plate, and restored behind it",
        "{ when = { enters = \"impact\" }, restore = { leaves = \"impact\", min_particles = 2, strain_energy = \"1 J/kg\", fluctuation_velocity = \"0.2 m/s\" } }",
    ),
    (
        "replaced at the plate",
        "{ when = { enters = \"impact\" } }",
    ),
    ("bonded from the start", "{ when = { time = 0 } }"),
];
/// Diameters of their spheres in the comparison of ways, and in the runs with 300 bodies.
const OF_WAYS: &str = "12mm..15mm";
const OF_MINUTE: &str = "15mm..18mm";
/// All take the soft cake of the thesis, and as soft a rock, for long steps.
const CAKE: &str = "--material=data/materials/filter-cake-table-2.toml";
const SOFT: [&str; 2] = [
    "run.impact_accuracy=0.02",
    "materials.rock.shear_modulus=\"10 MPa\"",
];
/// The runs with 300 bodies: their product belts, and what else they set.
const PRODUCT_BELTS: [&str; 2] = ["0.1 m/s", "20 mm/s"];
const MINUTE: [&str; 5] = [
    "run.end_time=\"60 s\"",
    "measures.mixing={of=\"cake\",with=\"rock\",quantity=\"mixing_index\",within=\"on-product-belt\",cell_size=\"0.3 m\"}",
    "output.frames=\"5 s\"",
    "output.series=\"0.1 s\"",
    "output.pictures=\"2 s\"",
];
/// Its belts: speeds, m/s, and lengths of their regions, m.
const BELTS: [(&str, f64, f64); 2] = [
    ("mass_on_belt", 3.0, 0.7),
    ("mass_on_product_belt", 0.1, 0.4),
];
/// Its steady part, s: whole periods of all inlets.
const STEADY_S: [f64; 2] = [20.0, 60.0];
/// Bodies, and how many of them the inlets of the scene feed per second.
const FED: [(&str, f64); 3] = [("cake", 1.5), ("lump", 1.5), ("rock", 2.0)];
/// Rows of the runs with 300 bodies.
const ROWS: [&str; 13] = [
    "processor time, one thread",
    "steps",
    "bodies fed",
    "bodies and pieces inside at the end",
    "their mass, over that of a mean body",
    "pieces discharged",
    "bonds broken",
    "cake: d10, d50, d80",
    "lump: d10, d50, d80",
    "Lacey's index at the end",
    "largest overlap, of the smaller radius",
    "energy error",
    "fed, less left and inside",
];

/// Ways with and without the DIF; without breakage it counts for nothing.
fn ways() -> impl Iterator<Item = (usize, bool)> {
    let all = (0..WAYS.len()).flat_map(|way| [(way, true), (way, false)]);
    all.filter(|case| *case != (0, false))
}

pub(crate) fn tables() -> [Table; 3] {
    let of =
        |head, first_cells: Vec<String>| Table::new("doc/process.md", "process", head, first_cells);
    let of_ways = "cakes and lumps are | DIF | processor time | bonds broken | pieces | \
        cake: d10, d50, d80, mm | lump: d10, d50, d80, mm | left with the product | \
        energy error";
    let minute = "a minute of the process | product belt 0.1 m/s | product belt 20 mm/s";
    let mut flows = ["fed: cakes and lumps, rates times masses", "fed: rock"]
        .map(str::to_owned)
        .to_vec();
    flows.extend(BELTS.map(|(measure, speed_m_s, length_m)| {
        format!("`{measure}` over {length_m} m, times {speed_m_s} m/s")
    }));
    let left = [": cake", ": lump", ": rock", ", in all"];
    flows.extend(left.map(|what| format!("discharged through `product`{what}")));
    [
        of(
            of_ways,
            ways().map(|(way, _)| WAYS[way].0.to_owned()).collect(),
        ),
        of(minute, ROWS.map(str::to_owned).to_vec()),
        of("mass flow | kg/s", flows),
    ]
}

/// The bodies of spheres with these diameters.
fn packed(bench: &Bench, diameters: &str) -> Result<[PathBuf; 2], Failed> {
    let option = format!("--diameter={diameters}");
    let options = [&option, "--overlap=0.25", "--bond-range=1.1", "--seed=3"];
    let [cake, lump] =
        BREAKABLE.map(|(body, shape)| bench.pack(&format!("{body}-{diameters}"), shape, &options));
    Ok([cake?, lump?])
}

/// Runs the scene with these bodies and values on one thread.
fn run(bench: &Bench, name: &str, files: &[PathBuf; 2], set: &[String]) -> Result<Run, Failed> {
    let mut options = sets(set);
    options.extend(sets(&SOFT));
    options.push(CAKE.to_owned());
    for ((name, _), file) in BREAKABLE.iter().zip(files) {
        options.push(body(name, file));
    }
    options.push(ONE_THREAD.to_owned());
    bench.run(name, "data/scenes/process.toml", &options)
}

pub(crate) fn process(bench: &Bench) -> Result<(), Failed> {
    let [mut of_ways, mut of_minute, mut of_flows] = tables();
    let files = packed(bench, OF_WAYS)?;
    for (way, has_dif) in ways() {
        let mut set = BREAKABLE
            .map(|(body, _)| format!("replacement.{body}={}", WAYS[way].1))
            .to_vec();
        if !has_dif {
            set.push("bonds.cake.failure.rate_strengthening=false".to_owned());
        }
        let found = run(bench, &format!("way-{way}-{has_dif}"), &files, &set)?;
        of_ways.row([
            if has_dif { "yes" } else { "no" }.to_owned(),
            format!("{:.0} s", found.processor_s()),
            broken(&found, &files)?,
            found.fragments().count.to_string(),
            sizes(&found, "cake"),
            sizes(&found, "lump"),
            format!("{:.1} kg", product_kg(&found)),
            format!("{:.1e}", found.summary.energy_error),
        ]);
    }
    let files = packed(bench, OF_MINUTE)?;
    let [fast, slow] = PRODUCT_BELTS.map(|speed| {
        let mut set = MINUTE.map(str::to_owned).to_vec();
        set.push(format!(
            "walls.product-belt.surface_velocity=[\"{speed}\",0,0]"
        ));
        let name = format!("minute-{}", speed.replace([' ', '/'], "-"));
        run(bench, &name, &files, &set)
    });
    let [fast, slow] = [fast?, slow?];
    for (fast, slow) in minute(&fast).into_iter().zip(minute(&slow)) {
        of_minute.row([fast, slow]);
    }
    for flow_kg_s in flows_kg_s(&fast)? {
        of_flows.row([format!("{flow_kg_s:.3}")]);
    }
    write(&[of_ways, of_minute, of_flows])
}

/// Broken bonds of a run, and their fraction of the bonds of all bodies fed.
fn broken(run: &Run, files: &[PathBuf; 2]) -> Result<String, Failed> {
    let mut bonds = 0.0;
    for ((body, _), file) in BREAKABLE.iter().zip(files) {
        let own = read_body(file)?.bonds.len() as f64;
        let flow = run
            .summary
            .flows
            .as_ref()
            .and_then(|flows| flows.get(*body));
        bonds += own * flow.map_or(f64::NAN, |flow| f64::from(flow.fed));
    }
    let broken = run.summary.broken_bonds as f64;
    Ok(format!("{broken:.0} ({:.0} %)", 100.0 * broken / bonds))
}

/// Mass that has left through the outlet of the product, kg.
fn product_kg(run: &Run) -> f64 {
    let population = run.summary.population.as_ref();
    let outlet = population.and_then(|all| all.outlets.get("product"));
    outlet.map_or(f64::NAN, |outlet| outlet.mass_kg)
}

/// d10, d50 and d80 of all its pieces of a body, mm.
fn sizes(run: &Run, body: &str) -> String {
    let all = run.summary.sizes.as_ref();
    let all = all.and_then(|sizes| sizes.bodies.get(body)?.get("both"));
    let all = all.copied().unwrap_or_default();
    let sizes_m = [all.d10_m, all.d50_m, all.d80_m];
    sizes_m
        .map(|size_m| format!("{:.0}", 1e3 * size_m))
        .join(", ")
}

/// The column of a run with 300 bodies.
fn minute(run: &Run) -> [String; 13] {
    let summary = &run.summary;
    let population = summary.population.clone().unwrap_or_default();
    let flows = || summary.flows.iter().flat_map(|flows| flows.values());
    let inside_kg: f64 = flows().map(|flow| flow.inside_kg).sum();
    let missing_kg = flows().map(|flow| flow.missing_kg.unwrap_or(f64::NAN).abs());
    let mean_kg = population.fed_kg / f64::from(population.fed);
    [
        format!("{:.1} min", run.processor_s() / 60.0),
        summary.steps.to_string(),
        population.fed.to_string(),
        run.fragments().inside.to_string(),
        format!("{:.0}", inside_kg / mean_kg),
        population.discharged.to_string(),
        summary.broken_bonds.to_string(),
        format!("{} mm", sizes(run, "cake")),
        format!("{} mm", sizes(run, "lump")),
        format!("{:.2}", run.measured("mixing").unwrap_or(f64::NAN)),
        format!("{:.2}", summary.largest_overlap),
        format!("{:.1e}", summary.energy_error),
        format!("{:.1e} kg", missing_kg.sum::<f64>()),
    ]
}

/// Mass flows of the steady part of a run, kg/s, in the order of their rows.
fn flows_kg_s(run: &Run) -> Result<Vec<f64>, Failed> {
    let [from_s, to_s] = STEADY_S;
    let [cake, lump, rock] = FED.map(|(body, rate_1_s)| {
        rate_1_s
            * run
                .summary
                .bodies
                .get(body)
                .map_or(f64::NAN, |mass| mass.mass_kg)
    });
    let mut flows = vec![cake + lump, rock];
    for (measure, speed_m_s, length_m) in BELTS {
        let rows = run.columns("series.csv", ["time_s", &format!("{measure}_kg")])?;
        let steady = rows
            .iter()
            .filter(|[time_s, _]| (from_s..to_s).contains(time_s));
        let steady: Vec<f64> = steady.map(|[_, mass_kg]| *mass_kg).collect();
        flows.push(mean(&steady) / length_m * speed_m_s);
    }
    let columns = ["time_s", "outlet", "body", "mass_kg"];
    let mut left_kg_s = BTreeMap::from(FED.map(|(body, _)| (body, 0.0)));
    for [time_s, outlet, body, mass_kg] in run.words("discharge.csv", columns)? {
        if outlet == "product" && (from_s..to_s).contains(&time_s.parse()?) {
            let left_kg_s = left_kg_s
                .get_mut(body.as_str())
                .ok_or("a body of no inlet")?;
            *left_kg_s += mass_kg.parse::<f64>()? / (to_s - from_s);
        }
    }
    flows.extend(left_kg_s.values());
    flows.push(left_kg_s.values().sum());
    Ok(flows)
}
