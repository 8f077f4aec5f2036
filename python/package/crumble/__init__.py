"""Breakage of particles with the discrete element method.

`pack` fills a shape with bonded spheres, `run` simulates a scene, `sweep` a scene with many
settings, `read` and `read_sweep` open their folders, `check` examines a scene without running it,
`command` runs any other command of the programs `dem-pack` and `dem-run`, which come with this
package.
"""

from crumble._body import Body, pack, read_body
from crumble._errors import DoubtfulResult, Error
from crumble._frames import Frame, Frames, Walls
from crumble._programs import command
from crumble._results import Results, Verdict, read
from crumble._run import check, run
from crumble._sweep import Sweep, read_sweep, sweep

__all__ = [
    "Body",
    "DoubtfulResult",
    "Error",
    "Frame",
    "Frames",
    "Results",
    "Sweep",
    "Verdict",
    "Walls",
    "check",
    "command",
    "pack",
    "read",
    "read_body",
    "read_sweep",
    "run",
    "sweep",
]
