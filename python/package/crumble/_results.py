"""The results of a run."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from crumble._errors import Error
from crumble._files import read_json, read_table
from crumble._frames import Frames

if TYPE_CHECKING:
    import pandas as pd


COUNTS = ("count", "broken_bonds")
"""Quantities that are whole numbers at one time."""


Word = Literal["sound", "coarse", "doubtful"]
"""Nothing speaks against it; smaller spheres would give another result; something is wrong."""


@dataclass(frozen=True)
class Verdict:
    """Whether a result can be trusted."""

    word: Word
    """The verdict in one word."""
    warnings: tuple[str, ...] = ()
    """Why it is doubtful, a sentence each."""
    coarse: tuple[str, ...] = ()
    """Why it depends on the size of the spheres, a sentence each."""

    @property
    def sound(self) -> bool:
        """Whether the word is "sound"."""
        return self.word == "sound"


class Results:
    """The folder of a run. Each file is read when it is asked for, then kept; frames are read one
    by one. Names of columns, keys and arrays are those of the files; SI units.
    """

    folder: Path

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @cached_property
    def summary(self) -> dict[str, Any]:
        """`summary.json`: results, inputs with hashes, errors, verdict."""
        return read_json(self.folder, "summary.json", "a run")

    @property
    def verdict(self) -> Verdict:
        """Whether the result can be trusted, and why not. A run that did not reach its end is
        doubtful.
        """
        problem = self.summary.get("problem")
        said = self.summary.get("verdict") or {"sound": False}
        # Runs of earlier versions were sound or doubtful.
        word: Word = said.get("word") or ("sound" if said["sound"] else "doubtful")
        why = [*([problem] if problem else []), *said.get("warnings", [])]
        # A run that failed has its problem among the warnings, too.
        warnings = tuple(dict.fromkeys(why))
        return Verdict("doubtful" if problem else word, warnings, tuple(said.get("coarse", [])))

    @property
    def measures(self) -> dict[str, float | None]:
        """The value of each measure of the scene: an `int` for a number of fragments or bonds at
        one time. None: it has no value. `units` has their units.
        """
        measures = self.summary.get("measures") or {}
        return {name: self._whole(name, measure["value"]) for name, measure in measures.items()}

    @property
    def units(self) -> dict[str, str]:
        """The SI unit of each measure: "N", "m/s", ...; "" for plain numbers."""
        measures = self.summary.get("measures") or {}
        return {name: measure["unit"] for name, measure in measures.items()}

    def _whole(self, name: str, value: float | None) -> float | None:
        """A number of things at one time as an `int`."""
        scene = self.summary["inputs"]["scene"]
        is_count = scene.get(f"measures.{name}.quantity") in COUNTS
        is_mean = scene.get(f"measures.{name}.statistic") == "mean"
        return int(value) if value is not None and is_count and not is_mean else value

    @property
    def tables(self) -> list[str]:
        """The tables that the run wrote, by the names of the attributes: `series` for `series.csv`,
        `fragment_tree` for `fragment-tree.csv`.
        """
        return sorted(file.stem.replace("-", "_") for file in self.folder.glob("*.csv"))

    def table(self, name: str) -> pd.DataFrame:
        """`NAME.csv`, with `-` for `_` where there is no other such file."""
        file = self.folder / f"{name}.csv"
        if not file.is_file():
            file = file.with_stem(name.replace("_", "-"))
        if not file.is_file():
            have = ", ".join(self.tables) or "none"
            place, problem = str(file), f"there is no such table; the run wrote {have}"
            raise Error(f"{place}: {problem}", 2, place, problem)
        return read_table(file)

    @cached_property
    def series(self) -> pd.DataFrame:
        """`series.csv`: energies, errors, counts, forces of walls and measures over time."""
        return self.table("series")

    @property
    def energy(self) -> pd.DataFrame:
        """The columns of `series` that are energies and works, J, over `time_s`."""
        names = [str(name) for name in self.series.columns]
        wanted = [name for name in names if name == "time_s" or name.endswith("_j")]
        energy: pd.DataFrame = self.series[wanted]
        return energy

    @cached_property
    def events(self) -> pd.DataFrame:
        """`events.csv`: broken bonds, fragments that split, bodies fed and discharged, ..."""
        return self.table("events")

    @cached_property
    def fragments(self) -> pd.DataFrame:
        """`fragments.csv`: mass, size and motion of each fragment at chosen times."""
        return self.table("fragments")

    @cached_property
    def fragment_tree(self) -> pd.DataFrame:
        """`fragment-tree.csv`: where each fragment came from."""
        return self.table("fragment-tree")

    @cached_property
    def discharge(self) -> pd.DataFrame:
        """`discharge.csv`: each body or fragment that left through an outlet."""
        return self.table("discharge")

    @cached_property
    def distribution(self) -> pd.DataFrame:
        """`distribution.csv`: cumulative mass over sieve size."""
        return self.table("distribution")

    @cached_property
    def flow(self) -> pd.DataFrame:
        """`flow.csv`: mass fed and discharged over time, by body and outlet."""
        return self.table("flow")

    @cached_property
    def mixing(self) -> pd.DataFrame:
        """`mixing.csv`: mass and mass fraction in the cells of mixing indices."""
        return self.table("mixing")

    @cached_property
    def wall_loads(self) -> pd.DataFrame:
        """`wall_loads.csv`: what contacts have done to each patch of the walls with `loads`."""
        return self.table("wall_loads")

    @cached_property
    def force_displacement(self) -> pd.DataFrame:
        """`force-displacement.csv`: the curve of a laboratory test."""
        return self.table("force-displacement")

    @property
    def frames(self) -> Frames:
        """Particles, bonds and walls at the times of `frames.pvd`, read one by one."""
        return Frames.of(self.folder)

    def __repr__(self) -> str:
        return f"<Results in {self.folder}>"


def read(folder: str | os.PathLike[str]) -> Results:
    """Opens the folder of a run.

    Raises `Error` if it is none.
    """
    results = Results(Path(folder))
    results.summary  # noqa: B018 - refuses another folder
    return results
