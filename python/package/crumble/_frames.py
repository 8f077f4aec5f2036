"""Frames of a run."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, overload
from xml.etree import ElementTree

from crumble import _crumble
from crumble._arrays import array
from crumble._errors import Error

if TYPE_CHECKING:
    import numpy as np

    from crumble._arrays import Array, Floats, Integers


@dataclass(frozen=True)
class Walls:
    """The walls of a frame: triangles, in single precision, and forces."""

    names: list[str]
    """Name of each wall."""
    force_n: Floats
    """Force of the particles on each wall, N. Shape walls x 3."""
    points_m: Floats
    """Points, m. Shape n x 3."""
    triangles: Integers
    """The three points of each triangle. Shape triangles x 3."""
    wall: Integers
    """The wall of each triangle: its number in `names`."""


class Frame:
    """Particles, bonds and walls at one time."""

    path: Path
    """The file."""
    time_s: float
    """Simulated time, s."""
    body_names: list[str]
    """Names of the bodies; `particles["body"]` holds their numbers."""
    particles: dict[str, Array]
    """Arrays of the particles by the names of the file: `position_m`, `radius_m`, `velocity_m_s`,
    `body`, `particle_id`, `fragment_id`, ... Vectors have the shape particles x 3.
    """
    bonds: dict[str, Array]
    """Arrays of the bonds: `particles` (the two particles of each, shape bonds x 2), `broken`,
    `normal_stress_pa`, `utilisation`, ...
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        time_s, self.body_names, columns = _crumble.read_frame(path)
        self.time_s = float("nan") if time_s is None else time_s
        self.particles = {}
        self.bonds = {}
        for name, column in columns.items():
            section, _, short = name.partition("/")
            if section == "PointData":
                self.particles[short] = array(column)
            elif section == "CellData":
                self.bonds[short] = array(column)
        self.particles["position_m"] = array(columns["Points/positions_m"])
        self.bonds["particles"] = array(columns["Lines/connectivity"]).reshape(-1, 2)

    @cached_property
    def walls(self) -> Walls | None:
        """The walls. None: the scene has none."""
        file = self.path.with_name(self.path.name.replace("frame_", "walls_"))
        if not file.is_file():
            return None
        _, names, columns = _crumble.read_walls(file)
        return Walls(names, **{name: array(column) for name, column in columns.items()})

    def __repr__(self) -> str:
        particles, bonds = len(self.particles["radius_m"]), len(self.bonds["particles"])
        return f"<Frame at {self.time_s:.6g} s: {particles} particles, {bonds} bonds>"


class Frames(Sequence[Frame]):
    """The frames of a run: each is read when it is asked for, and not kept."""

    def __init__(self, files: list[tuple[float, Path]]) -> None:
        self._files = files

    @classmethod
    def of(cls, folder: str | os.PathLike[str]) -> Frames:
        """The frames that `frames.pvd` in the folder of a run lists; none if the run wrote none."""
        index = Path(folder) / "frames.pvd"
        if not index.is_file():
            return cls([])
        try:
            sets = ElementTree.parse(index).getroot().iter("DataSet")
            # Other parts of the same time are walls.
            files = [
                (float(item.attrib["timestep"]), Path(folder) / item.attrib["file"])
                for item in sets
                if item.attrib["part"] == "0"
            ]
        except (ElementTree.ParseError, KeyError, ValueError) as problem:
            message = f"{index}: this is not an index of frames: {problem}"
            raise Error(message, 2, str(index)) from problem
        return cls(files)

    @property
    def times_s(self) -> Floats:
        """Time of each frame, s. No frame is read for it."""
        import numpy as np

        return np.array([time_s for time_s, _ in self._files], dtype=np.float64)

    def at(self, time: str | float) -> Frame:
        """The frame nearest to a time: a text with a unit, such as "3 ms", or a number of seconds.

        Raises `Error` if the time is further beyond the frames than they are apart.
        """
        import numpy as np

        time_s = _crumble.time_s(time) if isinstance(time, str) else float(time)
        times_s = self.times_s
        if not len(times_s):
            raise Error("time: the run has no frames", 2, "time", "the run has no frames")
        first_s, last_s = float(times_s[0]), float(times_s[-1])
        every_s = (last_s - first_s) / max(1, len(times_s) - 1)
        if len(times_s) > 1 and not first_s - every_s <= time_s <= last_s + every_s:
            problem = f"there are no frames near {time_s:.6g} s"
            remedy = f"the run has frames from {first_s:.6g} s to {last_s:.6g} s"
            raise Error(f"time: {problem}; {remedy}", 2, "time", problem, remedy)
        nearest = int(np.argmin(np.abs(times_s - time_s)))
        return self[nearest]

    def __len__(self) -> int:
        return len(self._files)

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> Frames: ...
    def __getitem__(self, index: int | slice) -> Frame | Frames:
        if isinstance(index, slice):
            return Frames(self._files[index])
        return Frame(self._files[index][1])

    def __repr__(self) -> str:
        return f"<{len(self)} frames>"
