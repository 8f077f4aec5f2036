"""Runs of scenes."""

import os
import signal
import subprocess
import threading
import time
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT, RUST

import crumble
from crumble._errors import in_python, warn_of_doubts
from crumble._set import overrides, toml

SPIN = ROOT / "data" / "scenes" / "spinning-bar.toml"
CANTILEVER = ROOT / "data" / "scenes" / "cantilever.toml"


def test_results_are_those_of_the_program(template: Path, dropped: crumble.Results, tmp_path: Path) -> None:
    line = [RUST / "dem-run", template / "scene.toml", "--output", tmp_path / "theirs", "--quiet"]
    subprocess.run(line, check=True)
    names = [path.relative_to(tmp_path / "theirs") for path in (tmp_path / "theirs").rglob("*")]
    compared = [name for name in names if name.suffix in (".csv", ".vtp", ".pvd", ".png")]
    assert len(compared) > 60
    for name in compared:
        ours = (dropped.folder / name).read_bytes()
        assert ours == (tmp_path / "theirs" / name).read_bytes(), name


def test_settings_reach_the_scene(tmp_path: Path) -> None:
    results = crumble.run(
        SPIN,
        tmp_path / "spin",
        set={"run.end_time": "10 ms"},
        run={"gravity": np.array([0, 0, -1.62]), "safety_factor": np.float64(0.5)},
        threads=1,
    )
    scene = results.summary["inputs"]["scene"]
    assert scene["run.end_time"] == "0.01 s"
    assert scene["run.gravity"] == "[0, 0, -1.62] m/s2"
    assert scene["run.safety_factor"] == "0.5"
    assert results.summary["simulated_s"] == pytest.approx(0.01, rel=1e-2)
    assert results.summary["threads"] == 1
    assert results.verdict == crumble.Verdict("sound")


def test_tables_alone_are_kept(tmp_path: Path) -> None:
    results = crumble.run(SPIN, tmp_path / "spin", set={"run.end_time": "10 ms"}, keep="tables")
    left = {path.name for path in results.folder.iterdir()}
    assert {"summary.json", "series.csv", "report.html"} <= left
    assert not {"frames", "plots", "checkpoint"} & {name.split(".")[0] for name in left}
    with pytest.raises(crumble.Error, match="keep"):
        crumble.run(SPIN, tmp_path / "other", keep="nothing")


def test_values_of_python_as_toml() -> None:
    given: dict[str, Any] = {"bodies": {"cake": {"drop": {"height": "1 m"}, "bonds": "a\"b"}}}
    paths = ['run.adaptive=true', 'bodies.cake.drop.height="1 m"', 'bodies.cake.bonds="a\\"b"']
    assert overrides({"run.adaptive": True}, given) == paths
    deep = {"a": {"b": {"c": {"d": {"e": 1, "f": [1.5, "x"]}}}}}
    assert overrides(None, deep) == ['a.b.c.d={"e" = 1, "f" = [1.5, "x"]}']
    assert toml(np.arange(3)) == "[0, 1, 2]" and toml(1e-7) == "1e-07" and toml(Path("a/b")) == '"a/b"'
    with pytest.raises(TypeError, match="not NoneType"):
        toml(None)  # type: ignore[arg-type]


def test_bodies_replace_those_of_the_scene(template: Path, tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", crumble.DoubtfulResult)
        body = crumble.pack(template / "shape.stl", "5mm..6mm")
        with pytest.raises(ValueError, match="in memory only"):
            crumble.run(template / "scene.toml", tmp_path / "out", body=body)
        body.write(tmp_path / "coarse.vtp")
        for number, given in enumerate([body, {"tablet": body}, tmp_path / "coarse.vtp"]):
            out = tmp_path / f"out-{number}"
            results = crumble.run(template / "scene.toml", out, body=given, run={"end_time": "0.1 ms"})
            assert results.summary["particles"] == len(body.radius_m)


def test_the_folder_is_that_of_the_scene_or_named_after_it(
    template: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    results = crumble.run(SPIN, run={"end_time": "1 ms"})
    assert results.folder == Path("spinning-bar-out") and results.folder.is_dir()
    inside = crumble.run(SPIN, run={"end_time": "1 ms"}, output={"folder": str(tmp_path / "named")})
    assert inside.folder == tmp_path / "named"


def test_results_are_not_overwritten_unless_asked(tmp_path: Path) -> None:
    first = crumble.run(SPIN, tmp_path / "spin", run={"end_time": "1 ms"})
    with pytest.raises(crumble.Error, match="force=True.*resume=True") as caught:
        crumble.run(SPIN, tmp_path / "spin", run={"end_time": "1 ms"})
    assert caught.value.exit_code == 2
    second = crumble.run(SPIN, tmp_path / "spin", run={"end_time": "2 ms"}, force=True)
    assert second.summary["simulated_s"] > 1.5 * first.summary["simulated_s"]


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"run": {"end_tim": "1 s"}}, "did you mean"),
        ({"run": {"end_tim": "1 s"}}, "set run.end_tim="),
        ({"run": {"end_time": "1,5 s"}}, "write a decimal point"),
        ({"run": {"end_time": "5 mm"}}, "unknown unit 'mm'; use one of ns, us, ms, s, min, h"),
        ({"body": {"nobody": "x.vtp"}}, "the scene has no body 'nobody'"),
        ({"threads": 2000}, "threads: 2000 is not between 1 and 1024"),
        ({"resume": True}, "there is no such folder, so no run to continue"),
        ({"resume": True, "force": True}, "'resume=True' cannot be used with 'force=True'"),
    ],
)
def test_bad_scenes_are_refused_with_the_message_of_the_program(
    settings: dict[str, Any], said: str, tmp_path: Path
) -> None:
    with pytest.raises(crumble.Error) as caught:
        crumble.run(SPIN, tmp_path / "out", **settings)
    assert said in str(caught.value) and caught.value.exit_code == 2
    assert "--" not in str(caught.value)
    with pytest.raises(crumble.Error):
        crumble.run(tmp_path / "none.toml", tmp_path / "out")
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "file").touch()
    for out, remedy in [("file", "this is a file, where a folder is needed"), ("file/out", "is not a folder")]:
        with pytest.raises(crumble.Error, match=remedy):
            crumble.run(SPIN, tmp_path / out)


def test_progress_is_told_and_nothing_is_printed(
    template: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    told: list[tuple[float, str]] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", crumble.DoubtfulResult)
        crumble.run(template / "scene.toml", tmp_path / "a", progress=lambda *so_far: told.append(so_far))
        assert capfd.readouterr() == ("", "")
        crumble.run(template / "scene.toml", tmp_path / "b", progress=True)
    fractions = [fraction for fraction, _ in told]
    assert len(told) > 3 and fractions == sorted(fractions)
    assert all(text.endswith("bonds broken") for _, text in told)
    said = capfd.readouterr()
    assert said.out == "" and "simulated" in said.err


def test_python_goes_on_during_a_run(template: Path, tmp_path: Path) -> None:
    ended = threading.Event()
    counts: list[int] = []

    def count() -> None:
        number = 0
        while not ended.is_set():
            number += 1
            time.sleep(0.001)
        counts.append(number)

    counter = threading.Thread(target=count)
    counter.start()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", crumble.DoubtfulResult)
        results = crumble.run(template / "scene.toml", tmp_path / "out", threads=1)
    ended.set()
    counter.join()
    # A thread that had to wait for the run would have counted to 1.
    assert counts[0] > 20 * results.summary["wall_s"]


def test_runs_side_by_side_give_the_same(tmp_path: Path) -> None:
    def spin(out: str) -> bytes:
        results = crumble.run(SPIN, tmp_path / out, threads=1, run={"end_time": f"{out[-1]} ms"})
        return (results.folder / "series.csv").read_bytes()

    # Folders whose parents are made, at the same time.
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(spin, [f"together/far/{number}" for number in (5, 6, 7, 8)]))
    assert together == [spin(f"alone/{number}") for number in (5, 6, 7, 8)]
    assert len(set(together)) == 4


def test_ctrl_c_keeps_the_results_and_the_run_goes_on(
    template: Path, dropped: crumble.Results, tmp_path: Path
) -> None:
    scene, out = template / "scene.toml", tmp_path / "out"
    begun = threading.Event()

    def once(fraction: float, text: str) -> None:
        if fraction > 0.2 and not begun.is_set():
            begun.set()
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        crumble.run(scene, out, progress=once)
    half = crumble.read(out)
    assert half.summary["ended_by"] == "interruption" and half.verdict.word == "doubtful"
    assert 0 < len(half.series) < len(dropped.series) and len(half.frames) > 2
    assert half.verdict.warnings[0].startswith("interrupted")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", crumble.DoubtfulResult)
        whole = crumble.run(scene, out, resume=True)
    for file in ("series.csv", "events.csv", "fragments.csv", "frames/frame_000030.vtp"):
        assert (whole.folder / file).read_bytes() == (dropped.folder / file).read_bytes()


def test_an_unstable_run_raises_and_has_results(tmp_path: Path) -> None:
    scene = ROOT / "data" / "scenes" / "clamped.toml"
    body = ROOT / "data" / "bodies" / "sample-coarse.vtp"
    with pytest.raises(crumble.Error) as caught:
        crumble.run(scene, tmp_path / "out", body=body, run={"time_step": "1 ms"}, force_step=True)
    assert caught.value.exit_code == 3
    results = crumble.read(tmp_path / "out")
    assert results.summary["ended_by"] == "instability" and results.verdict.word == "doubtful"


def test_a_coarse_run_is_not_warned_of(template: Path, tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        results = crumble.run(template / "scene.toml", tmp_path / "out", run={"end_time": "0.01 ms"})
    assert (results.verdict.word, results.verdict.sound, results.verdict.warnings) == ("coarse", False, ())
    [reason] = results.verdict.coarse
    assert "only about 4.4 particles across the thinnest part" in reason


def test_a_doubtful_run_is_one_warning(tmp_path: Path) -> None:
    with pytest.warns(crumble.DoubtfulResult) as caught:
        results = crumble.run(
            CANTILEVER,
            tmp_path / "out",
            run={"integrator": "static"},
            bonds={"steel": {"radius_factor": 1.5}},
        )
    assert results.verdict.word == "doubtful"
    [reason] = results.verdict.warnings
    assert [str(one.message) for one in caught] == [f"{CANTILEVER}: {reason}"]
    assert reason == "tip_deflection is outside its tolerance" and caught[0].filename == __file__


def test_several_doubts_are_one_warning() -> None:
    with pytest.warns(crumble.DoubtfulResult) as caught:
        warn_of_doubts("scene.toml", ["a bond is long", "a step is long"])
    text = "scene.toml: doubtful, for 2 reasons:\n- a bond is long\n- a step is long"
    assert [str(one.message) for one in caught] == [text]


def test_check_is_a_dry_run(template: Path) -> None:
    plan = crumble.check(template / "scene.toml", run={"safety_factor": 0.45})
    usual = crumble.check(template / "scene.toml")
    # The end of the run is a whole number of steps.
    half_s = usual["time_step_s"] / 2
    assert plan["time_step_s"] == pytest.approx(half_s, rel=1 / usual["steps"])
    assert usual["particles"] == 829 and usual["coarse"] and not usual["warnings"]
    with pytest.raises(crumble.Error, match="end_tim"):
        crumble.check(template / "scene.toml", run={"end_tim": 1})


def test_options_have_their_names_in_python(dropped: crumble.Results) -> None:
    for theirs, ours in [
        ("--set run.end_time=1: a; use --force, or --resume", "set run.end_time=1: a; use force=True, or resume=True"),
        ("--bond-range: 9 is above 2 (--fill-holes)", "bond_range: 9 is above 2 (fill_holes=True)"),
        ("name another folder with --output", "name another folder with out"),
        ("a--b/--force.toml: 1--2", "a--b/--force.toml: 1--2"),
    ]:
        assert in_python(theirs) == ours
    # Commands keep the words of the programs.
    with pytest.raises(crumble.Error, match="--frame 99"):
        crumble.command("dem-run", "fragment", dropped.folder, "--frame", "99", "--id", "1")


def test_errors_and_warnings_are_named_as_they_are_imported() -> None:
    assert f"{crumble.Error.__module__}.{crumble.Error.__qualname__}" == "crumble.Error"
    assert crumble.DoubtfulResult.__module__ == "crumble"
