"""Exporters and checks at the end of a run: what they make and say; what they break is a line."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import TYPE_CHECKING, Any

from vsgraphs.errors import InputError
from vsgraphs.export.atomic import write_atomically
from vsgraphs.plugins import Plugin, plugins
from vsgraphs.run.exporters import Exporter, checked_files, exporter
from vsgraphs.run.result import Result
from vsgraphs.run.summary import RESULT_FILES

if TYPE_CHECKING:
    from pathlib import Path

    from vsgraphs.run.listener import Listener
    from vsgraphs.run.result_folder import ResultFolder

# A finished run -> what a person should know of it, a line each.
Check = Callable[[Result], Iterable[str]]


class Extensions:
    """Of a run. exporters: names or functions. checks: functions; None: all that are installed.

    Raises InputError for an exporter that is not there.
    """

    def __init__(self, exporters: Iterable[str | Exporter], checks: Iterable[Check] | None) -> None:
        self._exporters = [
            (each, exporter(each)) if isinstance(each, str) else (_name(each), each) for each in exporters
        ]
        self._checks = checks
        self.warnings: list[str] = []
        self.exported: list[str] = []  # names of files
        self.found: dict[str, list[str]] = {}  # by check

    def run(self, result: Result, folder: ResultFolder, listener: Listener) -> None:
        """Has files written and the result looked at. Never raises what an extension raises."""
        for name, export in self._exporters:
            listener.doing(f"exporting {name}")
            self._guarded(name, partial(self._export, name, export, result, folder), listener)
        checks = self._installed() if self._checks is None else [(_name(c), c) for c in self._checks]
        for name, check in checks:
            listener.doing(f"checking {name}")
            self._guarded(name, partial(self._check, name, check, result), listener)

    def report(self) -> dict[str, Any]:
        """For run.json; empty where there was nothing to do."""
        exported = {"exported": self.exported} if self._exporters else {}
        return {**exported, **({"checks": self.found} if self.found else {})}

    def _export(self, name: str, export: Exporter, result: Result, folder: ResultFolder) -> None:
        files = checked_files(export(result), name)
        taken = [file for file in files if file in RESULT_FILES]
        if taken:
            raise InputError(f"exporter {name}: {taken[0]} is a file of every run; give it another name")
        folder.write([(file, _writer(file, content)) for file, content in files.items()], lambda _: None)
        self.exported += files

    def _check(self, name: str, check: Check, result: Result) -> None:
        lines = [" ".join(str(line).split()) for line in check(result)]
        self.found[name] = lines
        self.warnings += [f"{name}: {line}" for line in lines]

    def _guarded(self, name: str, step: Callable[[], object], listener: Listener) -> None:
        try:
            step()
        except Exception as error:
            reason = str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"
            line = " ".join(reason.split())
            self.warnings.append(line if name in line else f"{name} failed: {line}")
            listener.event(f"warning: {self.warnings[-1]}")

    def _installed(self) -> list[tuple[str, Check]]:
        return [(name, _called(each)) for name, each in plugins("check").items()]


def _called(each: Plugin) -> Check:
    return each.call


def _writer(file: str, content: str | bytes) -> Callable[[Path], object]:
    return lambda folder: write_atomically(folder / file, content)


def _name(function: Callable[..., Any]) -> str:
    return str(getattr(function, "__name__", type(function).__name__))
