//! What each outlet has taken: mass, mass flow and sizes, from `discharge.csv`.

use dem_io::units::{show_quantity, significant};
use dem_plots::{Column, Page, Table};
use dem_results::{SievedPieces, discharged};

/// Tonnes per hour of a kilogram per second.
const T_H: f64 = 3.6;

/// Adds a row for each outlet that has taken pieces. `flow_kg_s`: the mass flow through one;
/// `fines_kg`: of fines that were only booked.
pub(crate) fn add_outlets(
    page: &mut Page,
    discharge_csv: &str,
    flow_kg_s: impl Fn(&str) -> Option<f64>,
    fines_kg: f64,
) {
    let Some(outlets) = discharged(discharge_csv).filter(|outlets| !outlets.is_empty()) else {
        return;
    };
    page.paragraph(
        "Discharged through each outlet; the flow is that between the first and the last tenth of its mass:",
    );
    let names = ["pieces", "mass", "flow", "the same", "d10", "d50", "d80"];
    let mut columns = vec![Column::text("outlet")];
    columns.extend(names.map(Column::number));
    let row = |(name, pieces): (String, SievedPieces)| {
        let mass_kg = pieces.mass_kg();
        let flow_kg_s = flow_kg_s(&name);
        let flow = |factor: f64, unit: &str| {
            let of = |flow_kg_s| format!("{} {unit}", significant(factor * flow_kg_s, 3));
            flow_kg_s.map_or(String::new(), of)
        };
        let mut cells = vec![
            name,
            pieces.count().to_string(),
            show_quantity(mass_kg, "kg"),
            flow(1.0, "kg/s"),
            flow(T_H, "t/h"),
        ];
        let sizes_m = [0.1, 0.5, 0.8].map(|fraction| pieces.size_m(fraction));
        cells.extend(sizes_m.map(|size_m| show_quantity(size_m.unwrap_or(f64::NAN), "m")));
        cells.into()
    };
    let rows = outlets.into_iter().map(row).collect();
    page.table(&Table { columns, rows });
    if fines_kg > 0.0 {
        let fines = show_quantity(fines_kg, "kg");
        page.small(&format!(
            "Pieces only: {fines} of fines, too small to be followed, are in no row."
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_outlet_has_its_masses_flows_and_sizes() {
        let csv = "time_s,outlet,mass_kg,sieve_m\n\
            0.1,product,0.4,0.02\n0.2,spill,1,0.05\n0.3,product,0.1,0.01\n0.4,product,0.5,0.03\n";
        let mut page = Page::new("chute");
        let flow_kg_s = |name: &str| (name == "product").then_some(0.5);
        add_outlets(&mut page, csv, flow_kg_s, 0.25);
        let html = page.html();
        for text in [
            "product",
            "spill",
            "0.5 kg/s",
            "1.8 t/h",
            "10 mm",
            "20 mm",
            "30 mm",
            "50 mm",
            "250 g of fines",
        ] {
            assert!(html.contains(text), "{text} is not in {html}");
        }
        let mut empty = Page::new("chute");
        add_outlets(&mut empty, "time_s,outlet,mass_kg,sieve_m\n", |_| None, 0.0);
        assert!(!empty.html().contains("outlet"));
    }
}
