"""Breakage of particles with the discrete element method.

`pack` fills an STL shape with bonded spheres, `run` simulates a scene, `read` opens the folder of a
run, `check` examines a scene without running it, `command` runs any other command of the programs
`dem-pack` and `dem-run`, which come with this package.
"""

from crumble._body import Body, pack, read_body
from crumble._errors import DoubtfulResult, Error
from crumble._frames import Frame, Frames, Walls
from crumble._programs import command
from crumble._results import Results, Verdict, read
from crumble._run import check, run

__all__ = [
    "Body",
    "DoubtfulResult",
    "Error",
    "Frame",
    "Frames",
    "Results",
    "Verdict",
    "Walls",
    "check",
    "command",
    "pack",
    "read",
    "read_body",
    "run",
]
