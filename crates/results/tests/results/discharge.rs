//! Tables of what leaves and of sizes: as documented, and the same after an interruption.

use std::fs;

use dem_results::columns::{header, lines, write_table};
use dem_results::{DischargeRow, DistributionRow, FlowRow, MixingRow, Table};
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
