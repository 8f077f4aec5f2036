"""One packed and one dropped tablet for all tests."""

import os
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
    """The folder of `dem-run new drop`: a tablet that falls onto a plate and breaks."""
    folder = tmp_path_factory.mktemp("template") / "drop"
    crumble.command("dem-run", "new", "drop", folder)
    return folder


@pytest.fixture(scope="session")
def dropped(template: Path) -> crumble.Results:
    """Its results."""
    with pytest.warns(crumble.DoubtfulResult) as caught:
        results = crumble.run(template / "scene.toml", template / "results")
    # One warning with all reasons, of which this scene has one.
    [reason] = results.verdict.warnings
    assert [str(one.message) for one in caught] == [f"{template / 'scene.toml'}: {reason}"]
    return results
