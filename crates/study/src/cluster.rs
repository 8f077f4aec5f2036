//! The remaining runs of a sweep for the schedulers of a cluster: a list of commands, a Slurm job
//! array and a Snakemake file, which start them line by line.
//!
//! [sbatch](https://slurm.schedmd.com/sbatch.html),
//! [Snakemake](https://snakemake.readthedocs.io/en/stable/snakefiles/rules.html)

use std::path::Path;

use dem_io::Result;
use dem_io::safe_write::PendingFile;

use super::folder::{COMMANDS, SLURM, SNAKEFILE};
use super::jobs::{refuse_unlistable, shell_word};

/// A command, and the name of its run in the folder `runs`, such as `0007-2`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ListedRun {
    /// Name of the run.
    pub name: String,
    /// Its command line for sh.
    pub command: String,
}

/// Writes `commands.txt`, `array.slurm` and `Snakefile` into the folder of the sweep. `here`: the
/// folder in which the commands are run. `threads`: of each run. Refuses names that a line of text
/// cannot contain.
pub fn write_cluster_files(
    folder: &Path,
    here: &Path,
    runs: &[ListedRun],
    threads: u32,
) -> Result<()> {
    let whole = here.join(folder);
    refuse_unlistable("the folder of the sweep", &whole)?;
    let lines: String = runs
        .iter()
        .map(|run| format!("{}\n", run.command))
        .collect();
    let slurm = slurm(here, &whole, runs.len(), threads);
    let snakefile = snakefile(here, &whole, runs, threads);
    let mut pending = Vec::new();
    for (name, text) in [(COMMANDS, lines), (SLURM, slurm), (SNAKEFILE, snakefile)] {
        let path = folder.join(name);
        pending.push(PendingFile::write(&path, |out| {
            out.write_all(text.as_bytes())
        })?);
    }
    pending.into_iter().try_for_each(PendingFile::publish)
}

/// A job array: task N runs line N of the commands.
fn slurm(here: &Path, folder: &Path, count: usize, threads: u32) -> String {
    let [here, commands] = [here.to_owned(), folder.join(COMMANDS)]
        .map(|path| shell_word(&path.display().to_string()));
    format!(
        "#!/bin/sh\n\
         #SBATCH --job-name=sweep\n\
         #SBATCH --array=1-{count}\n\
         #SBATCH --cpus-per-task={threads}\n\
         #SBATCH --output=/dev/null\n\
         cd {here} || exit 1\n\
         task=\"${{SLURM_ARRAY_TASK_ID:?start this file with sbatch}}\"\n\
         sed -n \"${{task}}p\" {commands} | sh\n"
    )
}

/// A rule for each run: its mark is the file `done/NAME`.
fn snakefile(here: &Path, folder: &Path, runs: &[ListedRun], threads: u32) -> String {
    let quoted = |path: &Path| python_text(&path.display().to_string());
    let names: Vec<String> = runs.iter().map(|run| python_text(&run.name)).collect();
    format!(
        "# snakemake --snakefile {COMMENT} --cores 8 --keep-going\n\
         import os\n\
         import subprocess\n\n\
         HERE = {}\n\
         FOLDER = {}\n\
         RUNS = [{}]\n\n\
         workdir: FOLDER\n\n\
         with open(os.path.join(FOLDER, \"{COMMANDS}\"), encoding=\"utf-8\") as file:\n    \
             COMMAND = dict(zip(RUNS, file.read().splitlines()))\n\n\
         rule all:\n    \
             input:\n        \
                 expand(\"done/{{run}}\", run=RUNS)\n\n\
         rule run:\n    \
             output:\n        \
                 touch(\"done/{{run}}\")\n    \
             threads: {threads}\n    \
             run:\n        \
                 subprocess.run([\"sh\", \"-c\", COMMAND[wildcards.run]], cwd=HERE, check=True)\n",
        quoted(here),
        quoted(folder),
        names.join(", "),
        COMMENT = SNAKEFILE,
    )
}

/// A text as a literal of Python.
fn python_text(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
