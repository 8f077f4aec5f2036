"""Progress of long work."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Progress = Callable[[float, str], object]
"""Is called with the fraction done, 0 to 1, and a text."""


@contextmanager
def shown(progress: bool | Progress) -> Iterator[Progress | None]:
    """What to call with the progress. None: nothing. What is written for True is removed at the
    end.
    """
    if not isinstance(progress, bool):
        yield progress
        return
    if not progress:
        yield None
        return
    longest = 0

    def tell(fraction: float, text: str) -> None:
        nonlocal longest
        line = f"{100 * fraction:3.0f} %  {text}"
        longest = max(longest, len(line))
        print("\r" + line.ljust(longest), end="", file=sys.stderr, flush=True)

    try:
        yield tell
    finally:
        print("\r" + " " * longest + "\r", end="", file=sys.stderr, flush=True)
