"""Files of results."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from crumble._errors import Error

if TYPE_CHECKING:
    import pandas as pd


def read_table(file: Path, texts: Sequence[str] = ()) -> pd.DataFrame:
    """A table of comma-separated values. The columns `texts` are texts, where they are empty, too."""
    # Imported here, so that the programs start without it.
    import pandas as pd

    # Every number to the bit that was written: what newer versions do in any case.
    is_older = tuple(int(part) for part in pd.__version__.split(".")[:2]) < (3, 1)
    options: dict[str, Any] = {"float_precision": "round_trip"} if is_older else {}
    # Names such as None and NA are names.
    options |= {"keep_default_na": False, "na_values": ["", "NaN"]}
    table = pd.read_csv(file, dtype=dict.fromkeys(texts, "str"), **options)
    filled: pd.DataFrame = table.fillna(dict.fromkeys(texts, ""))
    return filled


def read_json(folder: Path, name: str, of: str) -> dict[str, Any]:
    """The file of this name, which every folder of what `of` says has."""
    try:
        text = (folder / name).read_text(encoding="utf-8")
    except OSError as problem:
        why = f"there is no {name} in it, so this is not the folder of {of}"
        raise Error(f"{folder}: {why}", 2, str(folder), why) from problem
    values: dict[str, Any] = json.loads(text)
    return values
