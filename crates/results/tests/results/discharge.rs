//! Tables of what leaves and of sizes: as documented, and the same after an interruption.

use std::fs;

use dem_results::columns::{header, lines, write_table};
use dem_results::{
    DischargeRow, DistributionRow, FlowRow, MixingRow, SievedPieces, Table, discharged,
};
use tempfile::tempdir;

fn row(fragment_id: u32, time_s: f64) -> DischargeRow<'static> {
    DischargeRow {
        time_s,
        fragment_id,
        body: "cake, old",
        material: "stone",
        outlet: "floor",
        mass_kg: 0.1 * time_s,
        equivalent_diameter_m: 1.0 / 3.0,
        box_lengths_m: [0.5, 0.25, 0.125],
        sieve_m: 0.25,
    }
}

#[test]
fn discharge_looks_as_documented_and_goes_on_after_an_interruption() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("discharge.csv");
    let mut file = Table::create(&path, &header(&DischargeRow::COLUMNS)).unwrap();
    file.append(&lines(&DischargeRow::COLUMNS, [row(7, 0.5)]))
        .unwrap();
    let checkpoint = file.length_bytes();
    file.append(&lines(&DischargeRow::COLUMNS, [row(8, 1.0), row(2, 1.0)]))
        .unwrap();
    file.append(&lines(&DischargeRow::COLUMNS, [])).unwrap();
    let whole = fs::read_to_string(&path).unwrap();
    assert!(whole.starts_with("time_s,fragment_id,body,material,outlet,mass_kg,equivalent_diameter_m,length_m,width_m,thickness_m,sieve_m\n0.5,7,\"cake, old\",stone,floor,0.05,0.3333333333333333,0.5,0.25,0.125,0.25\n"));
    assert_eq!(whole.lines().count(), 4);
    let mut file = Table::continue_at(&path, &header(&DischargeRow::COLUMNS), checkpoint).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap().lines().count(), 2);
    file.append(&lines(&DischargeRow::COLUMNS, [row(8, 1.0), row(2, 1.0)]))
        .unwrap();
    file.sync().unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), whole);
}

#[test]
fn a_distribution_looks_as_documented() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("distribution.csv");
    let row = DistributionRow {
        body: "cake",
        location: "both",
        sieve_m: 1.4e-3,
        passing_kg: 0.5,
        passing_fraction: 0.25,
        resolved: false,
    };
    write_table(&path, &DistributionRow::COLUMNS, [row]).unwrap();
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        "body,location,sieve_m,passing_kg,passing_fraction,resolved\ncake,both,0.0014,0.5,0.25,0\n"
    );
}

#[test]
fn flows_and_mixtures_look_as_documented() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("table.csv");
    let fed = FlowRow {
        time_s: 0.5,
        body: "cake, old",
        outlet: "",
        pieces: 3,
        mass_kg: 0.75,
        flow_kg_s: 1.5,
    };
    let left = FlowRow {
        outlet: "floor",
        ..fed
    };
    write_table(&path, &FlowRow::COLUMNS, [fed, left]).unwrap();
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        "time_s,body,outlet,pieces,mass_kg,flow_kg_s\n0.5,\"cake, old\",,3,0.75,1.5\n0.5,\"cake, old\",floor,3,0.75,1.5\n"
    );
    let cell = MixingRow {
        measure: "mixing",
        centre_m: [0.5, -0.5, 1.5],
        mass_kg: 2.0,
        fraction: 0.25,
    };
    write_table(&path, &MixingRow::COLUMNS, [cell]).unwrap();
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        "measure,x_m,y_m,z_m,mass_kg,fraction\nmixing,0.5,-0.5,1.5,2,0.25\n"
    );
}

#[test]
fn pieces_are_sieved_by_outlet() {
    let csv = "outlet,body,mass_kg,sieve_m\n\
        product,ore,0.4,0.02\nspill,\"a, b\",1,0.05\nproduct,ore,0.1,0.01\nproduct,ore,0.5,0.03\n";
    let all = discharged(csv).unwrap_or_default();
    let product = &all["product"];
    assert_eq!((product.count(), product.largest_kg()), (3, Some(0.5)));
    assert!((product.mass_kg() - 1.0).abs() < 1e-15);
    let sizes = [0.0, 0.1, 0.11, 0.5, 0.51, 1.0].map(|part| product.size_m(part));
    assert_eq!(
        sizes,
        [0.01, 0.01, 0.02, 0.02, 0.03, 0.03].map(Some),
        "the sums of masses are 0.1, 0.5 and 1 kg"
    );
    let passing = [0.009, 0.01, 0.029, 0.03].map(|m| product.passing(m).unwrap_or(f64::NAN));
    assert_eq!(passing[0], 0.0);
    assert!((passing[1] - 0.1).abs() < 1e-15 && (passing[2] - 0.5).abs() < 1e-15);
    assert_eq!(passing[3], 1.0);
    assert_eq!(all["spill"].count(), 1);
    let none = SievedPieces::default();
    assert_eq!((none.size_m(0.5), none.passing(1.0)), (None, None));
    assert_eq!(discharged("time_s,mass_kg\n1,1\n"), None);
}
