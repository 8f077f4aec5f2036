"""One packed and one dropped tablet for all tests."""

import math
import os
import shutil
import signal
import sys
from pathlib import Path

import pytest

import crumble

ROOT = Path(__file__).resolve().parents[2]
SHAPES = ROOT / "data" / "shapes"
# The programs built from Rust, made by python/check.
RUST = Path(os.environ["CRUMBLE_RUST_PROGRAMS"])
# The programs of the package.
SCRIPTS = Path(sys.executable).parent


# A shell that starts the tests in the background lets them ignore Ctrl-C.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def template(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a scene, `drop.toml` here, and its body: a tablet falls onto a plate and breaks."""
    folder = tmp_path_factory.mktemp("template")
    shutil.copy(Path(__file__).with_name("drop.toml"), folder / "scene.toml")
    write_cylinder(folder / "shape.stl", 15, 12)
    crumble.pack(folder / "shape.stl", "2.4mm..3mm", overlap=0.25, out=folder / "body.vtp")
    return folder


def write_cylinder(file: Path, radius: float, height: float) -> None:
    """A shape (.stl): a cylinder around the z axis."""
    corners = 32
    angles = [2 * math.pi * k / corners for k in range(corners + 1)]
    low = [(radius * math.cos(angle), radius * math.sin(angle), 0) for angle in angles]
    high = [(x, y, height) for x, y, _ in low]
    facets = []
    for k in range(1, corners - 1):
        facets += [(low[0], low[k + 1], low[k]), (high[0], high[k], high[k + 1])]
    for k in range(corners):
        facets += [(low[k], low[k + 1], high[k + 1]), (low[k], high[k + 1], high[k])]
    lines = ["solid shape"]
    for facet in facets:
        vertices = [f"vertex {x} {y} {z}" for x, y, z in facet]
        lines += ["facet normal 0 0 0", "outer loop", *vertices, "endloop", "endfacet"]
    file.write_text("\n".join([*lines, "endsolid shape", ""]))


@pytest.fixture(scope="session")
def dropped(template: Path) -> crumble.Results:
    """Its results."""
    with pytest.warns(crumble.DoubtfulResult) as caught:
        results = crumble.run(template / "scene.toml", template / "results")
    # One warning with all reasons, of which this scene has one.
    [reason] = results.verdict.warnings
    assert [str(one.message) for one in caught] == [f"{template / 'scene.toml'}: {reason}"]
    return results
