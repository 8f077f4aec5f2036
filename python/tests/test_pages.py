"""The Python code of `doc/python.md` and the notebook run."""

import re
import shutil
import warnings
from pathlib import Path
from typing import cast

import matplotlib
import nbformat
import pandas as pd
import pytest
from conftest import ROOT
from nbclient import NotebookClient

import crumble

NOTEBOOK = ROOT / "python" / "examples" / "first_break.ipynb"


def run_code_of(
    page: str, blocks_at_least: int, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> dict[str, object]:
    """The names that the Python code of a page leaves, run in a folder with copies of `data`."""
    for name in ("bodies", "scenes", "shapes", "studies"):
        shutil.copytree(ROOT / "data" / name, folder / "data" / name)
    monkeypatch.chdir(folder)
    matplotlib.use("Agg")
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)
    assert len(blocks) >= blocks_at_least
    names: dict[str, object] = {}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", crumble.DoubtfulResult)
        # Twice: the second time over the results of the first.
        for block in blocks + blocks:
            exec(compile(block, page, "exec"), names)
    return names


def test_the_code_of_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = run_code_of("doc/python.md", 8, tmp_path, monkeypatch)
    assert (tmp_path / "cake.vtp").is_file() and (tmp_path / "cake-falls-out" / "report.html").is_file()
    assert (tmp_path / "falls-out" / "5" / "report.html").is_file()
    made = [path.name for path in tmp_path.iterdir() if path.name != "data"]
    assert all(name.endswith((".vtp", "-out")) for name in made), "what .gitignore names"
    # The rows are those of one time, not one fragment at five times.
    heaviest = cast("pd.DataFrame", names["heaviest"])
    assert heaviest["fragment_id"].is_unique and heaviest["time_s"].nunique() == 1
    assert len(cast("crumble.Sweep", names["study"]).find) == 3


def test_the_code_of_the_readme_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = run_code_of("python/README.md", 1, tmp_path, monkeypatch)
    assert len(cast("crumble.Sweep", names["study"]).find) == 3
    assert cast("crumble.Results", names["fall"]).units == {"pieces": ""}


def wording(notebook: nbformat.NotebookNode) -> list[str]:
    """What the cells print, without numbers: these may differ in the last digits on other processors."""
    printed = [output.get("text", "") for cell in notebook.cells for output in cell.get("outputs", [])]
    return [re.sub(r"[-\d.e]*\d", "#", text) for text in printed]


def test_the_notebook_runs(tmp_path: Path) -> None:
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    stored_wording = wording(notebook)
    stored = [len(cell.get("outputs", [])) for cell in notebook.cells]
    assert sum(stored) >= 4, "the notebook is stored with its outputs"
    shutil.copytree(ROOT / "data", tmp_path / "data")
    (tmp_path / "python" / "examples").mkdir(parents=True)
    folder = {"metadata": {"path": str(tmp_path / "python" / "examples")}}
    NotebookClient(notebook, timeout=300, kernel_name="python3", resources=folder).execute()
    assert [len(cell.get("outputs", [])) for cell in notebook.cells] == stored
    assert wording(notebook) == stored_wording, "the notebook is stored with old output: run it again"
