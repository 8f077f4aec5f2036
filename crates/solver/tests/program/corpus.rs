//! Scenes that the reader accepts and the planner refuses, with the messages of `messages.txt` next
//! to them, without the folder of the scene.

use dem_testing::hold_messages;

use super::{Bench, corpus, vtp_bytes};

#[test]
fn every_bad_scene_is_refused_with_its_message() {
    let bench = Bench::new();
    bench.write("row.vtp", vtp_bytes(&super::row(5)));
    let scenes = corpus("bad");
    assert!(scenes.len() >= 12, "{}", scenes.len());
    let mut messages = Vec::new();
    for path in &scenes {
        let text = std::fs::read_to_string(path).unwrap();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let here = bench.write(&name, &text);
        let said = bench.bad(&here, &["--output", "out"], 2);
        let folder = format!("{}/", bench.path("").display()).replace("//", "/");
        let message = said.replace(&folder, "");
        messages.push(message.strip_prefix("error: ").unwrap().to_owned());
        // `check` gives the same message.
        let output = super::dem_run().arg("check").arg(&here).output().unwrap();
        assert_eq!(super::refused(&output), (said, 2));
        assert!(!bench.path("out").exists());
    }
    hold_messages(scenes[0].parent().unwrap(), &messages);
}
