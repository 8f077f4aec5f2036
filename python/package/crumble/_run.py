"""Runs of scenes."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Union

from crumble import _crumble
from crumble._body import Body
from crumble._errors import arguments_of_python, warn_of_doubts
from crumble._programs import command, own_command
from crumble._progress import Progress, shown
from crumble._results import Results
from crumble._set import Value, overrides

BodyFile = Union[str, "os.PathLike[str]", Body]
"""The file of a body, or a body that has one."""


def run(
    scene: str | os.PathLike[str],
    out: str | os.PathLike[str] | None = None,
    *,
    set: Mapping[str, Value] | None = None,
    body: BodyFile | Mapping[str, BodyFile] | None = None,
    material: Sequence[str | os.PathLike[str]] = (),
    threads: int | None = None,
    resume: bool = False,
    force: bool = False,
    keep: str = "all",
    force_step: bool = False,
    progress: bool | Progress = False,
    **tables: Value,
) -> Results:
    """Runs a scene, as `dem-run` does, and returns its results.

    `out` is the folder of the results, made with those that it is in; without it, `folder` in
    `[output]` of the scene, else the scene's name with -out in the working directory. A folder that
    holds results is refused unless `force` (they are replaced) or `resume` (the run goes on from
    its checkpoint).

    `keep="tables"` removes frames, pictures, plots and checkpoint at the end of the run; summary,
    tables, page and scene stay.

    `set` changes values of the scene, as `--set` does: `{"run.end_time": "0.2 s"}`. Tables may be
    keyword arguments: `run={"end_time": "0.2 s"}`, `bonds={"cake": {"young_modulus": "20 MPa"}}`
    change these keys and leave the others. Numbers without a unit are SI.

    `body` replaces the body of a scene that has one, or those named in a mapping: files, or bodies
    that were written to a file. `material` names files of materials, contacts and bonds.
    `threads`: all cores unless given; the results are the same for any number. `force_step`
    accepts a time step above the largest stable one. `progress=True` shows the progress on
    standard error; a function is called with the fraction done and a text.

    Raises `Error` with the message of the program; warns `DoubtfulResult` with all reasons where
    the verdict is doubtful. Ctrl-C stops the run after its present step, writes its results and a
    checkpoint, and raises `KeyboardInterrupt`; `read` opens the folder, `resume=True` goes on.
    Several threads of Python may call it at a time, with `threads=1` for as many runs as cores.
    """
    changes = overrides(set, tables)
    with arguments_of_python():
        folder = os.fspath(out) if out is not None else _crumble.results_folder(scene, changes)
    arguments = [f"--output={os.fspath(folder)}", f"--keep={keep}", "--quiet"]
    for given, name in [(resume, "--resume"), (force, "--force")]:
        if given:
            arguments.append(name)
    arguments += _scene_arguments(changes, body, material, threads, force_step)
    with arguments_of_python(), shown(progress) as tell:
        _crumble.run(own_command("dem-run"), [*arguments, "--", os.fspath(scene)], tell)
    results = Results(Path(folder))
    if results.verdict.word == "doubtful":
        warn_of_doubts(os.fspath(scene), results.verdict.warnings)
    return results


def check(
    scene: str | os.PathLike[str],
    *,
    set: Mapping[str, Value] | None = None,
    body: BodyFile | Mapping[str, BodyFile] | None = None,
    material: Sequence[str | os.PathLike[str]] = (),
    threads: int | None = None,
    force_step: bool = False,
    **tables: Value,
) -> dict[str, Any]:
    """Checks a scene without running it: time step and why, stages, memory, estimated run time,
    warnings. It is what `dem-run check --json` prints; the arguments are those of `run`.

    Raises `Error` with the message of the program.
    """
    changes = overrides(set, tables)
    arguments = _scene_arguments(changes, body, material, threads, force_step)
    with arguments_of_python():
        said = command("dem-run", "check", "--json", *arguments, "--", scene)
    plan: dict[str, Any] = json.loads(said)
    return plan


def _scene_arguments(
    changes: list[str],
    body: BodyFile | Mapping[str, BodyFile] | None,
    material: Sequence[str | os.PathLike[str]],
    threads: int | None,
    force_step: bool,
) -> list[str]:
    arguments = [f"--set={change}" for change in changes]
    if isinstance(body, Mapping):
        arguments += [f"--body={name}={_file(one)}" for name, one in body.items()]
    elif body is not None:
        arguments.append(f"--body={_file(body)}")
    arguments += [f"--material={os.fspath(file)}" for file in material]
    if threads is not None:
        arguments.append(f"--threads={threads}")
    if force_step:
        arguments.append("--force-step")
    return arguments


def _file(body: BodyFile) -> str:
    if not isinstance(body, Body):
        return os.fspath(body)
    if body.path is None:
        raise ValueError("this body is in memory only; write it first: body.write('cake.vtp')")
    return os.fspath(body.path)
