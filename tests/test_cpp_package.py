"""The C++ package as another project uses it: installed, found, linked, run on a folder."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

import vsgraphs
from vsgraphs.compiled import core
from vsgraphs.simulate import Output, simulate

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "release"


def run(*command: object) -> str:
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="session")
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Path:
    if not (BUILD / "core" / "libvsgraphs_system.a").exists():
        pytest.skip("build/release holds no libraries; `make build` makes them")
    prefix = tmp_path_factory.mktemp("prefix")
    run("cmake", "--install", BUILD, "--component", "development", "--prefix", prefix)
    return prefix


@pytest.fixture(scope="session")
def example(prefix: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    build = tmp_path_factory.mktemp("example")
    configured = ["-S", ROOT / "examples" / "cpp", "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}"]
    run("cmake", *configured, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release")
    run("cmake", "--build", build)
    return build / "track_folder"


@pytest.fixture(scope="session")
def room(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("simulated") / "one_room"
    simulate("one_room", folder, output=Output(every=6, image_format="png", labels_every=0))
    return folder


def test_the_example_tracks_as_the_python_package_does(example: Path, room: Path) -> None:
    sequence = vsgraphs.open_sequence(room)
    config = vsgraphs.Config()
    config.set("system.execution", "serial")
    slam = vsgraphs.Slam(config, sequence.camera)
    for frame in sequence.frames:
        slam.track(*frame.load(), frame.timestamp)
    slam.finish()
    _, poses = slam.trajectory()

    version, tracked, end, rooms, first, *_ = run(example, room).splitlines()
    info = core().build_info()
    assert version == f"vsgraphs {info['core']} for {info['processor_level']}"
    assert tracked == f"{len(poses)} of {len(sequence.frames)} frames tracked"
    position = np.array(end.removeprefix("the path ends at ").split(), float)
    np.testing.assert_allclose(position, poses[-1, :3, 3], atol=1e-6)
    assert rooms == "1 rooms"
    area = re.fullmatch(r"room \d+: ([\d.]+) m2, 4 walls, 0 neighbours", first)
    assert area, first
    assert 10 < float(area[1]) < 40


def test_mistakes_get_a_line(example: Path, tmp_path: Path) -> None:
    done = subprocess.run([example, tmp_path], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (2, f"error: cannot read {tmp_path}/camera.yaml\n")


def test_what_is_installed(prefix: Path) -> None:
    headers = [path.name for path in prefix.rglob("*.h")]
    assert "slam.h" in headers
    assert not [name for name in headers if "test" in name]
    for file in prefix.rglob("*.cmake"):
        assert str(ROOT) not in file.read_text(), file  # may be moved to another machine
    assert {"LICENSE", "NOTICE"} <= {path.name for path in prefix.rglob("*")}


MAJOR, MINOR, *_ = (int(number) for number in vsgraphs.__version__.split("."))


@pytest.mark.parametrize(
    ("asked", "found"),
    [
        (f"{MAJOR}.{MINOR}", True),
        (f"{vsgraphs.__version__} EXACT", True),
        (f"{MAJOR}.{MINOR + 1}", False),
        (f"{MAJOR + 1}", False),
    ],
)
def test_the_version_is_checked(prefix: Path, tmp_path: Path, asked: str, found: bool) -> None:
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(asks LANGUAGES CXX)\n"
        f"find_package(vsgraphs {asked} QUIET)\n"
        'message(STATUS "found=${vsgraphs_FOUND} ${vsgraphs_VERSION}")\n'
    )
    said = run("cmake", "-S", tmp_path, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
    assert f"found={'1' if found else '0'} {vsgraphs.__version__ if found else ''}".strip() in said
