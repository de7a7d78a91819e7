"""`vsgraphs plugins` and `vsgraphs export`: what other packages add, and files made from a finished run."""

from __future__ import annotations

from pathlib import Path

from vsgraphs.errors import InputError
from vsgraphs.export.atomic import prepare_directory, write_atomically
from vsgraphs.plugins import KINDS, plugins
from vsgraphs.run import Result
from vsgraphs.run.exporters import BUILT_IN, checked_files, exporter

_OWN = {
    "source": ("a sequence's folder",),
    "segmenter": ("geometry", "onnx", "labels", "source"),
    "exporter": tuple(BUILT_IN),
    "check": (),
}
# What `Result.load` reads.
_KEPT = ("run.json", "trajectory.txt", "keyframes.txt", "scene_graph.json")


def list_plugins() -> None:
    """Prints the program's own and those of packages; of one that cannot be loaded why, and the cure."""
    for kind in KINDS:
        print(f"{kind}s")
        for name in _OWN[kind]:
            print(f"  {name:20} vsgraphs")
        for name, each in plugins(kind).items():
            try:
                each.load()
            except InputError as error:
                print(f"  {name:20} {error}")
            else:
                print(f"  {name:20} {each.package}")
        if not _OWN[kind] and not plugins(kind):
            print("  none")


def export_run(run: Path, names: list[str], out: Path | None) -> None:
    """Writes what exporters make of a finished run, into its directory or `out`. Raises InputError."""
    makers = {name: exporter(name) for name in names}
    result = Result.load(run)
    folder = run if out is None else out
    prepare_directory(folder)
    for name, make in makers.items():
        for file, content in checked_files(make(result), name).items():
            if file in _KEPT:
                raise InputError(f"exporter {name}: {file} holds the run itself and is not replaced")
            write_atomically(folder / file, content)
            print(f"{name}: {folder / file}")
