"""What a run is asked for: the keywords of `vsgraphs.run`, each declared here and nowhere else."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from vsgraphs.errors import InputError
from vsgraphs.run.settings import Value
from vsgraphs.run.watching import Showing

if TYPE_CHECKING:
    from vsgraphs.run.events import KeyframeEvent, LoopEvent, RoomEvent
    from vsgraphs.run.exporters import Exporter
    from vsgraphs.run.extensions import Check
    from vsgraphs.run.listener import Message, Progress
    from vsgraphs.segment import RecordedSegmentations, Segmenter
    from vsgraphs.sources import Source

MAP_COLOURS = ("image", "class")
StrPath = str | Path


@dataclass
class RunRequest:
    """What a run is made of; `vsgraphs.run` takes these as arguments.

    source: a sequence's folder, or any source of frames (vsgraphs.sources). out: directory for the results;
    those of an earlier run in it are replaced. None: a new ./NAME_vsgraphs, numbered.

    The keywords are the options of `vsgraphs run --help`, None where its default holds. A few differ:
    config is its YAML file and options are its --set, as {key: value} or as texts "KEY=VALUE"; segmenter may
    be a function or object of vsgraphs.segment; showing is what to show it in.

    exporters: names of exporters, or functions (Result) -> {file name: content}. checks: functions (Result)
    -> lines that are warnings of the run; None: all that are installed.

    on_progress: called after each frame and each step of the end. on_message: called with each line that the
    command line would print, from any thread. on_keyframe, on_room, on_loop: called between two frames with
    what is new, see vsgraphs.run.events. stop: asked before each frame, and while a live source has none;
    True ends the run as Ctrl-C does. An exception that a callback raises ends the run likewise, and is raised
    once all is written.
    """

    source: StrPath | Source
    out: StrPath | None = None
    _: KW_ONLY
    camera: str | None = None
    mode: str | None = None
    execution: str | None = None
    realtime: bool | None = None
    every: int = 1
    max_frames: int | None = None
    config: StrPath | None = None
    options: Mapping[str, Value] | Sequence[str] = ()
    seed: int | None = None
    segmenter: str | Segmenter | RecordedSegmentations = "geometry"
    markers: StrPath | None = None
    map_colours: str = "image"
    schedule_out: StrPath | None = None
    replay: StrPath | None = None
    showing: Showing = field(default_factory=Showing)
    save_atlas: StrPath | None = None
    load_atlas: StrPath | None = None
    localise_only: bool = False
    autosave_s: float | None = None
    frame_timeout_s: float = 10.0
    overwrite: bool = False
    keep: int = 1
    exporters: Sequence[str | Exporter] = ()
    checks: Sequence[Check] | None = None
    on_progress: Callable[[Progress], object] | None = None
    on_message: Callable[[Message], object] | None = None
    on_keyframe: Callable[[KeyframeEvent], object] | None = None
    on_room: Callable[[RoomEvent], object] | None = None
    on_loop: Callable[[LoopEvent], object] | None = None
    stop: Callable[[], bool] = lambda: False

    def shortcuts(self) -> dict[str, Value]:
        """Options of the core that have a keyword of their own, where they are given."""
        paths = {"system.schedule_out": self.schedule_out, "system.replay": self.replay}
        given: dict[str, Value | None] = {
            "system.mode": self.mode,
            "system.execution": self.execution,
            "system.realtime": self.realtime,
            "system.seed": self.seed,
            **{key: None if path is None else str(path) for key, path in paths.items()},
            "system.localise_only": self.localise_only or None,
        }
        return {key: value for key, value in given.items() if value is not None}

    def check(self) -> None:
        """Raises InputError for what can be known before anything is opened."""
        if self.every < 1 or (self.max_frames is not None and self.max_frames < 1):
            raise InputError("every and max_frames must be 1 or more")
        if self.camera is not None and not isinstance(self.source, str | Path):
            raise InputError("camera goes with a folder; a source says its camera itself")
        if self.map_colours not in MAP_COLOURS:
            raise InputError(f"--map-colours {self.map_colours}: must be one of {', '.join(MAP_COLOURS)}")

    def check_schedule_out(self) -> None:
        """The core writes the schedule when all is done: better to know before that it cannot. InputError."""
        if self.schedule_out is None:
            return
        folder = Path(self.schedule_out).parent
        if not (folder.is_dir() and os.access(folder, os.W_OK)):
            raise InputError(
                f"--schedule-out {self.schedule_out}: {folder} is not a directory that can be written to"
            )
