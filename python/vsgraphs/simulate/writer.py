"""Frames and lists on disk, in TUM RGB-D layout with the truth beside them."""

from __future__ import annotations

import json
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from vsgraphs.compiled import core
from vsgraphs.plans import LoadedPlan
from vsgraphs.simulate.camera import SimulatedCamera
from vsgraphs.simulate.folder import MARK
from vsgraphs.simulate.motion import write_motion
from vsgraphs.simulate.options import Output
from vsgraphs.simulate.png import write_grey_png
from vsgraphs.simulate.stream import TIMESTAMP_OFFSET_S, Shot


@dataclass(frozen=True)
class Record:
    """A frame on disk, and where the camera truly was at the moment it stands for."""

    shot: Shot
    has_labels: bool
    position: tuple[float, float, float]
    quaternion: tuple[float, float, float, float]


class SequenceWriter:
    """Renders and writes frames, from any thread, into one folder."""

    def __init__(self, scene: Any, camera: SimulatedCamera, folder: Path, options: Output) -> None:
        self._scene, self._camera, self._noise = scene, camera.camera, camera.noise
        self._chosen = camera.chosen
        self._folder, self._options = folder, options
        self._seen = core().ObservationCounter(scene)
        self._lock = threading.Lock()
        self._local = threading.local()
        for name in ("rgb", "depth", *(("label", "instance") if options.labels_every else ())):
            (folder / name).mkdir()

    def frame(self, shot: Shot, number: int) -> Record:
        """Renders a frame and writes it as the `number`-th of the sequence."""
        if not hasattr(self._local, "renderer"):
            self._local.renderer = core().Renderer(self._scene, self._camera, self._noise)
        frame = self._local.renderer.render(shot.source)
        rgb = Image.fromarray(frame.rgb)
        if self._options.image_format == "jpg":
            rgb.save(self._folder / "rgb" / f"{shot.rgb_stamp}.jpg", quality=self._options.jpeg_quality)
        else:
            rgb.save(self._folder / "rgb" / f"{shot.rgb_stamp}.png", compress_level=1)
        write_grey_png(frame.depth, self._folder / "depth" / f"{shot.depth_stamp}.png")
        has_labels = self._options.labels_every > 0 and number % self._options.labels_every == 0
        if has_labels:
            write_grey_png(frame.label, self._folder / "label" / f"{shot.rgb_stamp}.png")
            write_grey_png(frame.instance, self._folder / "instance" / f"{shot.rgb_stamp}.png")
        pose, q = frame.world_from_camera, frame.quaternion_xyzw
        if shot.source != shot.index:
            pose, q = self._local.renderer.pose(shot.index)
        x, y, z = (float(v) for v in pose[:3, 3])
        record = Record(shot, has_labels, (x, y, z), (q[0], q[1], q[2], q[3]))
        with self._lock:
            self._seen.add(frame)
        return record

    def write_lists(self, records: list[Record], loaded: LoadedPlan) -> float:
        """Writes everything but the images; returns the path's length, m."""
        folder, kind = self._folder, self._options.image_format
        stamps = [(record.shot.rgb_stamp, record.shot.depth_stamp) for record in records]
        _lines(folder / "rgb.txt", (f"{s} rgb/{s}.{kind}" for s, _ in stamps))
        _lines(folder / "depth.txt", (f"{d} depth/{d}.png" for _, d in stamps))
        _lines(folder / "associations.txt", (f"{s} rgb/{s}.{kind} {d} depth/{d}.png" for s, d in stamps))
        _lines(
            folder / "groundtruth.txt",
            [
                "# timestamp tx ty tz qx qy qz qw  (world_from_camera, optical axes)",
                *map(_pose_line, records),
            ],
        )
        if self._options.labels_every:
            labelled = [r.shot.rgb_stamp for r in records if r.has_labels]
            _lines(
                folder / "labels.txt",
                ["# timestamp class(8 bit) instance(16 bit)"]
                + [f"{s} label/{s}.png instance/{s}.png" for s in labelled],
            )
        _lines(folder / "camera.yaml", self._camera_lines(loaded))
        if self._options.motion:
            until = (records[-1].shot.index + 0.5) / loaded.plan.fps
            write_motion(self._scene, folder, until, self._noise.seed)
        truth, length = self._truth(records, loaded)
        (folder / MARK).write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")
        return length

    def _camera_lines(self, loaded: LoadedPlan) -> list[str]:
        camera, fps = self._camera, loaded.plan.fps / self._options.every
        lines = ["# pinhole, no distortion, pixel centres at integers"]
        if self._noise.lens != "none":
            lines = ["# pixel centres at integers", *_lens_lines(self._noise)]
        lines += [f"{key}: {getattr(camera, key)}" for key in ("width", "height", "fx", "fy", "cx", "cy")]
        lines += [f"fps: {fps}", f"depth_scale: {camera.depth_scale}"]
        near, far = (
            (self._noise.depth_min_m, self._noise.depth_max_m) if self._noise.depth_holes else (0.1, 13.0)
        )
        lines += [f"depth_min: {near}", f"depth_max: {far}"]
        if self._noise.depth_quantisation:
            baseline = self._noise.baseline_m
            lines += [f"baseline_for_bf: {baseline}", f"bf: {baseline * camera.fx:g}"]
        return [*lines, f"source: vsgraphs simulator, plan {loaded.plan.name}"]

    def _truth(self, records: list[Record], loaded: LoadedPlan) -> tuple[dict[str, Any], float]:
        plan = loaded.plan
        found = core().scene_truth(self._scene, self._seen)
        positions = np.array([record.position for record in records])
        length = float(np.linalg.norm(np.diff(positions, axis=0), axis=1).sum())
        fps = plan.fps / self._options.every
        truth = {
            "plan": plan.name,
            "seed": plan.seed,
            "description": plan.description,
            "convention": "world z up, metres; plane n.x + d = 0, n points into the room; "
            "poses T_world_cam, optical frame (x right, y down, z forward)",
            **found,
            "path_length_m": round(length, 3),
            "duration_s": round(self._scene.duration_s, 3),
            "fps_default": plan.fps,
            "noise_seed": self._noise.seed,
            **self._chosen,
            "summary": {
                "frames": len(records),
                "fps": fps,
                "duration_s": round(
                    float(records[-1].shot.truth_stamp) - float(records[0].shot.truth_stamp), 3
                ),
                "path_length_m": round(length, 3),
                "walls_observed": sum(wall["observed"] for wall in found["walls"]),
                "rooms_visited": sum(room["visited"] for room in found["rooms"]),
            },
            "timestamp_offset": TIMESTAMP_OFFSET_S,
        }
        return truth, length


def _lens_lines(noise: Any) -> list[str]:
    if noise.lens == "radial_tangential":
        return [f"distortion: [{', '.join(map(str, (*noise.lens_k, 0.0, 0.0, 0.0, 0.0, 0.0)[:5]))}]"]
    return [f"model: {noise.lens}", f"model_coefficients: [{', '.join(map(str, noise.lens_k))}]"]


def _pose_line(record: Record) -> str:
    numbers = " ".join(f"{v:.7f}" for v in (*record.position, *record.quaternion))
    return f"{record.shot.truth_stamp} {numbers}"


def _lines(path: Path, lines: Any) -> None:
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
