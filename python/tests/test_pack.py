"""Packing, and bodies in memory and in files."""

import os
import signal
import subprocess
import warnings
from pathlib import Path

import numpy as np
import pytest
import vtk
from conftest import RUST, SHAPES
from vtk.util.numpy_support import vtk_to_numpy

import crumble

TABLET = SHAPES / "tablet.stl"


def pack(**settings: object) -> crumble.Body:
    return crumble.pack(TABLET, "1mm..1.2mm", **settings)  # type: ignore[arg-type]


def test_the_body_is_that_of_the_program(tmp_path: Path) -> None:
    body = pack(out=tmp_path / "ours.vtp", overlap=0.3, seed=7, bond_range=1.05, densify=0.04)
    options = ["--diameter", "1mm..1.2mm", "--overlap", "0.3", "--seed", "7", "--densify", "0.04"]
    theirs = tmp_path / "theirs.vtp"
    line = [RUST / "dem-pack", TABLET, *options, "--bond-range", "1.05", "-o", theirs, "--quiet"]
    subprocess.run(line, check=True)
    assert (tmp_path / "ours.vtp").read_bytes() == theirs.read_bytes()
    assert body.path == tmp_path / "ours.vtp"
    assert body.about["seed"] == 7 and body.about["overlap"] == 0.3


def test_arrays_are_those_that_vtk_reads(tmp_path: Path) -> None:
    body = pack(out=tmp_path / "body.vtp")
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(body.path))
    reader.Update()
    data = reader.GetOutput()
    points, lines = data.GetPointData(), data.GetCellData()
    assert len(body.radius_m) > 100 and len(body.bonds) > len(body.radius_m)
    np.testing.assert_array_equal(body.position_m, vtk_to_numpy(data.GetPoints().GetData()))
    np.testing.assert_array_equal(body.radius_m, vtk_to_numpy(points.GetArray("radius_m")))
    ends = vtk_to_numpy(data.GetLines().GetConnectivityArray()).reshape(-1, 2)
    np.testing.assert_array_equal(body.bonds, ends)
    for name in ("bond_radius_m", "initial_length_m"):
        np.testing.assert_array_equal(getattr(body, name), vtk_to_numpy(lines.GetArray(name)))
    assert body.report is not None
    assert body.report["quality"]["particles"] == len(body.radius_m)
    assert repr(body) == f"<Body of {len(body.radius_m)} particles and {len(body.bonds)} bonds in {body.path}>"


def test_every_option_has_its_effect(tmp_path: Path) -> None:
    changes: dict[str, object] = {
        "unit": "cm",
        "scale": 1.5,
        "basis": "mass",
        "overlap": 0.1,
        "particle_density": "2 g/cm3",
        "seed": 2,
        "seed_point": (0, 0, "2 mm"),
        "densify": 0,
        "bond_range": 1.0,
        "bonds_per_particle": 3,
        "bond_radius": 0.5,
    }
    usual = pack(out=tmp_path / "usual.vtp")
    bytes_of = {"none": (tmp_path / "usual.vtp").read_bytes()}
    for name, value in changes.items():
        file = tmp_path / f"{name}.vtp"
        diameter = "10mm..12mm" if name == "unit" else "1mm..1.2mm"
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", crumble.DoubtfulResult)
            crumble.pack(TABLET, diameter, out=file, **{name: value})  # type: ignore[arg-type]
        bytes_of[name] = file.read_bytes()
    assert len(set(bytes_of.values())) == len(bytes_of)
    again = pack(threads=1, fill_holes=True)
    np.testing.assert_array_equal(again.position_m, usual.position_m)
    # A number is metres.
    metres = crumble.pack(TABLET, 1.1e-3)
    assert set(metres.radius_m) == {0.55e-3}


def test_a_density_is_met() -> None:
    body = pack(particle_density=2000, solid_density="1500 kg/m3")
    assert body.report is not None
    found = body.report["density_search"]["found_kg_m3"]
    assert found == pytest.approx(1500, rel=0.02)


@pytest.mark.parametrize("ending", ["vtp", "data", "csv", "txt"])
def test_bodies_are_written_and_read(tmp_path: Path, ending: str) -> None:
    body = pack()
    assert body.path is None
    body.write(tmp_path / f"body.{ending}")
    again = crumble.read_body(tmp_path / f"body.{ending}")
    np.testing.assert_allclose(again.position_m, body.position_m, rtol=1e-12)
    np.testing.assert_array_equal(again.bonds, body.bonds)
    assert again.report is None and again.path == tmp_path / f"body.{ending}"


def test_warnings_of_the_report_are_warnings_of_python() -> None:
    with pytest.warns(crumble.DoubtfulResult, match="3 bonds per particle") as caught:
        body = crumble.pack(TABLET, "1mm..1.2mm", bonds_per_particle=3)
    assert [str(one.message) for one in caught] == [f"{TABLET}: {text}" for text in body.warnings]
    assert all(one.filename == __file__ for one in caught)


def test_a_coarse_body_is_not_warned_of(tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        body = crumble.pack(TABLET, "1mm..1.2mm", out=tmp_path / "body.vtp")
    assert body.warnings == [] and body.report is not None
    assert body.coarse is not None and "with fewer than 10 the result reflects the particles" in body.coarse
    assert body.report["quality"]["coarse"] == body.coarse
    assert crumble.read_body(tmp_path / "body.vtp").coarse == body.coarse
    # Tables do not say how thick the body is.
    body.write(tmp_path / "body.csv")
    assert crumble.read_body(tmp_path / "body.csv").coarse is None


def test_folders_of_bodies_are_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    body = pack(out=tmp_path / "far" / "away" / "body.vtp")
    body.write(tmp_path / "further" / "body.csv")
    assert crumble.read_body(tmp_path / "further" / "body.csv").bonds.shape == body.bonds.shape
    monkeypatch.chdir(tmp_path)
    pack(out="body.vtp")
    with pytest.raises(crumble.Error, match="body.vtp: this is a file, where a folder is needed"):
        pack(out="body.vtp/body.vtp")
    with pytest.raises(crumble.Error, match="is not a folder"):
        body.write("body.vtp/far/body.vtp")
    with pytest.raises(crumble.Error, match="is not at least 0"):
        pack(out="other/body.vtp", overlap=-0.5)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["body.vtp", "far", "further"]


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"overlap": 2}, "overlap: 2 is not at least 0 and below 1"),
        ({"overlap": -0.5}, "overlap: -0.5 is not at least 0"),
        ({"unit": "parsec"}, "unit: unknown unit 'parsec'; use one of"),
        ({"threads": 0}, "threads: 0 is not between 1 and 1024"),
        ({"out": "body.stl"}, "'.stl' is not the ending of a body"),
        ({"solid_density": 1500}, "particle_density"),
        ({"seed": -1}, "a seed is a whole number from 0 to"),
    ],
)
def test_bad_settings_are_refused_with_the_message_of_the_program(
    settings: dict[str, object], said: str
) -> None:
    with pytest.raises(crumble.Error) as caught:
        pack(**settings)
    # Arguments have their names in Python.
    assert said in str(caught.value)
    assert "--" not in str(caught.value) + caught.value.place + caught.value.remedy
    assert caught.value.exit_code == 2


def test_a_missing_shape_is_refused() -> None:
    with pytest.raises(crumble.Error, match="none.stl: there is no such file; check its name") as caught:
        crumble.pack("none.stl", "1mm")
    error = caught.value
    assert (error.exit_code, error.place) == (2, "none.stl")
    assert (error.problem, error.remedy) == ("there is no such file", "check its name and folder")


def test_progress_is_told_and_nothing_is_printed(capfd: pytest.CaptureFixture[str]) -> None:
    told: list[tuple[float, str]] = []
    crumble.pack(SHAPES / "filter-cake.stl", "3mm..4mm", progress=lambda *so_far: told.append(so_far))
    assert told and all(0 <= fraction <= 1 and text for fraction, text in told)
    assert capfd.readouterr() == ("", "")
    pack(progress=True)
    said = capfd.readouterr()
    assert said.out == "" and "%" in said.err and said.err.endswith("\r")


def test_ctrl_c_ends_packing_and_leaves_no_file(tmp_path: Path) -> None:
    stages = []

    def interrupt_once(fraction: float, stage: str) -> None:
        stages.append(stage)
        os.kill(os.getpid(), signal.SIGINT)

    out = tmp_path / "rock.vtp"
    with pytest.raises(KeyboardInterrupt):
        crumble.pack(SHAPES / "rock.stl", "0.4mm..0.5mm", out=out, progress=interrupt_once)
    # Nothing was told after the signal, and nothing was written.
    assert len(stages) == 1 and list(tmp_path.iterdir()) == []


def test_an_exception_in_the_progress_ends_packing() -> None:
    def fail(fraction: float, text: str) -> None:
        raise LookupError(text)

    with pytest.raises(LookupError):
        crumble.pack(SHAPES / "rock.stl", "0.4mm..0.5mm", progress=fail)
