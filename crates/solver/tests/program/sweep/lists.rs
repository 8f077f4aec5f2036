//! Sweeps whose commands are listed and run elsewhere.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use super::{STEPS, bench, csv, good};

/// A table without the columns that depend on the clock.
fn timeless(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut rows = csv(path);
    for row in &mut rows {
        row.retain(|column, _| {
            !column.ends_with("_front")
                && !["time_s", "spread_s", "repeats"].contains(&column.as_str())
        });
    }
    rows
}

#[test]
fn listed_commands_give_the_same_table() {
    let bench = bench(STEPS);
    good(&bench, &["--jobs", "2"]);
    let whole = timeless(&bench.path("study-sweep/sweep.csv"));
    let commands = good(&bench, &["--list", "--output", "apart"]);
    assert_eq!(commands.lines().count(), 16);
    assert!(!bench.path("apart/runs/0001-1").exists());
    let of_two = good(&bench, &["--list", "--threads", "2", "--output", "of-two"]);
    assert!(of_two.lines().all(|line| line.contains(" --threads 2 ")));
    let run = |commands: &str| {
        let list = bench.write("list.sh", commands);
        let mut sh = Command::new("sh");
        let status = sh.arg(list).current_dir(bench.folder.path()).status();
        assert!(status.unwrap().success());
    };
    run(&commands);
    // Once all are done, the short ones are known.
    let further = good(&bench, &["--list", "--resume", "--output", "apart"]);
    assert!(further.lines().all(|line| line.contains("apart/runs/000")));
    run(&further);
    assert_eq!(
        good(&bench, &["--list", "--resume", "--output", "apart"]),
        ""
    );
    good(&bench, &["--collect", "--output", "apart"]);
    assert_eq!(timeless(&bench.path("apart/sweep.csv")), whole);
}

/// The array and the Snakemake file start the listed commands, line by line, from the folder in
/// which they were listed. `--force` removes them.
#[test]
fn the_list_is_written_for_clusters() {
    let bench = bench(STEPS);
    let commands = good(&bench, &["--list", "--output", "apart"]);
    let text = |name: &str| fs::read_to_string(bench.path("apart").join(name)).unwrap();
    assert_eq!(text("commands.txt"), commands);
    let array = text("array.slurm");
    assert!(array.contains("#SBATCH --array=1-16\n"), "{array}");
    let without_slurm = Command::new("sh")
        .arg(bench.path("apart/array.slurm"))
        .env_remove("SLURM_ARRAY_TASK_ID")
        .output();
    assert!(!without_slurm.unwrap().status.success());
    assert!(!bench.path("apart/runs/0001-1").exists());
    // As Slurm does: each task by itself, from wherever.
    for task in 1..=16 {
        let status = Command::new("sh")
            .arg(bench.path("apart/array.slurm"))
            .env("SLURM_ARRAY_TASK_ID", task.to_string())
            .current_dir("/")
            .status();
        assert!(status.unwrap().success());
    }
    good(&bench, &["--collect", "--output", "apart"]);
    let rules = text("Snakefile");
    for name in ["0001-1", "0008-2"] {
        assert!(rules.contains(&format!("\"{name}\"")), "{rules}");
    }
    // A mark of a run that is listed again would keep Snakemake from doing it.
    fs::create_dir(bench.path("apart/done")).unwrap();
    bench.write("apart/done/0001-1", "");
    bench.write("apart/done/mine", "");
    good(&bench, &["--list", "--output", "apart", "--force"]);
    assert!(!bench.path("apart/done/0001-1").exists() && bench.path("apart/done/mine").exists());
    good(&bench, &["--output", "apart", "--force", "--jobs", "2"]);
    for name in ["commands.txt", "array.slurm", "Snakefile"] {
        assert!(!bench.path("apart").join(name).exists(), "{name}");
    }
}
