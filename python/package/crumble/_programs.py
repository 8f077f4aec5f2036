"""The programs `dem-pack` and `dem-run`."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import NoReturn

from crumble import _crumble
from crumble._errors import Error

PROGRAMS = ("dem-pack", "dem-run")


def own_command(name: str) -> list[str]:
    """What starts the program in a process of its own."""
    return [sys.executable, "-m", "crumble", name]


def start(name: str, arguments: list[str]) -> NoReturn:
    """Is the program: never returns."""
    sys.exit(_crumble.program(name, own_command(name), arguments))


def dem_pack() -> NoReturn:
    """`dem-pack` on the command line."""
    start("dem-pack", sys.argv[1:])


def dem_run() -> NoReturn:
    """`dem-run` on the command line."""
    start("dem-run", sys.argv[1:])


def command(*words: str | os.PathLike[str]) -> str:
    """Runs a command of a program in a process of its own and returns what it prints:
    `command("dem-run", "fragment", "drop-out", "--largest", "-o", "piece.vtp")`.

    Raises `Error` with its message.
    """
    line = [os.fspath(word) for word in words]
    if not line or line[0] not in PROGRAMS:
        raise ValueError(f"the first word is {' or '.join(PROGRAMS)}")
    done = subprocess.run(
        [*own_command(line[0]), *line[1:]],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        encoding="utf-8",
        errors="replace",
    )
    if done.returncode != 0:
        said = done.stderr.strip().splitlines() or [f"ended with the code {done.returncode}"]
        found = [line for line in said if line.startswith("error: ")] or said[-1:]
        raise Error(found[0].removeprefix("error: "), done.returncode)
    return done.stdout
