"""Writes small sequences in the published layouts of the datasets.

The scene is a textured wall the camera slides along. The wall is parallel to the image plane at DISTANCE_M;
the camera moves along x by whole pixels, so images are crops of one texture and the truth is exact.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from PIL import Image

DISTANCE_M = 2.0


@dataclass
class Scene:
    """Images and poses of the sliding camera."""

    frames: int = 8
    width: int = 64
    height: int = 48
    focal_px: float = 60.0
    depth_scale: float = 5000.0
    fps: float = 10.0
    shifts_px: list[int] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.shifts_px = self.shifts_px or list(range(self.frames))
        self.texture = texture(self.height, self.width + max(self.shifts_px), seed=7)

    def stamp(self, index: int) -> float:
        return 100.0 + index / self.fps

    def rgb(self, index: int) -> np.ndarray:
        shift = self.shifts_px[index]
        return self.texture[:, shift : shift + self.width]

    def depth(self, index: int) -> np.ndarray:
        return np.full((self.height, self.width), round(DISTANCE_M * self.depth_scale), np.uint16)

    def pose(self, index: int) -> np.ndarray:
        pose = np.eye(4)
        pose[0, 3] = self.shifts_px[index] * DISTANCE_M / self.focal_px
        return pose

    def camera_yaml(self) -> str:
        return (
            f"width: {self.width}\nheight: {self.height}\nfx: {self.focal_px}\nfy: {self.focal_px}\n"
            f"cx: {(self.width - 1) / 2}\ncy: {(self.height - 1) / 2}\nfps: {self.fps}\n"
            f"depth_scale: {self.depth_scale}\n"
        )


def sliding_scene(shifts_px: list[int]) -> Scene:
    """Large enough to be tracked."""
    return Scene(frames=len(shifts_px), width=320, height=240, focal_px=300.0, shifts_px=shifts_px)


def texture(height: int, width: int, seed: int) -> np.ndarray:
    """(height, width, 3) uint8: random rectangles, many corners."""
    rng = np.random.default_rng(seed)
    image = np.full((height, width, 3), 128, np.uint8)
    for _ in range(height * width // 120):
        y, x = rng.integers(0, height), rng.integers(0, width)
        h, w = rng.integers(4, 16, 2)
        image[y : y + h, x : x + w] = rng.integers(0, 256, 3)
    return image


def save(image: np.ndarray, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(image).save(path, **({"quality": 95} if path.suffix == ".jpg" else {}))


def tum_line(stamp: float, pose: np.ndarray) -> str:
    return f"{stamp:.6f} {pose[0, 3]:.7f} {pose[1, 3]:.7f} {pose[2, 3]:.7f} 0 0 0 1\n"


def write_tum(folder: Path, scene: Scene | None = None, *, associations: bool = False) -> Path:
    """TUM RGB-D; depth is 4 ms after colour, as on a real Kinect they are never at once."""
    scene = scene or Scene()
    rgb_list, depth_list, pairs, truth = ["# colour\n"], ["# depth\n"], [], ["# truth\n"]
    for index in range(scene.frames):
        stamp, depth_stamp = scene.stamp(index), scene.stamp(index) + 0.004
        rgb_name, depth_name = f"rgb/{stamp:.6f}.png", f"depth/{depth_stamp:.6f}.png"
        save(scene.rgb(index), folder / rgb_name)
        save(scene.depth(index), folder / depth_name)
        rgb_list.append(f"{stamp:.6f} {rgb_name}\n")
        depth_list.append(f"{depth_stamp:.6f} {depth_name}\n")
        pairs.append(f"{stamp:.6f} {rgb_name} {depth_stamp:.6f} {depth_name}\n")
        truth.append(tum_line(stamp, scene.pose(index)))
    (folder / "groundtruth.txt").write_text("".join(truth))
    (folder / "camera.yaml").write_text(scene.camera_yaml())
    if associations:
        (folder / "associations.txt").write_text("".join(pairs))
    else:
        (folder / "rgb.txt").write_text("".join(rgb_list))
        (folder / "depth.txt").write_text("".join(depth_list))
    return folder


def write_icl(folder: Path, frames: int = 4) -> Path:
    """ICL-NUIM's TUM-compatible release: frame numbers for timestamps, depth first, y up in the truth."""
    scene = Scene(frames=frames, width=640, height=480, focal_px=480.0)
    pairs, truth = [], []
    for index in range(frames):
        save(scene.rgb(index), folder / f"rgb/{index}.png")
        save(scene.depth(index), folder / f"depth/{index}.png")
        pairs.append(f"{index} depth/{index}.png {index} rgb/{index}.png\n")
        truth.append(f"{index} {index * 0.01} {index * 0.02} 1.5 {np.sin(0.1)} 0 0 {np.cos(0.1)}\n")
    (folder / "associations.txt").write_text("".join(pairs))
    (folder / "livingRoom2.gt.freiburg").write_text("".join(truth))
    return folder


def write_seven_scenes(folder: Path, frames: int = 3) -> Path:
    """7-Scenes raw: frame-XXXXXX.{color,depth}.png and pose.txt; one true pose was lost."""
    scene = Scene(frames=frames, width=640, height=480, focal_px=585.0, depth_scale=1000.0)
    for index in range(frames):
        stem = folder / f"frame-{index:06d}"
        save(scene.rgb(index), Path(f"{stem}.color.png"))
        save(scene.depth(index), Path(f"{stem}.depth.png"))
        pose = scene.pose(index)
        if index == 1:
            pose[:] = -np.inf
        rows = "\n".join("\t ".join(f"{value: .7e}" for value in row) + "\t " for row in pose)
        Path(f"{stem}.pose.txt").write_text(rows + "\n")
    return folder


def write_replica(folder: Path, frames: int = 3, *, params: bool = True) -> Path:
    """Replica as rendered for NICE-SLAM: results/, traj.txt, cam_params.json one folder up."""
    scene = Scene(frames=frames, width=120, height=68, focal_px=60.0, depth_scale=6553.5)
    for index in range(frames):
        save(scene.rgb(index), folder / f"results/frame{index:06d}.jpg")
        save(scene.depth(index), folder / f"results/depth{index:06d}.png")
    rows = [" ".join(f"{value:.18e}" for value in scene.pose(index).ravel()) for index in range(frames)]
    (folder / "traj.txt").write_text("\n".join(rows) + "\n")
    if params:
        camera = {"w": 120, "h": 68, "fx": 60.0, "fy": 60.0, "cx": 59.5, "cy": 33.5, "scale": 6553.5}
        (folder.parent / "cam_params.json").write_text(json.dumps({"camera": camera}))
    return folder
