//! What the run answers: measures, the laboratory test, breakage, bodies that came and went.

use dem_io::units::{show_quantity, significant};
use dem_plots::{Column, Page, Table};
use serde_json::Value;

use super::values::{number, percent, text};
use crate::folder::Folder;

/// Results of a laboratory test.
pub(crate) fn add_test(page: &mut Page, summary: &Value) {
    let test = &summary["test"];
    if !test.is_object() {
        return;
    }
    add_figures(page, "Results of the test", &test["results"]);
    let sentences = test["sentences"].as_array().into_iter().flatten();
    let sentence = |said: &Value| format!("{}: {}", text(&said[0]), text(&said[1]));
    page.list(&sentences.map(sentence).collect::<Vec<String>>());
    add_figures(page, "Calibration", &test["calibration"]);
    add_figures(page, "Dimensions", &test["dimensions"]);
    add_figures(
        page,
        "Changes at half the rate",
        &test["changes_at_half_the_rate"],
    );
}

/// Named values with their targets, as `[{name, value, unit, theory, error, theory_is}]`.
fn add_figures(page: &mut Page, title: &str, figures: &Value) {
    let Some(figures) = figures.as_array().filter(|figures| !figures.is_empty()) else {
        return;
    };
    let compared = figures.iter().filter(|figure| figure["theory"].is_number());
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
    let cells = |figure: &Value| {
        let unit = text(&figure["unit"]);
        let shown = |value: &Value| {
            let value = value.as_f64();
            value.map_or(String::new(), |value| show_quantity(value, unit))
        };
        let mut cells = vec![text(&figure["name"]).to_owned(), shown(&figure["value"])];
        if !sources.is_empty() {
            let mut target = shown(&figure["theory"]);
            if sources.len() > 1 && !target.is_empty() {
                target += match source(figure) {
                    MEASURED => " (measured)",
                    CLOSED_FORM => " (closed form)",
                    _ => "",
                };
            }
            cells.push(target);
            cells.push(figure["error"].as_f64().map_or(String::new(), percent));
        }
        cells.into()
    };
    page.heading(title);
    page.table(&Table {
        rows: figures.iter().map(cells).collect(),
        columns,
    });
}

const MEASURED: &str = "target (measured)";
const CLOSED_FORM: &str = "closed form";

/// Where the expected value of a figure comes from.
fn source(figure: &Value) -> &'static str {
    match text(&figure["theory_is"]) {
        "measured" => MEASURED,
        "closed-form" => CLOSED_FORM,
        _ => "target",
    }
}

/// Measures, breakage, and bodies that came and went.
pub(crate) fn add_results(page: &mut Page, summary: &Value, folder: &Folder) {
    page.heading("Results");
    add_measures(page, summary);
    page.table(&Table {
        columns: vec![Column::text(""), Column::number("")],
        rows: facts(summary)
            .into_iter()
            .map(|fact| fact.to_vec().into())
            .collect(),
    });
    add_sizes(page, &summary["sizes"]);
    let distribution = folder.text("distribution.csv");
    if let Some(table) = distribution.as_deref().and_then(passing) {
        page.paragraph("Mass that passes a sieve, inside and discharged (distribution.csv):");
        page.table(&table);
    }
}

/// Sizes of the fragments: a row for each body and place.
fn add_sizes(page: &mut Page, sizes: &Value) {
    let bodies: Vec<(&String, &Value)> =
        sizes["bodies"].as_object().into_iter().flatten().collect();
    let is_one = bodies.len() == 1;
    let all = (!is_one).then_some(("all", &sizes["all"]));
    let named = bodies.iter().map(|(name, places)| (name.as_str(), *places));
    let mut rows = Vec::new();
    for (name, places) in named.chain(all) {
        let places = places.as_object().into_iter().flatten();
        let gone = places.clone().any(|(place, _)| place == "discharged");
        for (place, found) in places.filter(|(place, _)| gone || *place == "both") {
            let name = if gone {
                format!("{name}, {place}")
            } else {
                name.to_owned()
            };
            let length = |name: &str| show_quantity(number(&found[name]), "m");
            let t10 = found["t10"]
                .as_f64()
                .map_or("not resolved".to_owned(), percent);
            // Below some diameters of the spheres they decide, and not the material.
            let marked = |name: &str, cell: String| match found["unresolved"][name].as_bool() {
                Some(true) => format!("{cell} (unresolved)"),
                _ => cell,
            };
            let mut cells = vec![name, show_quantity(number(&found["mass_kg"]), "kg")];
            for name in ["d10", "d50", "d80"] {
                cells.push(marked(name, length(&format!("{name}_m"))));
            }
            cells.push(marked("t10", t10));
            rows.push(cells.into());
        }
    }
    if rows.is_empty() {
        return;
    }
    let mut columns = vec![Column::text("fragments")];
    columns.extend(["mass", "d10", "d50", "d80", "t10"].map(Column::number));
    page.table(&Table { columns, rows });
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
            true => format!("{} (unresolved)", percent(fraction)),
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

fn add_measures(page: &mut Page, summary: &Value) {
    let Some(measures) = summary["measures"]
        .as_object()
        .filter(|all| !all.is_empty())
    else {
        return;
    };
    let is_compared = measures
        .values()
        .any(|measure| measure["reference"].is_number());
    let mut columns = vec![Column::text("measure"), Column::number("value")];
    if is_compared {
        columns.extend(["reference", "error"].map(Column::number));
    }
    let row = |(name, measure): (&String, &Value)| {
        let unit = text(&measure["unit"]);
        let shown = |value: &Value| value.as_f64().map(|value| show_quantity(value, unit));
        let value = shown(&measure["value"]);
        let missing = || text(&measure["missing"]).to_owned();
        let mut cells = vec![name.replace('_', " "), value.unwrap_or_else(missing)];
        if is_compared {
            cells.push(shown(&measure["reference"]).unwrap_or_default());
            let error = measure["error"].as_f64();
            cells.push(error.map_or(String::new(), |error| significant(error, 2)));
        }
        cells.into()
    };
    let rows = measures.iter().map(row).collect();
    page.table(&Table { columns, rows });
}

/// Counts and masses with their names.
fn facts(summary: &Value) -> Vec<[String; 2]> {
    let mut facts = Vec::new();
    let mut add = |name: &str, value: String| facts.push([name.to_owned(), value]);
    let count = |value: &Value| value.as_u64().unwrap_or(0).to_string();
    let kilograms = |value: &Value| show_quantity(number(value), "kg");
    let broken = summary["broken_bonds"].as_u64().unwrap_or(0);
    add("broken bonds", broken.to_string());
    for (cause, number) in summary["broken_by_cause"].as_object().into_iter().flatten() {
        if number.as_u64().is_some_and(|number| number > 0) {
            let name = format!("broken by {}", cause.replace('_', " "));
            add(&name, count(number));
        }
    }
    let fragments = &summary["fragments"];
    if fragments.is_object() {
        let discharged = summary["population"]["discharged"].as_u64().unwrap_or(0);
        let [fragments_left, of_all] = match discharged {
            0 => ["fragments", "mass of the largest over that of all"],
            _ => [
                "fragments left inside",
                "mass of the largest of them over theirs",
            ],
        };
        add(fragments_left, count(&fragments["count"]));
        let largest = number(&fragments["mass_fraction_of_largest"]);
        add(of_all, percent(largest));
    }
    let population = &summary["population"];
    if population.is_object() {
        let bodies = |name: &str| {
            let mass = kilograms(&population[format!("{name}_kg")]);
            format!("{} ({mass})", count(&population[name]))
        };
        let some = |name: &str| population[name].as_u64().is_some_and(|count| count > 0);
        if some("fed") {
            add("bodies fed", bodies("fed"));
        }
        if some("replaced_by_daughters") {
            add(
                "particles replaced by daughters",
                count(&population["replaced_by_daughters"]),
            );
        } else if some("replaced") || !some("released") {
            add(
                "clumps replaced by clusters",
                count(&population["replaced"]),
            );
        }
        if some("released") {
            add(
                "spheres released from rigid parts",
                count(&population["released"]),
            );
        }
        if some("restored") {
            add("restored to clumps", count(&population["restored"]));
        }
        if some("discharged") {
            add("bodies and fragments discharged", bodies("discharged"));
        }
        let outlets = population["outlets"].as_object().into_iter().flatten();
        let outlets: Vec<(&String, &Value)> = outlets.collect();
        if outlets.len() > 1 {
            for (name, outlet) in outlets {
                let mass = kilograms(&outlet["mass_kg"]);
                add(
                    &format!("of them through {name}"),
                    format!("{} ({mass})", count(&outlet["bodies"])),
                );
            }
        }
        let skipped = number(&population["bond_updates_skipped"]);
        add("bond updates skipped", percent(skipped));
    }
    facts
}
