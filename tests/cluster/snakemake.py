"""Checks that a study that Snakemake runs gives the same table as `dem-run sweep`.

    pip install snakemake        (in a virtual environment)
    python tests/cluster/snakemake.py DEM-RUN [STUDY]

DEM-RUN: the program; STUDY: six runs of a minute in all unless given. Writes the runs by
`sweep --list`, runs the `Snakefile` with two at a time, collects them, and compares the table with
that of a direct `sweep`: all columns but those of run time, character by character. The exit code is
1 if they differ or a program fails; without `snakemake` nothing is checked, and it is 2.
"""

import csv
import os
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
STUDY = os.path.join(ROOT, "data/studies/spinning-bar.toml")


def call(*words, folder=ROOT):
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(words)}\n{done.stdout}{done.stderr}")
    return done.stdout


def is_of_time(name):
    """Whether a column depends on how fast the machine was."""
    return name in ("time_s", "spread_s") or name.endswith(("_times_as_fast", "_front"))


def rows(folder):
    with open(os.path.join(folder, "sweep.csv"), encoding="utf-8", newline="") as file:
        all_rows = list(csv.DictReader(file))
    return [{name: cell for name, cell in row.items() if not is_of_time(name)} for row in all_rows]


def snakemake_program():
    beside = os.path.join(os.path.dirname(sys.executable), "snakemake")
    return beside if os.path.exists(beside) else shutil.which("snakemake")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    dem_run = os.path.abspath(sys.argv[1])
    study = os.path.abspath(sys.argv[2]) if len(sys.argv) == 3 else STUDY
    snakemake = snakemake_program()
    if snakemake is None:
        print("snakemake is missing: pip install snakemake")
        sys.exit(2)
    print("Snakemake", call(snakemake, "--version").strip())
    with tempfile.TemporaryDirectory() as folder:
        listed, direct = os.path.join(folder, "listed"), os.path.join(folder, "direct")
        call(dem_run, "sweep", study, "--list", "--output", listed)
        call(snakemake, "--snakefile", "Snakefile", "--cores", "2", "--keep-going", folder=listed)
        call(dem_run, "sweep", study, "--collect", "--quiet", "--output", listed)
        call(dem_run, "sweep", study, "--quiet", "--output", direct)
        ours, theirs = rows(direct), rows(listed)
    for one, other in zip(ours, theirs):
        for name in one:
            if one[name] != other.get(name):
                print(f"run {one['run']}, {name}: {one[name]}, by Snakemake {other.get(name)}")
    if not ours or ours != theirs:
        sys.exit(f"not the same: {len(ours)} rows by sweep, {len(theirs)} by Snakemake")
    print(f"the same {len(ours)} rows")


main()
