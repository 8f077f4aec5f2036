"""Type hints, by mypy --strict."""

import subprocess
import sys
from pathlib import Path

PROGRAM = """
import numpy as np
import crumble

body = crumble.pack("a.stl", "2mm..3mm", out="a.vtp", overlap=0.3, seed_point=(0, 0, "1 mm"))
results = crumble.run("s.toml", body={"cake": body}, set={"run.end_time": "1 s"}, run={"gravity": [0, 0, -9.81]})
for frame in results.frames[::2]:
    speed = np.linalg.norm(frame.particles["velocity_m_s"], axis=1)
study = crumble.sweep("study.toml", out="study-out", jobs=2, threads=1, progress=True)
reveal_type(results.series)
reveal_type(study.table)
reveal_type(results.verdict.word)
reveal_type(results.frames[0])
reveal_type(body.radius_m)
crumble.run("s.toml", threads="many")
crumble.pack("a.stl")
crumble.sweep("study.toml", "study-out")
"""


def mypy(*words: str) -> subprocess.CompletedProcess[str]:
    line = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", "/dev/null", *words]
    return subprocess.run(line, capture_output=True, text=True)


def test_the_package_is_typed() -> None:
    done = mypy("-p", "crumble")
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_stub_describes_the_extension() -> None:
    line = [sys.executable, "-m", "mypy.stubtest", "crumble._crumble"]
    done = subprocess.run(line, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_programs_that_use_it_are_checked(tmp_path: Path) -> None:
    file = tmp_path / "program.py"
    file.write_text(PROGRAM)
    said = mypy(str(file)).stdout
    for wanted in ('type is "crumble._frames.Frame"', "float64", "Literal['sound']"):
        assert wanted in said, said
    assert said.count('type is "pandas.') == 2, said
    assert said.count("error:") == 3, said
    assert "arg-type" in said and "call-arg" in said and "Too many positional" in said, said
