//! The table as text for a person.

use dem_study::outcome::Outcome;

use super::made::{done, study, table_of};

/// The coarser radii of one model have errors of 0.8, 0.4 and 0.2; all runs of the other failed.
#[test]
fn the_text_of_a_table_has_every_part() {
    let study = study(
        r#"
[vary]
"bodies.bar.radius" = ["8 mm", "4 mm", "2 mm", "1 mm"]
"bonds.bar.model" = ["a", "b"]
[measures.tip]
reference = "finest"
[measures.sag]
reference = "none"
"#,
    );
    let table = table_of(&study, |run| {
        let radius = run.choice[0];
        let (time_s, value) = [(1.0, 1.8), (2.0, 1.4), (4.0, 1.2), (8.0, 1.0)][radius];
        vec![match run.choice[1] {
            0 => Outcome::Done(done(time_s, &[value, 2.5])),
            _ => Outcome::Failed("it burst".to_owned()),
        }]
    });
    let wanted = "\
study.toml: 8 runs of bar.toml, 3 times each, on 1 thread
machine      a machine, 2 cores
response     sag (m)
  2.5                  bodies.bar.radius 8 mm, bonds.bar.model a
  2.5                  bodies.bar.radius 4 mm, bonds.bar.model a
  2.5                  bodies.bar.radius 2 mm, bonds.bar.model a
  2.5                  bodies.bar.radius 1 mm, bonds.bar.model a
front        tip: against the finest run along bodies.bar.radius, 3 of 8 runs
          1 s  error 0.8       bodies.bar.radius 8 mm, bonds.bar.model a, 8 times as fast as the finest
          2 s  error 0.4       bodies.bar.radius 4 mm, bonds.bar.model a, 4 times as fast as the finest
          4 s  error 0.2       bodies.bar.radius 2 mm, bonds.bar.model a, 2 times as fast as the finest
order        tip along bodies.bar.radius (a): 1.00 from 3 runs
failed       run 2, bodies.bar.radius 8 mm, bonds.bar.model b: it burst
failed       run 4, bodies.bar.radius 4 mm, bonds.bar.model b: it burst
failed       run 6, bodies.bar.radius 2 mm, bonds.bar.model b: it burst
failed       run 8, bodies.bar.radius 1 mm, bonds.bar.model b: it burst
note         tip: the finest run failed (1 mm, b), so others have nothing to be compared with
";
    assert_eq!(table.to_string(), wanted);
}

#[test]
fn long_parts_are_cut() {
    let study = study(
        r#"
threads = 2
[vary]
"run.rest_energy_ratio" = { from = 1, to = 25, count = 25 }
[measures.tip]
reference = { value = 1 }
"#,
    );
    let text = table_of(&study, |_| vec![Outcome::Missing]).to_string();
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].ends_with("on 2 threads"), "{text}");
    assert_eq!(lines[2], "front        tip: against 1, 0 of 25 runs");
    for (line, number) in lines[3..23].iter().zip(1..) {
        let said = format!(
            "failed       run {number}, run.rest_energy_ratio {number}: it has not been run to its end"
        );
        assert_eq!(*line, said);
    }
    assert_eq!(lines[23..], ["  and 5 more"]);
}
