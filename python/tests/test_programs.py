"""The programs of the package are those built from Rust."""

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from conftest import ROOT, RUST, SCRIPTS

import crumble


def said(folder: Path, program: str, *words: str) -> tuple[int, str, str]:
    line = [folder / program, *words]
    done = subprocess.run(line, capture_output=True, text=True, cwd=ROOT, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize(
    "line",
    [
        "dem-pack --help",
        "dem-pack --version",
        "dem-pack man",
        "dem-pack completions bash",
        "dem-pack info data/bodies/cake.vtp",
        "dem-pack info data/shapes/rock.stl --json",
        "dem-pack none.stl --diameter 1mm",
        "dem-pack data/shapes/rock.stl --diameter 1mm --settle",
        "dem-pack",
        "dem-run --help",
        "dem-run sweep --help",
        "dem-run --version",
        "dem-run keys bodies",
        "dem-run check data/scenes/none.toml",
        "dem-run frobnicate",
        "dem-run data/scenes/cantilever.toml --set run.end_tim=1",
        "dem-run data/bodies/cake.vtp",
    ],
)
def test_the_same_words_and_exit_codes(line: str) -> None:
    program, *words = line.split()
    ours, theirs = said(SCRIPTS, program, *words), said(RUST, program, *words)
    assert ours == theirs
    assert ours[1] or ours[2]


def test_a_pipe_between_the_programs(tmp_path: Path) -> None:
    outputs = []
    for folder in (SCRIPTS, RUST):
        line = "dem-pack data/shapes/tablet.stl --diameter 1mm..1.2mm --quiet | dem-run --body -"
        environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}
        done = subprocess.run(["bash", "-c", line], cwd=ROOT, env=environment, capture_output=True)
        assert done.returncode == 0, done.stderr
        outputs.append(done.stdout)
    assert outputs[0] == outputs[1] != b""


def test_colours_are_as_in_the_programs() -> None:
    coloured = []
    for folder in (SCRIPTS, RUST):
        environment = {**os.environ, "CLICOLOR_FORCE": "1"}
        line = [folder / "dem-run", "none.toml"]
        coloured.append(subprocess.run(line, env=environment, capture_output=True).stderr)
    assert coloured[0] == coloured[1] and b"\x1b[" in coloured[0]


def test_a_study_starts_the_program_again(template: Path, tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    study.write_text(
        f"""version = 1
scene = "{ROOT / 'data/scenes/spinning-bar.toml'}"
repeats = 1

[vary]
"run.end_time" = ["1 ms", "2 ms"]

[measures.energy]
balance = "energy"
"""
    )
    code, out, err = said(SCRIPTS, "dem-run", "sweep", str(study), "--output", str(tmp_path / "sweep"))
    assert code == 0, err
    assert (tmp_path / "sweep" / "sweep.csv").read_text().count("\n") == 3
    listed = said(SCRIPTS, "dem-run", "sweep", str(study), "--output", str(tmp_path / "l"), "--list")
    lines = listed[1].splitlines()
    assert len(lines) == 2 and all(" -m crumble dem-run " in line for line in lines)
    subprocess.run(["sh", "-c", lines[0]], check=True, cwd=ROOT)


def test_ctrl_c_is_as_in_the_programs(template: Path, tmp_path: Path) -> None:
    ended = []
    for number, folder in enumerate((SCRIPTS, RUST)):
        out = tmp_path / str(number)
        line = [folder / "dem-run", template / "scene.toml", "--output", out, "--threads", "1"]
        process = subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while not (out / "frames" / "frame_000002.vtp").exists():
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate()
        error = [line for line in err.splitlines() if line.startswith("error")]
        ended.append((process.returncode, [line.split(" at ")[0] for line in error]))
        assert (out / "checkpoint.dem").exists()
    assert ended[0] == ended[1]
    assert ended[0][0] == 130


def test_commands_return_what_is_printed_or_raise() -> None:
    assert crumble.command("dem-pack", "--version").startswith("dem-pack 0.")
    with pytest.raises(crumble.Error, match="none.vtp: there is no such file") as caught:
        crumble.command("dem-run", "none.vtp")
    assert caught.value.exit_code == 2
    with pytest.raises(ValueError, match="dem-pack or dem-run"):
        crumble.command("ls")
