#!/usr/bin/env python3
"""Pictures of everything the simulator can show, colour beside depth: docs/images/simulator_*.jpg.

    benchmarks/simulator_pictures.py docs/images
    benchmarks/simulator_pictures.py out --beside recorded/kitchen recorded/fr1_xyz

--beside adds frames of recorded sequences to the picture of the sensors (not for publication where their
licences forbid it). Depth: red near, blue far (6 m), black none.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw

from vsgraphs.compiled import core
from vsgraphs.datasets import open_sequence
from vsgraphs.plans import drawn, load_plan
from vsgraphs.simulate.camera import simulated_camera

Pixels = npt.NDArray[np.uint8]
SIZE = (400, 300)  # of one image in a picture
FAR_M = 6.0
SENSORS = ("clean", "classic", "kinect1", "kinect2", "d435", "iphone_lidar")
# Kind, seed and the class of which as much as possible is to be seen.
PLACES = (
    ("flat", 1, "mirror"), ("flat", 1, "person"), ("flat", 2, "glass"), ("flat", 3, "floor"),
    ("flat", 2, "ceiling"),
    ("flat", 4, "cabinet"), ("office", 1, "glass"), ("office", 2, "person"), ("office", 3, "pillar"),
    ("desk", 1, "misc"), ("kitchen", 1, "misc"),
)  # fmt: skip
EFFECTS: tuple[tuple[str, dict[str, Any]], ...] = (
    ("no effects", {}),
    ("fov_deg=110", {"fov_deg": 110}),
    ("kannala_brandt", {"lens": "kannala_brandt", "lens_k": [0.02, -0.01], "fov_deg": 80}),
    ("radial_tangential", {"lens": "radial_tangential", "lens_k": [-0.3, 0.1], "fov_deg": 80}),
    ("roll_deg=90", {"roll_deg": 90}),
    ("rolling_shutter_s=0.15", {"rolling_shutter_s": 0.15}),
    ("exposure_time_s=0.06", {"motion_blur": True, "exposure_time_s": 0.06}),
    ("misregistration_u_px=25", {"misregistration_u_px": 25}),
)


def coloured(depth_m: npt.NDArray[Any]) -> Pixels:
    """Red near, blue far, black where there is none."""
    share = np.clip(depth_m / FAR_M, 0, 1)
    image = np.stack([1 - share, 1 - np.abs(2 * share - 1), share], axis=-1) * 255
    image[depth_m <= 0] = 0
    return image.astype(np.uint8)


def pair(name: str, rgb: npt.NDArray[Any], depth_m: npt.NDArray[Any]) -> Pixels:
    """Colour and depth side by side, with their name."""
    halves = [Image.fromarray(np.ascontiguousarray(a)).resize(SIZE) for a in (rgb, coloured(depth_m))]
    ImageDraw.Draw(halves[0]).text((5, 4), name, fill=(255, 255, 255), stroke_width=2, stroke_fill=(0, 0, 0))
    return np.concatenate([np.asarray(half) for half in halves], axis=1)


def view(
    name: str, plan: dict[str, Any] | str, time_s: float, sensor: str, effects: dict[str, Any]
) -> Pixels:
    """One moment of a walk."""
    loaded = load_plan(plan)
    camera = simulated_camera(loaded, sensor=sensor, effects=effects)
    scene = core().build_scene(loaded.plan)
    index = min(int(time_s * loaded.plan.fps), scene.frame_count - 1)
    frame = core().Renderer(scene, camera.camera, camera.noise).render(index)
    return pair(name, frame.rgb, frame.depth / camera.camera.depth_scale)


def best_moment(plan: dict[str, Any], wanted: str) -> float:
    """Seconds into the walk when most of a class is in view, looked for once a second."""
    small = {"width": 96, "height": 72, "fx": 79.0, "fy": 79.0, "cx": 47.5, "cy": 35.5}
    loaded = load_plan({**plan, "camera": small})
    camera = simulated_camera(loaded, sensor="clean")
    scene = core().build_scene(loaded.plan)
    renderer, value = core().Renderer(scene, camera.camera, camera.noise), core().scene_classes()[wanted]
    step = round(loaded.plan.fps)
    shares = [(renderer.render(i).label == value).mean() for i in range(0, scene.frame_count, step)]
    return float(np.argmax(shares))


def recorded(folder: Path) -> Pixels:
    """A frame from the middle of a recording."""
    sequence = open_sequence(folder)
    rgb, depth = sequence.frames[len(sequence.frames) // 2].load()
    return pair(folder.name, rgb, depth / sequence.camera.depth_scale)


def write(path: Path, cells: list[Pixels]) -> None:
    """Two columns."""
    cells = cells + [np.zeros_like(cells[0])] * (len(cells) % 2)
    rows = [np.concatenate(cells[i : i + 2], axis=1) for i in range(0, len(cells), 2)]
    Image.fromarray(np.concatenate(rows)).save(path, quality=82)
    print(path)


def main() -> None:
    """Makes all pictures."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("out", type=Path)
    parser.add_argument("--beside", nargs="*", type=Path, default=[], metavar="FOLDER")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    sensors = [view(name, drawn("flat", 4), 33, name, {}) for name in SENSORS]
    write(options.out / "simulator_sensors.jpg", sensors + [recorded(folder) for folder in options.beside])
    write(options.out / "simulator_effects.jpg", [view(n, "demo", 5.2, "clean", e) for n, e in EFFECTS])
    places = []
    for kind, seed, wanted in PLACES:
        plan = drawn(kind, seed)
        places.append(view(f"{kind} {seed}: {wanted}", plan, best_moment(plan, wanted), "kinect1", {}))
    robot = drawn("flat", 2, carrier="robot")
    write(options.out / "simulator_rooms.jpg", [*places, view("robot", robot, 12, "d435", {})])


if __name__ == "__main__":
    main()
