"""Studies: one scene with many settings."""

from __future__ import annotations

import os
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crumble import _crumble
from crumble._errors import Error, arguments_of_python, warn_of_doubts
from crumble._files import read_json, read_table
from crumble._programs import own_command
from crumble._progress import Progress, shown

if TYPE_CHECKING:
    import pandas as pd

TEXTS = ("unit", "parameter_unit", "verdict", "failed", "result")
"""Columns of texts, which may be empty."""


class Sweep:
    """The folder of a study. Each file is read when it is asked for, then kept. Names of columns
    and keys are those of the files, with units in the names of columns, as in `tip_value (m)`.
    """

    folder: Path

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @cached_property
    def table(self) -> pd.DataFrame:
        """`sweep.csv`: a row for each run: settings, times, measures, errors, verdict, and why it
        failed. `read(sweep.folder / "runs/0007-1")` opens run 7.
        """
        return self._table("sweep.csv", "the runs have not been collected")

    @cached_property
    def responses(self) -> pd.DataFrame:
        """`responses.csv`: a row for each measure without a reference and each setting: mean,
        standard deviation, range and median over the averaged parameter.
        """
        return self._table("responses.csv", "all measures of the study have a reference")

    @cached_property
    def find(self) -> pd.DataFrame:
        """`find.csv`: what `[find]` of the study found, with the ends of its interval."""
        return self._table("find.csv", "the study has no [find]")

    @cached_property
    def probability(self) -> pd.DataFrame:
        """`probability.csv`: a row for each case and value of the parameter of `[probability]`: the
        fraction of the runs with the outcome, and the curve there, with their 95 % intervals.
        """
        return self._table("probability.csv", "the study has no [probability]")

    @cached_property
    def probability_fit(self) -> pd.DataFrame:
        """`probability-fit.csv`: a row for each case of `[probability]`: the curve, and the values
        of the parameter at 10, 50 and 90 % with the ends of their 95 % intervals.
        """
        return self._table("probability-fit.csv", "the study has no [probability]")

    @cached_property
    def effects(self) -> pd.DataFrame:
        """`effects.csv`: a row for each measure and parameter of `[design]`, by rank: what the
        parameter changes, and whether that is more than chance.
        """
        return self._table("effects.csv", "the study has no [design]")

    @cached_property
    def summary(self) -> dict[str, Any]:
        """`sweep.json`: parameters, measures, runs, responses, orders, notes."""
        return read_json(self.folder, "sweep.json", "a sweep")

    @property
    def notes(self) -> list[str]:
        """Notes on the results: how many runs are doubtful and why, what is not known, ..."""
        notes: list[str] = self.summary["notes"]
        return notes

    def _table(self, name: str, why: str) -> pd.DataFrame:
        file = self.folder / name
        if not file.is_file():
            problem = f"there is no such table: {why}"
            raise Error(f"{file}: {problem}", 2, str(file), problem)
        return read_table(file, TEXTS)

    def _doubts(self) -> list[str]:
        """A sentence on the doubtful runs, if there are any."""
        runs = self.summary["runs"]
        doubtful = [run for run in runs if run["doubts"]]
        if not doubtful:
            return []
        first = doubtful[0]
        why = f"the first, run {first['number']}: {first['doubts'][0]} (`notes` has all reasons)"
        return [f"{len(doubtful)} of {len(runs)} runs are doubtful; {why}"]

    def __repr__(self) -> str:
        return f"<Sweep of {len(self.summary['runs'])} runs in {self.folder}>"


def sweep(
    study: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    jobs: int | None = None,
    resume: bool = False,
    force: bool = False,
    threads: int | None = None,
    progress: bool | Progress = False,
) -> Sweep:
    """Runs a study, as `dem-run sweep` does, and returns its results.

    `out` is the folder for runs and tables; without it, the study's name with -sweep in the working
    directory. A folder that holds a sweep is refused unless `force` (it is replaced) or `resume`
    (finished runs are kept). `jobs` is the number of runs at a time, 1 unless given; several disturb
    each other's times. `threads` is the number of threads of each run, that of the study unless
    given. `progress=True` shows the progress on standard error; a function is called with the
    fraction done and a text; a search makes several rounds of runs.

    Raises `Error` with the message of the program, also if runs failed: `read_sweep` opens the
    tables of the others. Warns `DoubtfulResult` once if runs are doubtful. Ctrl-C ends the runs
    and raises `KeyboardInterrupt`; `resume=True` goes on.
    """
    folder = Path(f"{Path(study).stem}-sweep" if out is None else out)
    arguments = ["sweep", f"--output={os.fspath(folder)}", "--quiet"]
    for number, name in [(jobs, "--jobs"), (threads, "--threads")]:
        if number is not None:
            arguments.append(f"{name}={number}")
    for given, name in [(resume, "--resume"), (force, "--force")]:
        if given:
            arguments.append(name)
    with arguments_of_python(), shown(progress) as tell:
        _crumble.run(own_command("dem-run"), [*arguments, "--", os.fspath(study)], tell)
    done = Sweep(folder)
    warn_of_doubts(os.fspath(study), done._doubts())
    return done


def read_sweep(folder: str | os.PathLike[str]) -> Sweep:
    """Opens the folder of a study.

    Raises `Error` if it is none.
    """
    done = Sweep(Path(folder))
    done.summary  # noqa: B018 - refuses another folder
    return done
