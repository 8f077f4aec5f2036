//! What the run answers: measures, the laboratory test, breakage, bodies that came and went.

use dem_io::units::{show_quantity, significant};
use dem_laboratory::figure::{Figure, Source};
use dem_plots::{Column, Page, Table};
use dem_results::Summary;
use dem_results::summary::{Measured, PopulationSummary, SizeSummary, Sizes, WallSummary};

use super::outlets::add_outlets;
use super::percent::percent;
use crate::folder::Folder;

/// Results of a laboratory test.
pub(crate) fn add_test(page: &mut Page, summary: &Summary) {
    let Some(test) = &summary.test else {
        return;
    };
    page.paragraph(&format!("Answer: {}.", test.answer()));
    add_figures(page, "Results of the test", &test.figures);
    let sentences = test.sentences().into_iter();
    let sentences = sentences.map(|(name, text)| format!("{name}: {text}"));
    page.list(&sentences.collect::<Vec<String>>());
    add_figures(page, "Calibration", &test.calibration);
    add_figures(page, "Dimensions", &test.dimensions);
    let changes = &test.half_the_rate_changes;
    add_figures(page, "Changes at half the rate", changes);
}

/// Named values with their targets.
fn add_figures(page: &mut Page, title: &str, figures: &[Figure]) {
    if figures.is_empty() {
        return;
    }
    let source = |figure: &Figure| figure.theory_is.unwrap_or(Source::Target).name();
    let compared = figures.iter().filter(|figure| figure.theory.is_some());
    let mut sources: Vec<&str> = compared.map(source).collect();
    sources.sort_unstable();
    sources.dedup();
    let mut columns = vec![Column::text(""), Column::number("")];
    if let [first, ..] = sources[..] {
        let target = if sources.len() == 1 { first } else { "target" };
        columns = vec![
            Column::text(""),
            Column::number("simulated"),
            Column::number(target),
            Column::number("deviation"),
        ];
    }
    let cells = |figure: &Figure| {
        let mut cells = vec![figure.name.clone(), shown(figure.value, &figure.unit)];
        if !sources.is_empty() {
            let mut target = (figure.theory).map_or(String::new(), |at| shown(at, &figure.unit));
            if sources.len() > 1 && !target.is_empty() {
                target += match figure.theory_is {
                    Some(Source::Measured) => " (measured)",
                    Some(Source::ClosedForm) => " (closed form)",
                    _ => "",
                };
            }
            cells.push(target);
            cells.push(figure.error.map_or(String::new(), percent));
        }
        cells.into()
    };
    page.heading(title);
    page.table(&Table {
        rows: figures.iter().map(cells).collect(),
        columns,
    });
}

/// A value with its unit; empty if there is none.
fn shown(value: f64, unit: &str) -> String {
    match value.is_nan() {
        true => String::new(),
        false => show_quantity(value, unit),
    }
}

/// Measures, breakage, and bodies that came and went.
pub(crate) fn add_results(page: &mut Page, summary: &Summary, folder: &Folder) {
    page.heading("Results");
    add_measures(page, summary);
    page.table(&Table {
        columns: vec![Column::text(""), Column::number("")],
        rows: facts(summary)
            .into_iter()
            .map(|fact| fact.to_vec().into())
            .collect(),
    });
    add_walls(page, summary);
    if let Some(sizes) = &summary.sizes {
        add_sizes(page, sizes);
    }
    if let Some(discharge) = folder.text("discharge.csv") {
        let population = summary.population.as_ref();
        let fines_kg = population.map_or(0.0, |p| p.fines_kg);
        let flow_kg_s = |name: &str| population?.outlets.get(name)?.flow_kg_s;
        add_outlets(page, &discharge, flow_kg_s, fines_kg);
    }
    let distribution = folder.text("distribution.csv");
    if let Some(table) = distribution.as_deref().and_then(passing) {
        page.paragraph("Mass that passes a sieve, inside and discharged (distribution.csv):");
        page.table(&table);
        explain_mark(page, &table);
    }
}

/// Walls that move: stroke, work and mean power.
fn add_walls(page: &mut Page, summary: &Summary) {
    if summary.walls.is_empty() {
        return;
    }
    let mut columns = vec![Column::text("moving wall")];
    columns.extend(["work", "mean power"].map(Column::number));
    // Belts have none.
    let has_strokes = summary.walls.values().any(|wall| wall.stroke_m.is_some());
    if has_strokes {
        columns.push(Column::number("stroke"));
    }
    let row = |(name, wall): (&String, &WallSummary)| {
        let mut cells = vec![
            name.clone(),
            show_quantity(wall.work_j, "J"),
            show_quantity(wall.mean_power_w, "W"),
        ];
        cells.extend(wall.stroke_m.map(|stroke_m| show_quantity(stroke_m, "m")));
        cells.into()
    };
    let rows = summary.walls.iter().map(row).collect();
    page.table(&Table { columns, rows });
}

/// Sizes of the fragments: a row for each body and place.
fn add_sizes(page: &mut Page, sizes: &Sizes) {
    let all = (sizes.bodies.len() != 1).then_some(("all", &sizes.all));
    let named = sizes.bodies.iter();
    let named = named.map(|(name, places)| (name.as_str(), places));
    let mut rows = Vec::new();
    for (name, places) in named.chain(all) {
        let gone = places.contains_key("discharged");
        for (place, found) in places.iter().filter(|(place, _)| gone || *place == "both") {
            let name = if gone {
                format!("{name}, {place}")
            } else {
                name.to_owned()
            };
            rows.push(size_cells(name, found).into());
        }
    }
    if rows.is_empty() {
        return;
    }
    let mut columns = vec![Column::text("fragments")];
    columns.extend(["d50", "d80", "d10", "t10", "mass"].map(Column::number));
    let table = Table { columns, rows };
    page.table(&table);
    explain_mark(page, &table);
}

/// The mark of sizes that the spheres decide, and not the material.
const UNRESOLVED: &str = "*";

/// What the mark means, if it is in this table.
fn explain_mark(page: &mut Page, table: &Table) {
    let mut cells = table.rows.iter().flat_map(|row| &row.cells);
    if cells.any(|cell| cell.ends_with(UNRESOLVED)) {
        page.small("* unresolved: at this size the spheres decide, not the material.");
    }
}

fn size_cells(name: String, found: &SizeSummary) -> Vec<String> {
    let marked = |cell: String, is_unresolved: bool| match is_unresolved {
        true => cell + UNRESOLVED,
        false => cell,
    };
    let length = |size_m: f64| show_quantity(size_m, "m");
    let is = found.unresolved;
    let t10 = found.t10.map_or("not resolved".to_owned(), percent);
    vec![
        name,
        marked(length(found.d50_m), is.d50),
        marked(length(found.d80_m), is.d80),
        marked(length(found.d10_m), is.d10),
        marked(t10, is.t10),
        show_quantity(found.mass_kg, "kg"),
    ]
}

/// The table of `distribution.csv`: a row for each sieve, a column for each body. None: the file
/// has other columns.
fn passing(csv: &str) -> Option<Table> {
    let mut lines = csv.lines();
    let head: Vec<&str> = lines.next()?.split(',').collect();
    let at = |name: &str| head.iter().position(|column| *column == name);
    let [body, place, sieve, passing] = [
        at("body")?,
        at("location")?,
        at("sieve_m")?,
        at("passing_fraction")?,
    ];
    let resolved = at("resolved");
    let mut bodies: Vec<&str> = Vec::new();
    let mut sieves: Vec<(f64, Vec<String>)> = Vec::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        if *cells.get(place)? != "both" {
            continue;
        }
        let body = *cells.get(body)?;
        if bodies.last() != Some(&body) {
            bodies.push(body);
        }
        let sieve_m: f64 = cells.get(sieve)?.parse().ok()?;
        let fraction: f64 = cells.get(passing)?.parse().ok()?;
        let is_unresolved = resolved
            .and_then(|at| cells.get(at))
            .is_some_and(|is| *is == "0");
        let fraction = match is_unresolved {
            true => percent(fraction) + UNRESOLVED,
            false => percent(fraction),
        };
        match sieves.iter_mut().find(|(known_m, _)| *known_m == sieve_m) {
            Some((_, row)) => row.push(fraction),
            None => sieves.push((sieve_m, vec![fraction])),
        }
    }
    let mut columns = vec![Column::text("sieve")];
    columns.extend(bodies.into_iter().map(Column::number));
    let row = |(sieve_m, passes): (f64, Vec<String>)| {
        let mut cells = vec![show_quantity(sieve_m, "m")];
        cells.extend(passes);
        cells.into()
    };
    let rows = sieves.into_iter().map(row).collect();
    Some(Table { columns, rows })
}

fn add_measures(page: &mut Page, summary: &Summary) {
    let measures = &summary.measures;
    if measures.is_empty() {
        return;
    }
    let is_compared = measures.iter().any(|measure| measure.reference.is_some());
    let mut columns = vec![Column::text("measure"), Column::number("value")];
    if is_compared {
        columns.extend(["reference", "error"].map(Column::number));
    }
    let row = |measure: &Measured| {
        let value = match (measure.value.is_nan(), &measure.missing) {
            (true, Some(missing)) => missing.clone(),
            _ => shown(measure.value, &measure.unit),
        };
        let mut cells = vec![measure.name.replace('_', " "), value];
        if is_compared {
            let reference = measure.reference;
            cells.push(reference.map_or(String::new(), |at| shown(at, &measure.unit)));
            let error = measure.error;
            cells.push(error.map_or(String::new(), |error| significant(error, 2)));
        }
        cells.into()
    };
    let rows = measures.iter().map(row).collect();
    page.table(&Table { columns, rows });
}

/// Counts and masses with their names.
fn facts(summary: &Summary) -> Vec<[String; 2]> {
    let mut facts = vec![["broken bonds".to_owned(), summary.broken_bonds.to_string()]];
    let mut add = |name: &str, value: String| facts.push([name.to_owned(), value]);
    for (how, count) in summary.broken_by_cause.phrased() {
        add(&format!("broken {how}"), count.to_string());
    }
    let population = summary.population.as_ref();
    if let Some(fragments) = &summary.fragments {
        add("fragments", fragments.count.to_string());
        if population.is_some_and(|all| all.discharged > 0) {
            add("fragments inside at the end", fragments.inside.to_string());
        }
        // A measure of the scene may be the same.
        let largest = fragments.mass_fraction_of_largest;
        let is_largest = |measure: &Measured| {
            let key = format!("measures.{}.quantity", measure.name);
            let asked = (key, "mass_fraction_of_largest".to_owned());
            measure.value == largest && summary.inputs.scene.contains(&asked)
        };
        if !summary.measures.iter().any(is_largest) {
            add(
                "largest fragment, share of the mass of all",
                percent(largest),
            );
        }
    }
    if let Some(population) = population {
        add_population(population, &mut add);
    }
    facts
}

/// Bodies that came and went.
fn add_population(population: &PopulationSummary, add: &mut dyn FnMut(&str, String)) {
    let bodies = |count: u32, mass_kg: f64| format!("{count} ({})", show_quantity(mass_kg, "kg"));
    if population.fed > 0 {
        add("bodies fed", bodies(population.fed, population.fed_kg));
    }
    if population.replaced_by_daughters > 0 {
        let count = population.replaced_by_daughters;
        add("particles replaced by daughters", count.to_string());
        if population.fines_kg > 0.0 {
            let fines = show_quantity(population.fines_kg, "kg");
            add("fines, too small to be made", fines);
        }
    } else if population.replaced > 0 || population.released == 0 {
        let count = population.replaced;
        add("clumps replaced by clusters", count.to_string());
    }
    if population.released > 0 {
        let count = population.released;
        add("spheres released from rigid parts", count.to_string());
    }
    if population.restored > 0 {
        add("restored to clumps", population.restored.to_string());
    }
    if population.discharged > 0 {
        let discharged = bodies(population.discharged, population.discharged_kg);
        add("bodies and fragments discharged", discharged);
    }
    if population.outlets.len() > 1 {
        for (name, outlet) in &population.outlets {
            let gone = bodies(outlet.bodies, outlet.mass_kg);
            add(&format!("of them through {name}"), gone);
        }
    }
    let skipped = percent(population.bond_updates_skipped);
    add("bond updates skipped", skipped);
}
