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


def _rows(matrix: np.ndarray) -> str:
    return "\n".join(" ".join(f"{value:f}" for value in row) for row in matrix) + "\n"


def write_scannet(folder: Path, frames: int = 4, *, colour_scale: int = 2) -> Path:
    """ScanNet as SensReader exports it: colour twice as large, with its own camera; pose 2 was lost."""
    scene = Scene(frames=frames, depth_scale=1000.0)
    for index in range(frames):
        large = np.repeat(np.repeat(scene.rgb(index), colour_scale, axis=0), colour_scale, axis=1)
        save(large, folder / f"color/{index}.jpg")
        save(scene.depth(index), folder / f"depth/{index}.png")
        pose = np.full((4, 4), -np.inf) if index == 2 else scene.pose(index)
        (folder / "pose").mkdir(exist_ok=True)
        (folder / f"pose/{index}.txt").write_text(_rows(pose))
    (folder / "intrinsic").mkdir()
    for name, scale in (("depth", 1), ("color", colour_scale)):
        camera = np.eye(4)
        camera[0, 0] = camera[1, 1] = scene.focal_px * scale
        camera[:2, 2] = (scene.width * scale - 1) / 2, (scene.height * scale - 1) / 2
        (folder / f"intrinsic/intrinsic_{name}.txt").write_text(_rows(camera))
        (folder / f"intrinsic/extrinsic_{name}.txt").write_text(_rows(np.eye(4)))
    return folder


# How the camera sits on OpenLORIS-Scene's robot in the fixture: through a frame between, as in the packages.
BASE_FROM_MOUNT = np.array([[0.0, -1, 0, 0.2], [1, 0, 0, 0], [0, 0, 1, 0.9], [0, 0, 0, 1]])
MOUNT_FROM_CAMERA = np.array([[0.0, 0, 1, 0], [-1, 0, 0, 0.1], [0, -1, 0, 0], [0, 0, 0, 1]])

_LORIS_SENSORS = """%YAML:1.0
---
d400_color_optical_frame:
   sensor_type: camera
   sensor_name: d400_color_optical_frame
   fps: 30
   width: {width}
   height: {height}
   model: pinhole
   intrinsics: !!opencv-matrix
      rows: 1
      cols: 4
      dt: d
      data: [ {focal}e+00, {cx}e+00,
          {focal}e+00, {cy}e+00 ]
   distortion_model: "radial-tangential"
   distortion_coefficients: !!opencv-matrix
      rows: 1
      cols: 5
      dt: d
      data: [ 0., 0., 0., 0., 0. ]
odometer:
   sensor_type: odometer
   sensor_name: odometer
   fps: 0
"""


def opencv_transform(parent: str, child: str, matrix: np.ndarray) -> str:
    data = ", ".join(f"{value:.16e}" for value in matrix.ravel())
    return (
        f"   -\n      parent_frame: {parent}\n      child_frame: {child}\n      matrix: !!opencv-matrix\n"
        f"         rows: 4\n         cols: 4\n         dt: d\n         data: [ {data} ]\n"
    )


def write_openloris(folder: Path, frames: int = 4) -> Path:
    """An OpenLORIS-Scene package: aligned depth some microseconds off colour, truth of the robot's base."""
    scene = Scene(frames=frames, depth_scale=1000.0)
    base_from_camera = BASE_FROM_MOUNT @ MOUNT_FROM_CAMERA
    lists: dict[str, list[str]] = {"color": [], "aligned_depth": [], "depth": []}
    truth = ["#Time px py pz qx qy qz qw\n"]
    for index in range(frames):
        stamp = 1560004885.446172 + index / 30
        for name, late in (("color", 0.0), ("aligned_depth", -7e-6), ("depth", 0.004)):
            file = f"{name}/{stamp + late:.6f}.png"
            save(scene.rgb(index) if name == "color" else scene.depth(index), folder / file)
            lists[name].append(f"{stamp + late:.6f} {file}\n")
        base = scene.pose(index) @ np.linalg.inv(base_from_camera)
        w = 0.5 * np.sqrt(1 + np.trace(base[:3, :3]))
        x, y, z = (base[2, 1] - base[1, 2], base[0, 2] - base[2, 0], base[1, 0] - base[0, 1])
        quaternion = np.array([x, y, z, 4 * w * w]) / (4 * w)
        numbers = " ".join(f"{value:.9f}" for value in [*base[:3, 3], *quaternion])
        truth.append(f"{stamp:.6f} {numbers}\n")
    for name, lines in lists.items():
        (folder / f"{name}.txt").write_text("#Time file\n" + "".join(lines))
    (folder / "groundtruth.txt").write_text("".join(truth))
    (folder / "sensors.yaml").write_text(
        _LORIS_SENSORS.format(
            width=scene.width,
            height=scene.height,
            focal=scene.focal_px,
            cx=(scene.width - 1) / 2,
            cy=(scene.height - 1) / 2,
        )
    )
    (folder / "trans_matrix.yaml").write_text(
        "%YAML:1.0\n---\ntrans_matrix:\n"
        + opencv_transform("base_link", "mount", BASE_FROM_MOUNT)
        + opencv_transform("mount", "d400_color_optical_frame", MOUNT_FROM_CAMERA)
    )
    return folder


def write_redwood(folder: Path, frames: int = 4, *, colour: str = "color", camera: bool = True) -> Path:
    """Redwood's indoor layout with Open3D's camera file; without one, images of the PrimeSense's size."""
    small = Scene(frames=frames, depth_scale=1000.0)
    scene = small if camera else Scene(frames, 640, 480, 525.0, 1000.0)
    blocks = []
    for index in range(frames):
        save(scene.rgb(index), folder / f"{colour}/{index:05d}.jpg")
        save(scene.depth(index), folder / f"depth/{index:05d}.png")
        blocks.append(f"{index} {index} {index + 1}\n" + _rows(scene.pose(index)))
    (folder / "trajectory.log").write_text("".join(blocks))
    if camera:
        focal, cx, cy = scene.focal_px, (scene.width - 1) / 2, (scene.height - 1) / 2
        matrix = [focal, 0, 0, 0, focal, 0, cx, cy, 1]
        values = {"width": scene.width, "height": scene.height, "intrinsic_matrix": matrix}
        (folder / "camera_intrinsic.json").write_text(json.dumps(values))
    return folder
