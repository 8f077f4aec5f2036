"""Bodies: spheres joined by bonds."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from crumble import _crumble
from crumble._arrays import array
from crumble._errors import arguments_of_python, warn_of_doubts
from crumble._progress import Progress, shown

if TYPE_CHECKING:
    from crumble._arrays import Floats, Integers


class Body:
    """Spheres joined by bonds. SI units; arrays have the names of the files.

    `pack` and `read_body` make it.
    """

    path: Path | None
    """The file that holds it. None: it is in memory only."""
    report: dict[str, Any] | None
    """The report of its packing: what `dem-pack --json` prints. None: it was read from a file."""

    def __init__(
        self, stored: _crumble.StoredBody, path: Path | None, report: dict[str, Any] | None
    ) -> None:
        self._stored = stored
        self.path = path
        self.report = report

    @cached_property
    def _arrays(self) -> dict[str, Any]:
        return {name: array(column) for name, column in self._stored.arrays().items()}

    @property
    def position_m(self) -> Floats:
        """Centre of each particle, m. Shape particles x 3."""
        positions: Floats = self._arrays["position_m"]
        return positions

    @property
    def radius_m(self) -> Floats:
        """Radius of each particle, m."""
        radii: Floats = self._arrays["radius_m"]
        return radii

    @property
    def bonds(self) -> Integers:
        """The two particles of each bond, counted from 0. Shape bonds x 2."""
        ends: Integers = self._arrays["bonds"]
        return ends

    @property
    def bond_radius_m(self) -> Floats:
        """Radius of each bond, m."""
        radii: Floats = self._arrays["bond_radius_m"]
        return radii

    @property
    def initial_length_m(self) -> Floats:
        """Stress-free length of each bond, m."""
        lengths: Floats = self._arrays["initial_length_m"]
        return lengths

    @cached_property
    def about(self) -> dict[str, Any]:
        """Its origin, as the field data of its .vtp: `source`, `overlap`, `bond_range`, `seed`,
        `particle_density_kg_m3`, `warnings`, ... None where it is not known.
        """
        about: dict[str, Any] = json.loads(self._stored.about())
        return about

    @property
    def warnings(self) -> list[str]:
        """What makes it doubtful."""
        found: list[str] = self.about["warnings"]
        return found

    @property
    def coarse(self) -> str | None:
        """A sentence on few particles across its thinnest part, where results reflect the particles
        rather than the material. None: there are enough, or their number is not known.
        """
        return self._stored.coarse()

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes it; the ending gives the format: .vtp, .data (LAMMPS), .csv, .txt. An existing file
        is replaced, a missing folder made.
        """
        self._stored.write(path)
        self.path = Path(path)

    def __repr__(self) -> str:
        place = f" in {self.path}" if self.path else ""
        return f"<Body of {len(self.radius_m)} particles and {len(self.bonds)} bonds{place}>"


def pack(
    shape: str | os.PathLike[str],
    diameter: str | float,
    *,
    out: str | os.PathLike[str] | None = None,
    unit: str | None = None,
    scale: float = 1.0,
    fill_holes: bool = False,
    basis: Literal["number", "mass"] = "number",
    overlap: float | None = None,
    particle_density: str | float | None = None,
    solid_density: str | float | None = None,
    seed: int = 1,
    seed_point: str | Sequence[str | float] | None = None,
    densify: float | None = None,
    bond_range: float | None = None,
    bonds_per_particle: float | None = None,
    bond_radius: float = 1.0,
    threads: int | None = None,
    progress: bool | Progress = False,
) -> Body:
    """Fills the shape of an STL, OBJ, PLY or 3MF file with spheres and joins them by bonds, as
    `dem-pack` does.

    `diameter` is as for `--diameter`: "2.5mm", "2mm..3mm", "lognormal:2.5mm,0.3mm,1.5mm..4mm",
    "sieve:FILE.csv", ...; a number is metres. The settings are the options of `dem-pack` (see
    `doc/packing.md`), their defaults are those of the program. `out` is the file to write, whose
    folder is made; without it the body is in memory only. `progress=True` shows the progress on
    standard error; a function is called with the fraction done and the name of the stage.

    Raises `Error` with the message of the program, warns `DoubtfulResult` with the warnings of
    the report. Ctrl-C raises `KeyboardInterrupt` and leaves no file.
    """
    options: dict[str, object] = {
        "diameter": diameter,
        "unit": unit,
        "scale": scale,
        "basis": basis,
        "overlap": overlap,
        "particle-density": particle_density,
        "solid-density": solid_density,
        "seed": seed,
        "seed-point": seed_point,
        "densify": densify,
        "bond-range": bond_range,
        "bonds-per-particle": bonds_per_particle,
        "bond-radius": bond_radius,
    }
    arguments = [
        f"--{name}={_text(value)}" for name, value in options.items() if value is not None
    ]
    if fill_holes:
        arguments.append("--fill-holes")
    with arguments_of_python(), shown(progress) as tell:
        stored, report = _crumble.pack([*arguments, "--", os.fspath(shape)], out, threads, tell)
    body = Body(stored, None if out is None else Path(out), json.loads(report))
    warn_of_doubts(os.fspath(shape), body.warnings)
    return body


def read_body(path: str | os.PathLike[str]) -> Body:
    """Reads a body: .vtp, .data (LAMMPS), .csv or .txt."""
    return Body(_crumble.read_body(path), Path(path), None)


def _text(value: object) -> str:
    """A value of an option."""
    if isinstance(value, str):
        return value
    if isinstance(value, Sequence):
        return ",".join(_text(part) for part in value)
    return str(value)
