import os
from collections.abc import Callable
from typing import final

__all__ = [
    "StoredBody",
    "pack",
    "program",
    "read_body",
    "read_frame",
    "read_walls",
    "results_folder",
    "run",
    "time_s",
]

_Column = tuple[bytearray, str, int]
_Tell = Callable[[float, str], object]

@final
class StoredBody:
    def arrays(self) -> dict[str, _Column]: ...
    def about(self) -> str: ...
    def coarse(self) -> str | None: ...
    def write(self, path: str | os.PathLike[str]) -> None: ...

def pack(
    arguments: list[str],
    output: str | os.PathLike[str] | None,
    threads: int | None,
    tell: _Tell | None,
) -> tuple[StoredBody, str]: ...
def read_body(path: str | os.PathLike[str]) -> StoredBody: ...
def run(command: list[str], arguments: list[str], tell: _Tell | None) -> None: ...
def results_folder(scene: str | os.PathLike[str], overrides: list[str]) -> str: ...
def time_s(text: str) -> float: ...
def read_frame(
    path: str | os.PathLike[str],
) -> tuple[float | None, list[str], dict[str, _Column]]: ...
def read_walls(path: str | os.PathLike[str]) -> tuple[float, list[str], dict[str, _Column]]: ...
def program(name: str, command: list[str], arguments: list[str]) -> int: ...
