"""Studies, and the tables of their folders."""

import csv
import json
import os
import signal
import subprocess
import warnings
from pathlib import Path

import pytest
from conftest import ROOT, RUST

import crumble

STUDY = f"""version = 1
scene = "{ROOT / 'data/scenes/spinning-bar.toml'}"
repeats = 1

[vary]
"run.end_time" = {{ values = ["1 ms", "2 ms"], names = ["None", "NA"] }}
"run.safety_factor" = [0.9, 0.5]

[measures.tip_x]
reference = "none"

[measures.energy]
balance = "energy"
"""
THICKNESS = ROOT / "data" / "studies" / "bar-thickness.toml"


@pytest.fixture(scope="session")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of four short runs."""
    file = tmp_path_factory.mktemp("study") / "spin.toml"
    file.write_text(STUDY)
    return file


@pytest.fixture(scope="session")
def swept(study: Path) -> crumble.Sweep:
    """Its results, in a folder whose parents did not exist."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return crumble.sweep(study, out=study.parent / "far" / "away", jobs=2)


def test_the_runs_are_those_of_the_program(study: Path, swept: crumble.Sweep, tmp_path: Path) -> None:
    line = [RUST / "dem-run", "sweep", study, "--output", tmp_path / "theirs", "--quiet"]
    subprocess.run(line, check=True)
    theirs = crumble.read_sweep(tmp_path / "theirs")
    for name in ("run.end_time", "run.safety_factor", "steps", "tip_x_value (m)", "energy_value", "verdict"):
        assert list(swept.table[name]) == list(theirs.table[name]), name
    assert swept.responses.equals(theirs.responses)
    assert swept.folder == study.parent / "far" / "away"
    assert repr(swept) == f"<Sweep of 4 runs in {swept.folder}>"


def test_tables_hold_the_values_of_the_files(swept: crumble.Sweep) -> None:
    for name, table in [("sweep", swept.table), ("responses", swept.responses)]:
        with open(swept.folder / f"{name}.csv", newline="") as file:
            rows = list(csv.reader(file))
        assert list(table.columns) == rows[0] and len(table) == len(rows) - 1 > 0
        for at, column in enumerate(rows[0]):
            for value, text in zip(table[column], (row[at] for row in rows[1:]), strict=True):
                assert value == text if isinstance(value, str) else (value != value) == (text == "")
                assert isinstance(value, str) or text == "" or value == float(text)
    # Texts are texts, even those that pandas takes for missing numbers; the rest are numbers.
    assert list(swept.table["run.end_time"]) == ["None", "None", "NA", "NA"]
    assert set(swept.table["failed"]) == {""} and set(swept.table["verdict"]) == {"sound"}
    assert swept.table["run.safety_factor"].dtype == swept.table["tip_x_value (m)"].dtype == float
    assert swept.table["steps"].dtype == swept.table["run"].dtype == int
    assert set(swept.responses["unit"]) == {"m"}


def test_the_summary_is_that_of_the_file(swept: crumble.Sweep) -> None:
    assert swept.summary == json.loads((swept.folder / "sweep.json").read_text())
    assert swept.notes == swept.summary["notes"] and swept.summary["threads"] == 1
    run = crumble.read(swept.folder / "runs" / "0003-1")
    assert run.measures["tip_x"] == swept.table["tip_x_value (m)"][2]
    assert run.units == {"tip_x": "m", "kinetic_energy": "J"}


def test_a_sweep_is_refused_continued_or_replaced(study: Path, tmp_path: Path) -> None:
    out = tmp_path / "sweep"
    first = crumble.sweep(study, out=out, threads=2)
    assert first.summary["threads"] == 2
    with pytest.raises(crumble.Error, match="resume=True.*force=True.*another folder with out") as caught:
        crumble.sweep(study, out=out)
    assert caught.value.exit_code == 2 and caught.value.place == str(out)
    kept = (out / "runs" / "0001-1" / "summary.json").stat().st_mtime_ns
    crumble.sweep(study, out=out, threads=2, resume=True)
    assert (out / "runs" / "0001-1" / "summary.json").stat().st_mtime_ns == kept
    crumble.sweep(study, out=out, force=True)
    assert (out / "runs" / "0001-1" / "summary.json").stat().st_mtime_ns > kept


def test_the_folder_is_named_after_the_study(
    study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert crumble.sweep(study).folder == Path("spin-sweep")
    assert (tmp_path / "spin-sweep" / "sweep.html").is_file()


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"jobs": 0}, "jobs: 0 is not between 1 and 1024"),
        ({"threads": 0}, "threads: 0 is not between 1 and 1024"),
        ({"resume": True, "force": True}, "'resume=True' cannot be used with 'force=True'"),
    ],
)
def test_bad_arguments_are_refused(study: Path, settings: dict[str, int], said: str, tmp_path: Path) -> None:
    with pytest.raises(crumble.Error) as caught:
        crumble.sweep(study, out=tmp_path / "out", **settings)  # type: ignore[arg-type]
    assert said in str(caught.value) and caught.value.exit_code == 2
    with pytest.raises(crumble.Error, match="none.toml: there is no such file"):
        crumble.sweep(tmp_path / "none.toml", out=tmp_path / "out")
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "file").touch()
    with pytest.raises(crumble.Error, match="cannot be written"):
        crumble.sweep(study, out=tmp_path / "file" / "out")


def test_doubtful_runs_are_one_warning(tmp_path: Path) -> None:
    with pytest.warns(crumble.DoubtfulResult) as caught:
        found = crumble.sweep(THICKNESS, out=tmp_path / "out", jobs=2)
    [text] = [str(one.message) for one in caught]
    assert text.startswith(f"{THICKNESS}: 35 of 36 runs are doubtful; the first, run 2: tip_deflection ")
    assert caught[0].filename == __file__
    assert any(note.startswith("35 of 36 runs are doubtful") for note in found.notes)
    # What [find] found, between the ends of its intervals.
    assert list(found.find["result"]) == ["found"] * 3
    factors = found.find["bonds.steel.radius_factor"]
    assert (factors > found.find["from"]).all() and (factors < found.find["to"]).all()


def test_failed_runs_raise_and_the_others_have_results(study: Path, tmp_path: Path) -> None:
    failing = tmp_path / "failing.toml"
    failing.write_text(STUDY.replace('"run.safety_factor" = [0.9, 0.5]', '"run.time_step" = ["0.9 ms", "1 us"]'))
    with pytest.raises(crumble.Error, match="2 of 4 runs did not come to their end") as caught:
        crumble.sweep(failing, out=tmp_path / "out")
    assert caught.value.exit_code == 1 and "resume=True tries them again" in str(caught.value)
    table = crumble.read_sweep(tmp_path / "out").table
    assert list(table["failed"] == "") == [False, True] * 2
    assert list(table["tip_x_value (m)"].isna()) == [True, False] * 2


def test_progress_is_told_and_nothing_is_printed(
    study: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    told: list[tuple[float, str]] = []
    crumble.sweep(study, out=tmp_path / "out", progress=lambda *so_far: told.append(so_far))
    assert capfd.readouterr() == ("", "")
    assert told[-1] == (1.0, "4 of 4 runs done") and told == sorted(told)


def test_ctrl_c_ends_a_sweep_which_goes_on(study: Path, swept: crumble.Sweep, tmp_path: Path) -> None:
    told: list[str] = []

    def interrupt_once(fraction: float, text: str) -> None:
        if fraction > 0 and not told:
            told.append(text)
            os.kill(os.getpid(), signal.SIGINT)

    longer = tmp_path / "longer.toml"
    longer.write_text(STUDY.replace('"2 ms"', '"2 s"'))
    with pytest.raises(KeyboardInterrupt):
        crumble.sweep(longer, out=tmp_path / "out", progress=interrupt_once)
    assert told == ["1 of 4 runs done"]
    with pytest.raises(crumble.Error, match="there is no sweep.json in it"):
        crumble.read_sweep(tmp_path / "out")
    whole = crumble.sweep(longer, out=tmp_path / "out", resume=True)
    assert list(whole.table["tip_x_value (m)"][:2]) == list(swept.table["tip_x_value (m)"][:2])


def test_what_is_no_sweep_is_refused(swept: crumble.Sweep, tmp_path: Path) -> None:
    with pytest.raises(crumble.Error, match="sweep.json in it, so this is not the folder of a sweep") as caught:
        crumble.read_sweep(tmp_path)
    assert (caught.value.exit_code, caught.value.place) == (2, str(tmp_path))
    with pytest.raises(crumble.Error, match=r"find.csv: there is no such table: the study has no \[find\]"):
        swept.find  # noqa: B018


def test_a_design_has_ranked_effects(tmp_path: Path) -> None:
    text = STUDY[: STUDY.index("[vary]")] + """[design]
kind = "morris"
trajectories = 2

[design.ranges]
"run.safety_factor" = [0.4, 0.8]

[measures.tip_x]
"""
    file = tmp_path / "design.toml"
    file.write_text(text)
    swept = crumble.sweep(file, out=tmp_path / "out", jobs=2)
    for effects in (swept.effects, crumble.read_sweep(tmp_path / "out").effects):
        assert list(effects["parameter"]) == ["run.safety_factor"]
        assert list(effects["effects"]) == [2] and list(effects["parameter_unit"]) == [""]
        assert effects["mu_star"].dtype == float
    assert swept.summary["design"]["morris"][0]["measure"] == 0
    with pytest.raises(crumble.Error, match=r"find.csv: there is no such table"):
        swept.find  # noqa: B018
