//! What each outlet has taken: mass, mass flow and sizes, from `discharge.csv`.

use std::collections::BTreeMap;

use dem_io::units::{show_quantity, significant};
use dem_plots::{Column, Page, Table};

/// Tonnes per hour of a kilogram per second.
const T_H: f64 = 3.6;

/// The pieces that an outlet has taken: size of the sieve that each passes, m, and mass, kg.
type Taken = Vec<[f64; 2]>;

/// Adds a row for each outlet that has taken pieces. `until_s`: length of the run.
pub(crate) fn add_outlets(page: &mut Page, discharge_csv: &str, until_s: f64) {
    let Some(outlets) = taken(discharge_csv).filter(|outlets| !outlets.is_empty()) else {
        return;
    };
    page.paragraph(
        "Discharged through each outlet; mean mass flows from the start to the end of the run:",
    );
    let names = [
        "pieces",
        "mass",
        "mean flow",
        "the same",
        "d10",
        "d50",
        "d80",
    ];
    let mut columns = vec![Column::text("outlet")];
    columns.extend(names.map(Column::number));
    let row = |(name, mut pieces): (String, Taken)| {
        pieces.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mass_kg: f64 = pieces.iter().map(|[_, mass_kg]| mass_kg).sum();
        let flow_kg_s = mass_kg / until_s;
        let mut cells = vec![
            name,
            pieces.len().to_string(),
            show_quantity(mass_kg, "kg"),
            format!("{} kg/s", significant(flow_kg_s, 3)),
            format!("{} t/h", significant(T_H * flow_kg_s, 3)),
        ];
        let sizes = [0.1, 0.5, 0.8].map(|fraction| size_m(&pieces, fraction * mass_kg));
        cells.extend(sizes.map(|size_m| show_quantity(size_m, "m")));
        cells.into()
    };
    let rows = outlets.into_iter().map(row).collect();
    page.table(&Table { columns, rows });
}

/// The pieces of each outlet. None: the table has other columns.
fn taken(csv: &str) -> Option<BTreeMap<String, Taken>> {
    let mut lines = csv.lines();
    let head: Vec<&str> = lines.next()?.split(',').collect();
    let at = |name: &str| head.iter().position(|column| *column == name);
    let [outlet, sieve, mass] = [at("outlet")?, at("sieve_m")?, at("mass_kg")?];
    let mut outlets: BTreeMap<String, Taken> = BTreeMap::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |at: usize| cells.get(at)?.parse::<f64>().ok();
        let piece = [number(sieve)?, number(mass)?];
        let name = (*cells.get(outlet)?).to_owned();
        outlets.entry(name).or_default().push(piece);
    }
    Some(outlets)
}

/// Size of the piece, from the smallest, with which the sum of the masses reaches this one, m.
fn size_m(pieces: &[[f64; 2]], mass_kg: f64) -> f64 {
    let mut sum_kg = 0.0;
    let reaches = |[_, own_kg]: &&[f64; 2]| {
        sum_kg += own_kg;
        sum_kg >= mass_kg * (1.0 - 1e-12)
    };
    let found = pieces.iter().find(reaches).or(pieces.last());
    found.map_or(f64::NAN, |[size_m, _]| *size_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_outlet_has_its_masses_flows_and_sizes() {
        let csv = "time_s,outlet,mass_kg,sieve_m\n\
            0.1,product,0.4,0.02\n0.2,spill,1,0.05\n0.3,product,0.1,0.01\n0.4,product,0.5,0.03\n";
        let mut page = Page::new("chute");
        add_outlets(&mut page, csv, 2.0);
        let html = page.html();
        for text in [
            "product", "spill", "0.5 kg/s", "1.8 t/h", "10 mm", "20 mm", "30 mm", "50 mm",
        ] {
            assert!(html.contains(text), "{text} is not in {html}");
        }
        let mut empty = Page::new("chute");
        add_outlets(&mut empty, "time_s,outlet,mass_kg,sieve_m\n", 2.0);
        assert!(!empty.html().contains("outlet"));
    }
}
