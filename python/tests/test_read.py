"""Results against the files, read by other programs."""

import csv
import gc
import json
import math
import shutil
import warnings
import weakref
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import vtk
from conftest import ROOT
from vtk.util.numpy_support import vtk_to_numpy

import crumble


def polydata(path: Path) -> Any:
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def test_tables_hold_every_value_of_the_files(
    dropped: crumble.Results, recwarn: pytest.WarningsRecorder
) -> None:
    recwarn.clear()
    dropped = crumble.read(dropped.folder)
    wanted = ["distribution", "events", "fragment_tree", "fragments", "series"]
    assert dropped.tables == wanted
    for name in wanted:
        table = getattr(dropped, name)
        with open(dropped.folder / f"{name.replace('_', '-')}.csv", newline="") as file:
            rows = list(csv.reader(file))
        assert list(table.columns) == rows[0] and len(table) == len(rows) - 1 > 0
        for at, column in enumerate(rows[0]):
            for value, text in zip(table[column], (row[at] for row in rows[1:]), strict=True):
                if isinstance(value, str):
                    assert value == text
                else:
                    assert math.isnan(value) if text in ("", "NaN") else value == float(text)
    assert list(recwarn) == []
    assert dropped.table("fragment-tree").equals(dropped.table("fragment_tree"))


def test_energies_are_the_columns_in_joule(dropped: crumble.Results) -> None:
    energy = dropped.energy
    assert list(energy.columns)[:3] == ["time_s", "kinetic_energy_j", "elastic_energy_j"]
    assert "wall_plate_work_j" in energy and "energy_error" not in energy
    assert energy["kinetic_energy_j"].iloc[0] == pytest.approx(0.124, rel=0.01)


def test_summary_measures_and_verdict(dropped: crumble.Results) -> None:
    assert dropped.summary["particles"] == 829
    assert set(dropped.measures) == {"largest", "push"}
    assert dropped.measures["largest"] == dropped.series["largest"].iloc[-1]
    # Peaks are recorded between the rows of the series, too.
    assert dropped.measures["push"] >= dropped.series["push_n"].max() > 0
    assert dropped.units == {"largest": "", "push": "N"}
    verdict = dropped.verdict
    assert (verdict.word, verdict.sound, len(verdict.warnings)) == ("doubtful", False, 1)
    assert "fewer than 10 the result reflects the particles" in verdict.coarse[0]


def test_verdicts_of_all_versions_are_read(tmp_path: Path) -> None:
    why = ("a bond is long",)
    sound, doubtful = crumble.Verdict("sound"), crumble.Verdict("doubtful", why)
    for summary, wanted in [
        ({"verdict": {"sound": True, "warnings": []}}, sound),
        ({"verdict": {"sound": False, "warnings": why}}, doubtful),
        ({"verdict": {"word": "sound", "sound": True, "warnings": []}}, sound),
        ({"verdict": {"word": "doubtful", "sound": False, "warnings": why}}, doubtful),
        (
            {"verdict": {"word": "coarse", "sound": False, "warnings": [], "coarse": why}},
            crumble.Verdict("coarse", (), why),
        ),
        # A run that did not reach its end.
        (
            {"problem": "it burst", "verdict": {"sound": True, "warnings": why}},
            crumble.Verdict("doubtful", ("it burst", *why)),
        ),
        ({"problem": why[0], "verdict": {"sound": False, "warnings": why}}, doubtful),
        ({"problem": why[0]}, doubtful),
    ]:
        (tmp_path / "summary.json").write_text(json.dumps(summary))
        assert crumble.read(tmp_path).verdict == wanted
        assert wanted.sound == (wanted.word == "sound")


def test_frames_are_those_that_vtk_reads(dropped: crumble.Results) -> None:
    frames = dropped.frames
    assert len(frames) == 31 and frames.times_s[0] == 0 and frames.times_s[-1] == pytest.approx(3e-3)
    for number in (0, 15, 30):
        frame = frames[number]
        data = polydata(frame.path)
        assert frame.time_s == frames.times_s[number]
        assert frame.time_s == data.GetFieldData().GetArray("TimeValue").GetValue(0)
        assert frame.body_names == ["tablet"]
        points = {"position_m": vtk_to_numpy(data.GetPoints().GetData())}
        lines = {"particles": vtk_to_numpy(data.GetLines().GetConnectivityArray()).reshape(-1, 2)}
        for found, of in ((points, data.GetPointData()), (lines, data.GetCellData())):
            for at in range(of.GetNumberOfArrays()):
                found[of.GetArrayName(at)] = vtk_to_numpy(of.GetArray(at))
        for ours, theirs in ((frame.particles, points), (frame.bonds, lines)):
            assert set(ours) == set(theirs) and len(ours) > 9
            for name, values in theirs.items():
                np.testing.assert_array_equal(ours[name], values, err_msg=name)
                assert (ours[name].dtype.kind == "i") == (values.dtype.kind in "iu"), name


def test_walls_are_those_that_vtk_reads(dropped: crumble.Results) -> None:
    frame = dropped.frames[10]
    walls = frame.walls
    assert walls is not None and walls.names == ["plate"]
    data = polydata(frame.path.with_name("walls_000010.vtp"))
    np.testing.assert_array_equal(walls.points_m, vtk_to_numpy(data.GetPoints().GetData()))
    triangles = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    np.testing.assert_array_equal(walls.triangles, triangles)
    np.testing.assert_array_equal(walls.wall, vtk_to_numpy(data.GetCellData().GetArray("wall")))
    forces = vtk_to_numpy(data.GetFieldData().GetArray("wall_force_n")).reshape(-1, 3)
    np.testing.assert_array_equal(walls.force_n, forces)


def test_frames_are_read_one_by_one(dropped: crumble.Results) -> None:
    alive: list[weakref.ref[crumble.Frame]] = []
    times = []
    for frame in dropped.frames:
        times.append(frame.time_s)
        alive.append(weakref.ref(frame))
        gc.collect()
        # This one, and none before it.
        assert [ref() is None for ref in alive[:-1]] == [True] * (len(alive) - 1)
    np.testing.assert_array_equal(times, dropped.frames.times_s)


def test_frames_are_a_sequence(dropped: crumble.Results) -> None:
    frames = dropped.frames
    assert frames[-1].time_s == frames[30].time_s
    some = frames[5:20:5]
    assert isinstance(some, crumble.Frames) and len(some) == 3
    np.testing.assert_array_equal(some.times_s, frames.times_s[[5, 10, 15]])
    assert [frame.time_s for frame in reversed(some)] == list(some.times_s[::-1])
    with pytest.raises(IndexError):
        frames[31]
    assert [frames.at(time).time_s for time in ("1.52 ms", 1.52e-3)] == [frames[15].time_s] * 2
    assert frames.at("-0.05 ms").time_s == 0 and frames.at(3.05e-3).time_s == frames[30].time_s
    with pytest.raises(crumble.Error, match="time: there are no frames near 0.02 s; .* from 0 s to 0.003 s"):
        frames.at("20 ms")
    with pytest.raises(crumble.Error, match="unknown unit 'mm'"):
        frames.at("5 mm")
    with pytest.raises(crumble.Error, match="the run has no frames"):
        frames[:0].at(0)
    assert repr(frames) == "<31 frames>" and "829 particles" in repr(frames[0])


def test_a_run_without_walls_and_bonds(tmp_path: Path) -> None:
    scene = tmp_path / "fall.toml"
    scene.write_text(
        """version = 1
run = { end_time = "1 ms", gravity = [0, 0, -9.81] }
materials.stone = { density = 2600 }
bodies.ball = { particles = [[0, 0, 0, 0.01]], material = "stone" }
"""
    )
    results = crumble.run(scene, tmp_path / "out")
    frame = results.frames[-1]
    assert frame.walls is None and frame.bonds["particles"].shape == (0, 2)
    assert frame.particles["velocity_m_s"].shape == (1, 3)
    with pytest.raises(crumble.Error, match="there is no such table; the run wrote .*series"):
        results.discharge  # noqa: B018
    (tmp_path / "out" / "frames.pvd").unlink()
    assert len(results.frames) == 0 and list(results.frames) == []


def test_what_is_no_folder_of_a_run_is_refused(tmp_path: Path) -> None:
    with pytest.raises(crumble.Error, match="this is not the folder of a run"):
        crumble.read(tmp_path)
    with pytest.raises(crumble.Error, match="none: there is no summary.json in it, so") as caught:
        crumble.read(tmp_path / "none")
    assert caught.value.place == str(tmp_path / "none")


def test_damaged_frames_are_refused(dropped: crumble.Results, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(dropped.folder, copy)
    frame = copy / "frames" / "frame_000003.vtp"
    frame.write_bytes(frame.read_bytes()[:-5000])
    with pytest.raises(crumble.Error, match="frame_000003.vtp.*the file ends too early"):
        crumble.read(copy).frames[3]
    frame.unlink()
    with pytest.raises(crumble.Error, match="frame_000003.vtp"):
        crumble.read(copy).frames[3]
    (copy / "frames.pvd").write_text("<VTKFile>")
    with pytest.raises(crumble.Error, match="this is not an index of frames"):
        crumble.read(copy).frames  # noqa: B018


def test_a_stored_body_is_read(dropped: crumble.Results) -> None:
    body = crumble.read_body(ROOT / "data" / "bodies" / "cake.vtp")
    assert body.position_m.shape == (len(body.radius_m), 3)
    assert body.bonds.max() < len(body.radius_m)
    with pytest.raises(crumble.Error, match="this is a shape, not a body"):
        crumble.read_body(ROOT / "data" / "shapes" / "rock.stl")


def test_numbers_of_things_are_whole(template: Path, tmp_path: Path) -> None:
    count = {"of": "fragments", "quantity": "count"}
    measures = {"pieces": count, "mean": {**count, "statistic": "mean"}}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", crumble.DoubtfulResult)
        results = crumble.run(
            template / "scene.toml", tmp_path / "out", run={"end_time": "0.01 ms"}, measures=measures
        )
    assert repr(results.measures["pieces"]) == "1" and repr(results.measures["mean"]) == "1.0"
    assert isinstance(results.measures["push"], float)
