"""Published intrinsics of well-known datasets, by name: for sequences that carry no camera.yaml.

TUM: https://cvg.cit.tum.de/data/datasets/rgbd-dataset/file_formats (calibration of the colour camera; the
depth correction factors given there are already applied in the released images; freiburg3 is already
undistorted). ICL-NUIM: https://www.doc.ic.ac.uk/~ahanda/VaFRIC/codes.html (fy is published as -480, see
icl_nuim.py). 7-Scenes: Microsoft Research's page (depth camera). Replica: the renderings published with
NICE-SLAM. Redwood: the PrimeSense camera its page names (also Open3D's PrimeSenseDefault).
"""

from __future__ import annotations

import os
from collections.abc import Callable
from difflib import get_close_matches
from pathlib import Path

from vsgraphs.datasets.calibration import Calibration
from vsgraphs.datasets.camera_file import read_camera_file
from vsgraphs.errors import InputError

CAMERAS: dict[str, Calibration] = {
    "tum-fr1": Calibration(
        640,
        480,
        517.3,
        516.5,
        318.6,
        255.3,
        (0.2624, -0.9531, -0.0054, 0.0026, 1.1633),
        origin="tum-fr1 (built in)",
    ),
    "tum-fr2": Calibration(
        640,
        480,
        520.9,
        521.0,
        325.1,
        249.7,
        (0.2312, -0.7849, -0.0033, -0.0001, 0.9172),
        origin="tum-fr2 (built in)",
    ),
    "tum-fr3": Calibration(640, 480, 535.4, 539.2, 320.1, 247.6, origin="tum-fr3 (built in)"),
    "icl-nuim": Calibration(640, 480, 481.20, 480.00, 319.50, 239.50, origin="icl-nuim (built in)"),
    "7-scenes": Calibration(
        640, 480, 585.0, 585.0, 320.0, 240.0, depth_scale=1000.0, origin="7-scenes (built in)"
    ),
    "replica": Calibration(
        1200,
        680,
        600.0,
        600.0,
        599.5,
        339.5,
        depth_scale=6553.5,
        depth_noise=None,
        origin="replica (built in)",
    ),
    "redwood": Calibration(
        640, 480, 525.0, 525.0, 319.5, 239.5, depth_scale=1000.0, origin="redwood (built in)"
    ),
}

# What folder names of the published archives contain -> camera.
_FOLDER_HINTS = {
    "freiburg1": "tum-fr1",
    "freiburg2": "tum-fr2",
    "freiburg3": "tum-fr3",
    "fr1": "tum-fr1",
    "fr2": "tum-fr2",
    "fr3": "tum-fr3",
    "living_room_traj": "icl-nuim",
    "office_room_traj": "icl-nuim",
    "icl": "icl-nuim",
}


def named_camera(name: str) -> Calibration | None:
    """The camera called `name` (case and -_ do not matter), or None."""
    wanted = name.lower().replace("_", "-")
    return (
        CAMERAS.get(wanted)
        or CAMERAS.get(f"tum-{wanted}")
        or CAMERAS.get({"icl": "icl-nuim"}.get(wanted, ""))
    )


def camera_from_folder_name(folder: Path) -> Calibration | None:
    """The known camera a folder's name points to (rgbd_dataset_freiburg1_xyz: tum-fr1), or None."""
    words = folder.resolve().name.lower().replace("-", "_")
    for hint, camera in _FOLDER_HINTS.items():
        if hint in words if len(hint) > 3 else hint in words.split("_"):
            return CAMERAS[camera]
    return None


def choose_camera(
    folder: Path,
    given: str | Path | Calibration | None,
    default: Calibration | Callable[[], Calibration] | None,
    *,
    y_up: bool = False,
) -> tuple[Calibration, list[str]]:
    """The camera of a sequence, and remarks worth telling.

    What the user gave (file or name), else camera.yaml in the folder, else `default`, else what the folder's
    name points to. A `default` that is a function is called only where it is needed, and raises what is wrong
    then. Raises InputError when none of these is there. y_up: see `read_camera_file`.
    """
    if isinstance(given, Calibration):
        return given, []
    if given is not None:
        return _given_camera(str(given), y_up=y_up)
    for name in ("camera.yaml", "camera.yml"):
        if os.path.lexists(folder / name):  # what is there and cannot be read is told
            return read_camera_file(folder / name, y_up=y_up)
    known = (default() if callable(default) else default) or camera_from_folder_name(folder)
    if known is None:
        raise InputError(
            f"no camera for {folder}: no camera.yaml there and its name is not a known dataset's; "
            f"give --camera FILE or one of {', '.join(sorted(CAMERAS))}"
        )
    return known, []


def _given_camera(given: str, *, y_up: bool) -> tuple[Calibration, list[str]]:
    if Path(given).is_file():
        return read_camera_file(Path(given), y_up=y_up)
    known = named_camera(given)
    if known is not None:
        return known, []
    if Path(given).exists():
        return read_camera_file(Path(given), y_up=y_up)  # says why not
    near = get_close_matches(given.lower(), CAMERAS, n=1, cutoff=0.5)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    raise InputError(f"camera '{given}' is neither a file nor one of {', '.join(sorted(CAMERAS))}{hint}")
