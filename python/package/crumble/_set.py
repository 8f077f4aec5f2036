"""Values of a scene as `--set` takes them."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Union

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

Value = Union[
    bool,
    int,
    float,
    str,
    "os.PathLike[str]",
    Sequence["Value"],
    Mapping[str, "Value"],
    "np.generic",
    "npt.NDArray[Any]",
]
"""A value of a scene: a quantity is a text with its unit, or a number in SI."""

DEEPEST = 4
"""Parts of the longest key that `--set` takes; what is below is set as a whole."""


def overrides(paths: Mapping[str, Value] | None, tables: Mapping[str, Value]) -> list[str]:
    """The arguments of `--set`: those of the paths first."""
    return [
        f"{path}={toml(value)}"
        for given in (paths or {}, tables)
        for key, item in given.items()
        for path, value in _entries(key, item)
    ]


def _entries(path: str, value: Value) -> Iterator[tuple[str, Value]]:
    if isinstance(value, Mapping) and value and path.count(".") + 1 < DEEPEST:
        for key, inner in value.items():
            yield from _entries(f"{path}.{key}", inner)
    else:
        yield path, value


def toml(value: Value) -> str:
    """A value as TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(float(value))
    if isinstance(value, (str, os.PathLike)):
        # Texts of JSON are texts of TOML, but for one control character.
        return json.dumps(os.fspath(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{toml(key)} = {toml(v)}" for key, v in value.items()) + "}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    # Numbers and arrays of numpy.
    plain = getattr(value, "tolist", None)
    if plain is None:
        kind = type(value).__name__
        raise TypeError(f"a value of a scene is a number, a text, a list or a dict, not {kind}")
    return toml(plain())
