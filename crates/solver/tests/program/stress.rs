//! `dem-run stress` from the side of a user and of a script.

use std::process::Output;

use serde_json::Value;

use super::{dem_run, root};

fn stress(options: &[&str]) -> Output {
    dem_run().arg("stress").args(options).output().unwrap()
}

fn said(output: &Output) -> String {
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(
        output.stderr.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout.clone()).unwrap()
}

#[test]
fn a_table_of_the_cases_asked_for() {
    let table = said(&stress(&["mesh-wall", "size"]));
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(
        lines[..2],
        [
            "| case | what is extreme | predicted | observed | verdict |",
            "|---|---|---|---|---|"
        ]
    );
    assert_eq!(lines.len(), 4, "{table}");
    for (line, name) in lines[2..].iter().zip(["mesh-wall", "size"]) {
        assert!(line.starts_with(&format!("| {name} | ")), "{line}");
        assert!(line.ends_with(" | as predicted |"), "{line}");
        assert_eq!(line.matches('|').count(), 6, "{line}");
    }
    assert!(lines[2].contains("1 refused; 1 stopped"), "{table}");
    // The same again, on one thread.
    assert_eq!(
        said(&stress(&["size", "mesh-wall", "--threads", "1"])),
        table
    );
}

/// doc/inside/stress.md contains the printed table, with all cases.
#[test]
fn the_page_has_the_table() {
    let table = said(&stress(&["mesh-wall", "size"]));
    let refused = String::from_utf8(stress(&["?"]).stderr).unwrap();
    let (_, known) = refused.split_once("take some of ").unwrap();
    let (known, _) = known.split_once(';').unwrap();
    let text = std::fs::read_to_string(root().join("doc/inside/stress.md")).unwrap();
    for line in table.lines() {
        assert!(text.contains(line), "doc/inside/stress.md lacks {line}");
    }
    let rows = text
        .lines()
        .filter(|line| line.ends_with(" | as predicted |"));
    let names: Vec<&str> = rows.map(|row| row.split(" | ").next().unwrap()).collect();
    let wanted: Vec<String> = known.split(", ").map(|name| format!("| {name}")).collect();
    assert_eq!(names, wanted);
}

#[test]
fn every_run_as_json() {
    let json = said(&stress(&["impact", "--json", "--quiet"]));
    let value: Value = serde_json::from_str(&json).unwrap();
    let [case] = value.as_array().unwrap().as_slice() else {
        panic!("{json}");
    };
    assert_eq!(case["name"], "impact");
    assert!(case["wall_s"].as_f64().unwrap() > 0.0);
    let members = case["members"].as_array().unwrap();
    assert_eq!(members.len(), 45);
    let first = &members[0];
    assert_eq!(first["what"], "on a wall, restitution 1");
    assert_eq!(
        first["predicted"]["ends"][0]["quantity"]["measure"],
        "rebound"
    );
    assert_eq!(first["predicted"]["ends"][0]["value"], 300.0);
    let rebound = first["observed"]["ended"][0].as_f64().unwrap();
    assert!((rebound - 300.0).abs() < 3.0, "{rebound}");
    assert_eq!(first["wrong"], Value::Null);
    let stopped = members.last().unwrap();
    assert!(
        stopped["observed"]["stopped"]
            .as_str()
            .unwrap()
            .contains("has gone through the wall 'floor'"),
        "{stopped}"
    );
}

#[test]
fn quiet_says_nothing() {
    assert_eq!(said(&stress(&["size", "-q"])), "");
}

#[test]
fn an_unknown_case_is_refused_with_the_known_ones() {
    let output = stress(&["size", "sizes"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.starts_with(
            "error: dem-run stress: there is no case 'sizes'; take some of stiffness-ratio,"
        ),
        "{said}"
    );
    assert_eq!(said.matches('\n').count(), 1, "{said}");
    assert_eq!(stress(&["size", "--threads", "0"]).status.code(), Some(2));
}
