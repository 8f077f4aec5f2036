"""What can go wrong."""

from __future__ import annotations


class Error(RuntimeError):
    """Bad input, or work that failed. The text is the message of the programs, on one line: place,
    problem with value and limit, remedy.
    """

    exit_code: int
    """2 for bad input, 1 for work that failed, 3 for a run that went unstable."""
    place: str
    """File, line or option. May be empty."""
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
