//! Scenes that the reader takes and the planner refuses: the message stands beside the line that it
//! is about, after `#!`.

use super::{Bench, corpus, vtp_bytes};

#[test]
fn every_bad_scene_is_refused_with_its_message() {
    let bench = Bench::new();
    bench.write("row.vtp", vtp_bytes(&super::row(5)));
    let scenes = corpus("bad");
    assert!(scenes.len() >= 12, "{}", scenes.len());
    let mut wrong = String::new();
    for path in scenes {
        let text = std::fs::read_to_string(&path).unwrap();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let here = bench.write(&name, &text);
        let messages: Vec<&str> = text
            .lines()
            .filter_map(|line| Some(line.split_once("#! ")?.1))
            .collect();
        assert_eq!(messages.len(), 1, "{name}: messages expected");
        let said = bench.bad(&here, &["--output", "out"], 2);
        let expected = format!("error: {}: {}", here.display(), messages[0])
            .replace("HERE", &bench.path("").display().to_string())
            .replace("//", "/");
        if said != expected {
            wrong += &format!("expected {expected}\ngot      {said}\n");
        }
        // check says the same.
        let output = super::dem_run().arg("check").arg(&here).output().unwrap();
        assert_eq!(super::refused(&output), (said, 2));
        assert!(!bench.path("out").exists());
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}
