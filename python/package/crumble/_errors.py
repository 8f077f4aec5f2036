"""What can go wrong."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager


class Error(RuntimeError):
    """Bad input, or work that failed. The text is the message of the programs, on one line: place,
    problem with value and limit, remedy. Options of the programs have their names in Python.
    """

    exit_code: int
    """2 for bad input, 1 for work that failed, 3 for a run that went unstable."""
    place: str
    """File, line or argument. May be empty."""
    problem: str
    """The problem, with the value and the limit."""
    remedy: str
    """The remedy. May be empty."""

    def __init__(
        self, message: str, exit_code: int, place: str = "", problem: str = "", remedy: str = ""
    ) -> None:
        super().__init__(message)
        self.exit_code = exit_code
        self.place = place
        self.problem = problem or message
        self.remedy = remedy


class DoubtfulResult(UserWarning):
    """A body or a run has a doubtful verdict: the warning says why."""


# What users see: tracebacks name the classes as they are imported.
Error.__module__ = DoubtfulResult.__module__ = "crumble"

FLAGS = ("fill-holes", "force", "force-step", "resume")
"""Options without a value: True in Python."""


def in_python(text: str) -> str:
    """A message of the programs with the arguments of Python: `force=True` for `--force`,
    `bond_range` for `--bond-range`.
    """

    def argument(option: re.Match[str]) -> str:
        name = option[1]
        if name in FLAGS:
            return name.replace("-", "_") + "=True"
        if name == "yes":  # of `dem-run sweep`, for command() only
            return option[0]
        return "out" if name == "output" else name.replace("-", "_")

    return re.sub(r"(?<![\w/.-])--([a-z][a-z-]*[a-z])(?![\w/.])", argument, text)


@contextmanager
def arguments_of_python() -> Iterator[None]:
    """Errors within name the arguments of Python, not the options of the programs."""
    try:
        yield
    except Error as error:
        error.args = (in_python(str(error)),)
        error.place = in_python(error.place)
        error.problem = in_python(error.problem)
        error.remedy = in_python(error.remedy)
        raise


def warn_of_doubts(what: str, reasons: Sequence[str]) -> None:
    """One warning with all reasons, at the caller of the function that calls this."""
    if not reasons:
        return
    text = reasons[0]
    if len(reasons) > 1:
        text = f"doubtful, for {len(reasons)} reasons:" + "".join(f"\n- {why}" for why in reasons)
    warnings.warn(f"{what}: {text}", DoubtfulResult, stacklevel=3)
