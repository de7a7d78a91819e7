"""What other packages add, and callbacks: found, used, and never in the way of others."""

from __future__ import annotations

import json
import os
import sys
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

import fake_core
import numpy as np
import pytest
from conftest import Program, one_line_error, report

import vsgraphs
from vsgraphs.errors import InputError
from vsgraphs.plugins import plugin, plugins
from vsgraphs.run.events import Events
from vsgraphs.sources import open_source

PLUGIN = Path(__file__).resolve().parent.parent / "examples" / "plugin"


def install(folder: Path, name: str, groups: dict[str, dict[str, str]]) -> None:
    """What an installed distribution leaves, without its code."""
    info = folder / f"{name.replace('-', '_')}-0.1.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 0.1\n")
    lines = [
        f"[{group}]\n" + "".join(f"{k} = {v}\n" for k, v in names.items()) for group, names in groups.items()
    ]
    (info / "entry_points.txt").write_text("\n".join(lines))


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder that packages can be put in; for programs too."""
    folder = tmp_path / "site"
    folder.mkdir()
    paths = [str(folder), str(PLUGIN)]
    for path in reversed(paths):
        monkeypatch.syspath_prepend(path)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([*paths, os.environ.get("PYTHONPATH", "")]))
    yield folder
    sys.modules.pop("vsgraphs_example", None)


@pytest.fixture
def example(site: Path) -> Path:
    """The example package, installed as its pyproject.toml says."""
    project = tomllib.loads((PLUGIN / "pyproject.toml").read_text())["project"]
    install(site, project["name"], project["entry-points"])
    return site


@pytest.fixture
def broken(site: Path) -> Path:
    """A package that cannot be imported, or raises."""
    groups = ("sources", "segmenters", "exporters", "checks")
    names = {
        "gone": "no_such_module:f",
        "raising": "raising_module:raises",
        "no-function": "raising_module:number",
    }
    install(site, "broken-one", {f"vsgraphs.{group}": names for group in groups})
    (site / "raising_module.py").write_text("number = 3\ndef raises(*_):\n    raise KeyError('mine')\n")
    return site


def as_npz(recorded: Path, folder: Path, count: int = 20) -> Path:
    sequence = vsgraphs.open_sequence(recorded)
    folder.mkdir()
    for frame in sequence.frames[:count]:
        rgb, depth = frame.load()
        np.savez(folder / f"{frame.timestamp:.6f}.npz", rgb=rgb, depth=depth)
    (folder / "camera.json").write_text(json.dumps(asdict(sequence.calibration)))
    return folder


def test_all_kinds_are_found_by_name(example: Path) -> None:
    found = {kind: list(plugins(kind)) for kind in ("source", "segmenter", "exporter", "check")}
    assert found == {
        "source": ["npz"],
        "segmenter": ["level"],
        "exporter": ["rooms-csv"],
        "check": ["still-camera"],
    }
    with pytest.raises(InputError, match="no exporter 'rooms-cvs'; did you mean 'rooms-csv'"):
        plugin("exporter", "rooms-cvs")


def test_a_run_with_all_of_the_example_s(
    example: Path, recorded: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    out = tmp_path / "out"
    source = f"npz:{as_npz(recorded, tmp_path / 'mine')}"
    done = vsgraphs("run", source, "--out", out, "--export", "rooms-csv", "--segmenter", "level:0.9")
    assert done.returncode == 0, done.stderr
    run = report(out)
    assert (run["frames"], run["tracked"]) == (20, 20)
    assert run["source"]["format"] == "npz"
    assert run["segmentation"]["backend"] == "level:0.9"
    assert run["segmentation"]["segmented"] >= 1
    assert run["exported"] == ["rooms.csv"]
    assert (out / "rooms.csv").read_text().startswith("id,name,area_m2\n")
    (line,) = run["checks"]["still-camera"]
    assert "the camera moved 0." in line
    assert f"still-camera: {line}" in run["warnings"]
    assert f"warning: still-camera: {line}" in done.stdout
    assert "rooms.csv" in done.stdout.splitlines()[-1]


def test_the_same_frames_give_the_same_bytes_as_a_folder(
    example: Path, recorded: Path, tmp_path: Path
) -> None:
    vsgraphs.run(f"npz:{as_npz(recorded, tmp_path / 'mine')}", tmp_path / "a", execution="serial", checks=())
    vsgraphs.run(recorded, tmp_path / "b", execution="serial", max_frames=20, checks=())
    for name in ("trajectory.txt", "map.ply", "scene_graph.json"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_exporting_a_finished_run(example: Path, recorded: Path, tmp_path: Path, vsgraphs: Program) -> None:
    assert vsgraphs("run", recorded, "--out", tmp_path / "out", "--max-frames", 12).returncode == 0
    before = (tmp_path / "out" / "run.json").read_bytes()
    done = vsgraphs("export", tmp_path / "out", "rooms-csv", "planes", "--out", tmp_path / "more")
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in (tmp_path / "more").iterdir()) == ["planes.ply", "rooms.csv"]
    assert (tmp_path / "out" / "run.json").read_bytes() == before
    assert "no exporter 'rooms'" in one_line_error(vsgraphs("export", tmp_path / "out", "rooms"))
    assert "run.json" in one_line_error(vsgraphs("export", tmp_path, "planes"))


def test_a_broken_plug_in_is_named_with_its_cure_and_others_work(
    example: Path, broken: Path, recorded: Path, tmp_path: Path, fake: fake_core.Slam
) -> None:
    said: list[str] = []
    result = vsgraphs.run(recorded, tmp_path / "out", on_message=lambda line: said.append(str(line)))
    lines = [line for line in said if "broken-one" in line]
    assert len(lines) == 3
    assert all(line.startswith("warning: check ") for line in lines)
    assert lines[0].endswith("update the package broken-one, or remove it with `pip uninstall broken-one`")
    assert "check gone cannot be loaded: ModuleNotFoundError: No module named 'no_such_module'" in lines[0]
    assert "check no-function cannot be loaded: TypeError: raising_module:number is no function" in lines[1]
    assert "check raising failed: KeyError: 'mine'" in lines[2]
    assert all(line.removeprefix("warning: ") in result.warnings for line in lines)
    assert "still-camera" in result.info["checks"]


@pytest.mark.parametrize("name", ["gone", "raising", "no-function"])
def test_a_broken_one_that_is_asked_for_is_a_mistake_of_one_line(
    broken: Path, recorded: Path, tmp_path: Path, name: str, fake: fake_core.Slam
) -> None:
    with pytest.raises(InputError, match=f"^source {name} .*pip uninstall broken-one`$"):
        open_source(f"{name}:x")
    with pytest.raises(InputError, match=f"^segmenter {name} .*pip uninstall broken-one`$"):
        vsgraphs.run(recorded, tmp_path / "a", segmenter=name)
    if name != "raising":  # it is known only when it is called
        with pytest.raises(InputError, match=f"^exporter {name} .*pip uninstall broken-one`$"):
            vsgraphs.run(recorded, tmp_path / "b", exporters=[name])
        assert not (tmp_path / "b").exists()


@pytest.mark.parametrize("where", ["frames", "load"])
def test_a_source_that_breaks_amid_a_run_keeps_what_was_tracked(
    site: Path, recorded: Path, tmp_path: Path, vsgraphs: Program, where: str
) -> None:
    install(site, "wobbly", {"vsgraphs.sources": {"wobbly": "wobbly:Wobbly"}})
    (site / "wobbly.py").write_text(
        "import vsgraphs\n"
        "class Frame:\n"
        "    def __init__(self, frame): self.timestamp, self.load = frame.timestamp, self.fail\n"
        "    def fail(self): raise KeyError('mine')\n"
        "class Wobbly:\n"
        "    def __init__(self, text):\n"
        "        self.where, _, folder = text.partition(',')\n"
        "        self.recorded = vsgraphs.open_sequence(folder)\n"
        "        self.camera = self.recorded.camera\n"
        "    @property\n"
        "    def frames(self):\n"
        "        yield from self.recorded.frames[:12]\n"
        "        if self.where == 'load': yield Frame(self.recorded.frames[12])\n"
        "        raise KeyError('mine')\n"
    )
    done = vsgraphs("run", f"wobbly:{where},{recorded}", "--out", tmp_path / "out")
    assert "source wobbly failed: KeyError: 'mine'; update the package wobbly" in one_line_error(done)
    assert report(tmp_path / "out")["tracked"] == 12
    assert report(tmp_path / "out")["source"] == {"name": "Wobbly"}


def test_what_is_listed(example: Path, broken: Path, vsgraphs: Program) -> None:
    done = vsgraphs("plugins")
    assert done.returncode == 0
    lines = [" ".join(line.split()) for line in done.stdout.splitlines()]
    assert "rooms-csv vsgraphs-example" in lines
    assert "floorplan vsgraphs" in lines
    assert len([line for line in lines if line.startswith("gone source gone cannot be loaded")]) == 1


def test_a_folder_whose_name_has_a_colon_is_a_folder(
    example: Path, recorded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("npz:here").symlink_to(recorded)
    assert open_source("npz:here").format == "TUM RGB-D"  # type: ignore[attr-defined]


# --- functions given to a run


def test_exporters_and_checks_as_functions(recorded: Path, tmp_path: Path, fake: fake_core.Slam) -> None:
    def poses(result: vsgraphs.Result) -> dict[str, str]:
        return {"poses.txt": f"{len(result.trajectory)}\n"}

    def complete(result: vsgraphs.Result) -> Iterator[str]:
        assert {"trajectory.txt", "poses.txt"} <= {path.name for path in tmp_path.iterdir()}
        yield f"{result.info['tracked']} frames"

    result = vsgraphs.run(recorded, tmp_path, exporters=[poses], checks=[complete])
    assert (tmp_path / "poses.txt").read_text() == "60\n"
    assert result.files["poses.txt"] == tmp_path / "poses.txt"
    assert "complete: 60 frames" in report(tmp_path)["warnings"]


@pytest.mark.parametrize(
    ("made", "says"),
    [
        ({"run.json": ""}, "run.json is a file of every run"),
        ({"../a": ""}, "'../a' is not the plain name of a file"),
        ({"a": 3}, "a holds int, not str or bytes"),
        ([], "expected {file name: content}, got list"),
    ],
)
def test_what_no_exporter_may_do(
    recorded: Path, tmp_path: Path, fake: fake_core.Slam, made: Any, says: str
) -> None:
    def export(_: vsgraphs.Result) -> Any:
        return made

    result = vsgraphs.run(recorded, tmp_path, exporters=[export], checks=())
    assert f"exporter export: {says}" in " ".join(result.warnings)
    assert report(tmp_path)["tracked"] == 60


# --- callbacks


def test_keyframes_are_told_in_order(recorded: Path, tmp_path: Path) -> None:
    told: list[Any] = []
    result = vsgraphs.run(recorded, tmp_path, execution="serial", on_keyframe=told.append)
    assert [event.timestamp_s for event in told][: len(result.keyframes)] != []
    assert [event.index for event in told] == sorted({event.index for event in told})
    np.testing.assert_allclose(told[0].world_from_camera, np.eye(4), atol=1e-9)
    assert set(result.keyframes.timestamps) <= {event.timestamp_s for event in told}


class Growing:
    """A Slam with rooms and loops that appear."""

    def __init__(self) -> None:
        self.ids: list[int] = []
        self.verdicts = {"loop": {}, "join": {}}

    def snapshot(self) -> Growing:
        return self

    def keyframes(self) -> tuple[Any, Any, Any]:
        return np.arange(1), np.zeros(1), np.eye(4)[None]

    def scene_graph(self) -> dict[str, Any]:
        square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0]], float)
        rooms = [
            {
                "id": i,
                "polygon": square,
                "centroid": square[0],
                "height_m": 2.5,
                "area_m2": 4.0 + i,
                "walls": [],
            }
            for i in self.ids
        ]
        return {"up": np.array([0.0, 0, 1]), "planes": [], "rooms": rooms, "floors": [], "doors": []}

    def statistics(self) -> dict[str, Any]:
        return {f"{kind}_candidates": {"verdicts": dict(found)} for kind, found in self.verdicts.items()}


def keyframe(index: int) -> Any:
    class Result:
        is_keyframe = True
        world_from_camera = np.eye(4)

    Result.index = index
    return Result


def test_a_room_is_told_once_and_levelled() -> None:
    slam, told = Growing(), list[Any]()
    events = Events(slam, on_room=told.append)
    events.after(keyframe(0), 0.0)
    slam.ids = [3]
    events.after(keyframe(1), 0.5)  # looked for once a second
    assert told == []
    events.after(keyframe(2), 1.2)
    events.after(keyframe(3), 2.4)
    slam.ids = [3, 5]
    events.end()
    assert [(event.room.id, event.timestamp_s) for event in told] == [(3, 1.2), (5, 2.4)]
    assert told[0].graph.frame.levelled
    assert told[0].room.area_m2 == 7.0


def test_loops_are_told_by_their_verdicts_and_old_ones_are_not() -> None:
    slam, told = Growing(), list[Any]()
    slam.verdicts["loop"] = {"closed": 4}  # of the atlas it began with
    events = Events(slam, on_loop=told.append)
    slam.verdicts = {"loop": {"closed": 5, "tilted": 2}, "join": {"closed": 1}}
    events.after(keyframe(0), 7.0)
    events.end()
    assert [(event.verdict, event.closed, event.maps) for event in told] == [
        ("closed", True, False),
        ("tilted", False, False),
        ("tilted", False, False),
        ("closed", True, True),
    ]


@pytest.mark.parametrize("name", ["on_keyframe", "on_room", "on_loop"])
def test_a_callback_that_raises_ends_the_run_with_its_results(
    recorded: Path, tmp_path: Path, name: str
) -> None:
    def fail(_: object) -> None:
        raise ValueError("mine")

    callbacks: dict[str, Callable[[Any], object]] = {name: fail}
    if name == "on_keyframe":
        with pytest.raises(ValueError, match="mine"):
            vsgraphs.run(recorded, tmp_path, on_keyframe=fail)
        assert report(tmp_path)["tracked"] == 1
    else:  # of a wall there are neither
        vsgraphs.run(recorded, tmp_path, max_frames=12, **callbacks)
