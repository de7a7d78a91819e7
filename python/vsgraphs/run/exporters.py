"""Exporters: functions of a Result that make files. Those of the program, and those of plug-ins."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from vsgraphs.errors import InputError
from vsgraphs.export.floorplan import format_floorplan
from vsgraphs.export.planes_ply import format_planes_ply
from vsgraphs.export.spark_dsg import format_spark_dsg
from vsgraphs.plugins import plugin
from vsgraphs.reading import shown
from vsgraphs.run.result import Result
from vsgraphs.scene_graph import SceneGraph

Files = Mapping[str, str | bytes]
# A finished run -> the content of files, by name. What the files hold is in the result's frame.
Exporter = Callable[[Result], Files]


def exporter(name: str) -> Exporter:
    """The one of this name. Raises InputError where there is none, or it cannot be loaded."""
    if name in BUILT_IN:
        return BUILT_IN[name]
    found = plugin("exporter", name, tuple(BUILT_IN))
    found.load()
    return found.call


def checked_files(files: object, name: str) -> Files:
    """What an exporter made. Raises InputError unless it is the content of files with plain names."""
    if not isinstance(files, Mapping):
        raise InputError(f"exporter {name}: expected {{file name: content}}, got {type(files).__name__}")
    for file, content in files.items():
        if not isinstance(file, str) or file in ("", ".", "..") or "/" in file or "\0" in file:
            raise InputError(f"exporter {name}: {shown(file)} is not the plain name of a file")
        if not isinstance(content, str | bytes):
            raise InputError(f"exporter {name}: {file} holds {type(content).__name__}, not str or bytes")
    return files


def _graph(result: Result) -> SceneGraph:
    if result.scene_graph is None:
        raise InputError(f"{result.folder} holds no scene graph: it is of a run with --mode slam")
    return result.scene_graph


BUILT_IN: dict[str, Exporter] = {
    "floorplan": lambda r: {"floorplan.svg": format_floorplan(_graph(r), r.trajectory.positions)},
    "planes": lambda r: {"planes.ply": format_planes_ply(_graph(r))},
    "spark-dsg": lambda r: {"scene_graph.dsg.json": format_spark_dsg(_graph(r))},
}
