"""From a plan to a sequence on disk, several frames at a time."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from vsgraphs.compiled import core
from vsgraphs.errors import InputError
from vsgraphs.plans import LoadedPlan, load_plan
from vsgraphs.simulate.camera import simulated_camera
from vsgraphs.simulate.folder import FolderInTheMaking
from vsgraphs.simulate.options import Output
from vsgraphs.simulate.stream import Shot, schedule
from vsgraphs.simulate.writer import Record, SequenceWriter


@dataclass(frozen=True)
class Simulation:
    """What was written."""

    folder: Path
    frames: int
    complete: bool  # False: stopped early; the folder holds the frames so far
    path_length_m: float


def simulate(  # noqa: PLR0913  (keywords, each with its default)
    plan: str | Path | Mapping[str, Any] | LoadedPlan,
    out_dir: str | Path,
    *,
    seed: int = 0,
    noise: str | Mapping[str, float | bool] = "sensor",
    sensor: str | None = None,
    effects: Mapping[str, Any] | None = None,
    frames: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
    output: Output | None = None,
) -> Simulation:
    """Renders a plan into `out_dir`.

    The folder appears whole or not at all; a stop (`should_stop` returning True, Ctrl-C) leaves the frames so
    far as a shorter, valid sequence. The same plan, seed and options give the same bytes, whatever the number
    of workers.

    Args:
      plan: name of an included plan, a plan file, nested dicts, or what `load_plan` returned.
      out_dir: created; must not exist or be empty, unless `output.overwrite`.
      seed: which draw of the sensor's noise. The place, the walk and the truth depend on the plan alone.
      noise: "sensor", "clean" (exact), or effects.
      sensor: classic, clean, kinect1, kinect2, d435 or iphone_lidar; the plan's, or classic, unless given.
      effects: of the camera and its frames, by name (`effect_names`), before the sensor's and the plan's.
      frames: at most so many frames are written.
      progress: called with (frames written, frames in all).
      should_stop: asked after each frame.
      output: rate, thinning, file formats.

    Raises InputError for anything the caller can cure, naming file and key.
    """
    options = output or Output()
    options.check()
    loaded = plan if isinstance(plan, LoadedPlan) else load_plan(plan)
    camera = simulated_camera(loaded, noise=noise, sensor=sensor, effects=effects, seed=seed)
    if options.fps is not None:
        loaded.plan.fps = options.fps
    try:
        scene = core().build_scene(loaded.plan)
    except ValueError as error:
        raise InputError(f"{loaded.source}: {error}") from None
    indices = list(range(0, scene.frame_count, options.every))[:frames]
    if not indices:
        raise InputError(f"frames must be at least 1, not {frames}")
    with FolderInTheMaking(Path(out_dir), overwrite=options.overwrite) as folder:
        writer = SequenceWriter(scene, camera, folder.path, options)
        shots = schedule(indices, loaded.plan.fps, camera.stream, seed)
        try:
            records = _render_all(writer, shots, options.workers, progress, should_stop)
        except OSError as error:
            raise InputError(f"cannot write {out_dir}: {error.strerror or error}") from None
        if not records:
            return Simulation(Path(out_dir), 0, complete=False, path_length_m=0.0)
        length = writer.write_lists(records, loaded)
        folder.keep()
    return Simulation(Path(out_dir), len(records), len(records) == len(shots), length)


def _render_all(
    writer: SequenceWriter,
    shots: list[Shot],
    workers: int | None,
    progress: Callable[[int, int], None] | None,
    should_stop: Callable[[], bool] | None,
) -> list[Record]:
    """Frames in order; after a stop, those before the first one that is missing."""
    workers = workers or min(4, len(os.sched_getaffinity(0)))
    done: dict[int, Record] = {}
    pending: dict[Future[Record], int] = {}
    upcoming = iter(enumerate(shots))
    stopped = False
    with ThreadPoolExecutor(workers) as pool:
        while True:
            try:
                while not stopped and len(pending) < 2 * workers:
                    following = next(upcoming, None)
                    if following is None:
                        break
                    number, shot = following
                    pending[pool.submit(writer.frame, shot, number)] = number
                if not pending:
                    break
                finished, _ = wait(pending, return_when=FIRST_COMPLETED)
                for future in finished:
                    done[pending.pop(future)] = future.result()
                if progress is not None:
                    progress(len(done), len(shots))
                if not stopped and should_stop is not None and should_stop():
                    stopped = True
            except KeyboardInterrupt:
                if stopped:
                    raise
                stopped = True
    records: list[Record] = []
    while len(records) in done:
        records.append(done[len(records)])
    return records
