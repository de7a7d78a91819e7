"""Plans into sequences: layout, truth, repeatability, and what is said about plans that cannot be."""

from __future__ import annotations

import copy
import hashlib
import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from vsgraphs.datasets import open_sequence
from vsgraphs.errors import InputError
from vsgraphs.plans import load_plan, plan_names
from vsgraphs.plans.schema import EXTRA_KEYS, PLAN, Table
from vsgraphs.simulate import Output, simulate

SMALL = {"width": 96, "height": 72, "fx": 78.75, "fy": 78.75, "cx": 47.5, "cy": 35.5}
PLAN_DICT: dict[str, Any] = {
    "name": "test",
    "seed": 3,
    "fps": 10,
    "camera": SMALL,
    "rooms": [
        {"id": "A", "polygon": [[0, 0], [5, 0], [5, 4], [0, 4]], "skirting": False},
        {"id": "B", "polygon": [[5.2, 0], [9.2, 0], [9.2, 4], [5.2, 4]]},
    ],
    "doors": [{"rooms": ["A", "B"], "at": [5.1, 2], "leaf": {"room": "B", "angle_deg": 90}}],
    "windows": [{"room": "A", "wall": 0, "along": 2.5, "radiator": True, "curtain": True}],
    "posters": [{"room": "A", "wall": 2, "along": 2.5, "kind": "board", "width": 1.2, "height": 0.9}],
    "boxes": [{"kind": "sideboard", "room": "A", "at": [2.5, 3.7], "yaw_deg": 180, "size": [1.4, 0.45, 0.8]}],
    "path": {"waypoints": [{"at": [1.5, 2], "look": [5, 2.4]}, {"at": [3, 2], "look": [5, 1.6]}]},
}
# What readers of scene_gt.json rely on.
TRUTH_KEYS = {
    "": "plan seed description convention rooms walls floors ceilings doors windows instances classes "
    "adjacency path_length_m duration_s fps_default summary timestamp_offset",
    "rooms": "id polygon centroid area level z_floor height counted kind walls floor_inst ceiling_inst "
    "visited floor_observed_frames",
    "walls": "id inst room side p0 p1 length height n d area counted observed_frames "
    "observed_mean_px_share observed",
    "floors": "inst room level n d",
    "ceilings": "inst room n d",
    "doors": "id inst rooms center width height normal leaf",
    "windows": "id inst room center width height",
    "instances": "id cls",
}


def plan(**changes: Any) -> dict[str, Any]:
    return {**copy.deepcopy(PLAN_DICT), **changes}


def stamps(path: Path) -> list[str]:
    return [line.split()[0] for line in path.read_text().splitlines() if not line.startswith("#")]


def digest(folder: Path) -> dict[str, str]:
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {str(f.relative_to(folder)): hashlib.sha256(f.read_bytes()).hexdigest() for f in files}


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("simulate") / "clean"
    done = simulate(plan(), out, noise="clean", frames=12, output=Output(labels_every=3))
    assert done.complete
    assert done.frames == 12
    return out


@pytest.fixture(scope="module")
def truth(clean: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((clean / "scene_gt.json").read_text())
    return found


def test_layout(clean: Path) -> None:
    names = {path.name for path in clean.iterdir()}
    lists = {"rgb.txt", "depth.txt", "associations.txt", "groundtruth.txt", "labels.txt"}
    assert names == lists | {"rgb", "depth", "label", "instance", "camera.yaml", "scene_gt.json"}
    every = stamps(clean / "rgb.txt")
    assert len(every) == 12
    assert every == stamps(clean / "depth.txt") == stamps(clean / "groundtruth.txt")
    assert stamps(clean / "labels.txt") == every[::3]
    assert [path.stem for path in sorted((clean / "label").iterdir())] == every[::3]
    sequence = open_sequence(clean)
    assert (sequence.format, len(sequence.frames), sequence.warnings) == ("TUM RGB-D", 12, [])
    rgb, depth = sequence.frames[0].load()
    assert rgb.shape == (72, 96, 3)
    assert depth.dtype == np.uint16
    assert (depth > 0).all()


def test_truth_has_every_key_readers_need(truth: dict[str, Any]) -> None:
    assert set(TRUTH_KEYS[""].split()) <= set(truth)
    for name, keys in TRUTH_KEYS.items():
        if name:
            assert truth[name], name
            for item in truth[name]:
                assert set(keys.split()) <= set(item), name
    assert truth["adjacency"] == [["A", "B"]]
    assert truth["classes"]["wall"] == 1
    assert truth["rooms"][0]["visited"]
    assert not truth["rooms"][1]["visited"]
    assert truth["summary"]["frames"] == 12


def test_planes_of_the_truth_hold_in_depth_and_poses(clean: Path, truth: dict[str, Any]) -> None:
    """Back-projected clean depth of every wall, floor and ceiling pixel lies on the plane the truth names."""
    planes = {
        p["inst"]: (np.array(p["n"]), p["d"]) for key in ("walls", "floors", "ceilings") for p in truth[key]
    }
    classes = {item["id"]: truth["classes"][item["cls"]] for item in truth["instances"]}
    poses = np.loadtxt(clean / "groundtruth.txt")
    v, u = np.mgrid[:72, :96]
    rays = np.stack(
        [(u - SMALL["cx"]) / SMALL["fx"], (v - SMALL["cy"]) / SMALL["fy"], np.ones_like(u)], axis=-1
    )
    checked = set()
    for number, stamp in zip(range(0, 12, 3), stamps(clean / "labels.txt"), strict=True):
        depth = np.asarray(Image.open(clean / "depth" / f"{stamp}.png")) / 5000
        instance = np.asarray(Image.open(clean / "instance" / f"{stamp}.png"))
        label = np.asarray(Image.open(clean / "label" / f"{stamp}.png"))
        assert (label == np.vectorize(classes.get)(instance)).all()
        _, x, y, z, *q = poses[number]
        points = (rays * depth[..., None]) @ rotation(q).T + (x, y, z)
        for inst, (n, d) in planes.items():
            distance = points[instance == inst] @ n + d
            if len(distance):
                # B's walls carry skirting boards 1.4 cm thick; A's do not.
                limit = 0.015 if inst in {w["inst"] for w in truth["walls"] if w["room"] == "B"} else 2e-4
                assert np.abs(distance).max() < limit
                checked.add(inst)
    assert len(checked) >= 5


def rotation(q: list[float]) -> np.ndarray[Any, np.dtype[np.float64]]:
    x, y, z, w = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def test_same_bytes_whatever_the_number_of_threads(tmp_path: Path) -> None:
    for name, workers in (("one", 1), ("three", 3)):
        simulate(plan(), tmp_path / name, seed=4, frames=6, output=Output(workers=workers))
    assert digest(tmp_path / "one") == digest(tmp_path / "three")


def test_another_seed_changes_the_images_and_nothing_else(tmp_path: Path) -> None:
    for seed in (1, 2):
        simulate(plan(), tmp_path / str(seed), seed=seed, frames=3)
    a, b = digest(tmp_path / "1"), digest(tmp_path / "2")
    changed = {name for name in a if a[name] != b[name]}
    assert {name.split("/")[0] for name in changed} == {"rgb", "depth", "scene_gt.json"}
    truths = [json.loads((tmp_path / name / "scene_gt.json").read_text()) for name in ("1", "2")]
    assert [truth.pop("noise_seed") for truth in truths] == [1, 2]
    assert truths[0] == truths[1]


def test_single_effects_can_be_switched(tmp_path: Path) -> None:
    simulate(plan(), tmp_path / "a", noise={"depth_holes": False, "image_noise": False}, frames=1)
    depth = np.asarray(Image.open(next((tmp_path / "a" / "depth").iterdir())))
    assert (depth > 0).all()
    disparity_steps = 0.075 * SMALL["fx"] * 5000 / depth / 0.125
    assert np.abs(disparity_steps - disparity_steps.round()).max() < 0.01


def test_rate_thinning_and_formats(tmp_path: Path) -> None:
    output = Output(fps=20, every=4, image_format="png", labels_every=0)
    done = simulate(plan(), tmp_path / "thin", noise="clean", output=output)
    times = np.array([float(stamp) for stamp in stamps(tmp_path / "thin" / "rgb.txt")])
    assert np.allclose(np.diff(times), 0.2, atol=2e-6)
    assert "fps: 5.0" in (tmp_path / "thin" / "camera.yaml").read_text()
    assert not (tmp_path / "thin" / "labels.txt").exists()
    assert {path.suffix for path in (tmp_path / "thin" / "rgb").iterdir()} == {".png"}
    assert done.frames == len(times)


def test_stopping_leaves_a_shorter_sequence(tmp_path: Path) -> None:
    written: list[int] = []
    done = simulate(
        plan(),
        tmp_path / "stopped",
        progress=lambda count, _: written.append(count),
        should_stop=lambda: written[-1] >= 3,
        output=Output(workers=2),
    )
    assert not done.complete
    assert 3 <= done.frames < 12
    assert len(open_sequence(tmp_path / "stopped").frames) == done.frames
    assert [path.name for path in tmp_path.iterdir()] == ["stopped"]


def test_ctrl_c_and_failures_leave_nothing_half_done(tmp_path: Path) -> None:
    def fail(count: int, total: int) -> None:
        raise RuntimeError(f"{count}/{total}")

    with pytest.raises(RuntimeError):
        simulate(plan(), tmp_path / "broken", progress=fail)
    assert list(tmp_path.iterdir()) == []

    def interrupt(count: int, total: int) -> None:
        if count == 2 and total > 2:
            raise KeyboardInterrupt

    done = simulate(plan(), tmp_path / "interrupted", progress=interrupt, output=Output(workers=1))
    assert done.frames >= 2
    assert len(open_sequence(tmp_path / "interrupted").frames) == done.frames


def test_only_own_folders_are_overwritten(tmp_path: Path) -> None:
    simulate(plan(), tmp_path / "a", frames=2)
    with pytest.raises(InputError, match="is not empty"):
        simulate(plan(), tmp_path / "a", frames=1)
    assert simulate(plan(), tmp_path / "a", frames=1, output=Output(overwrite=True)).frames == 1
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "letter.txt").write_text("mine")
    with pytest.raises(InputError, match="is not empty"):
        simulate(plan(), tmp_path / "other", output=Output(overwrite=True))
    assert (tmp_path / "other" / "letter.txt").read_text() == "mine"


@pytest.mark.parametrize("name", plan_names())
def test_included_plans_show_every_wall_and_come_back(tmp_path: Path, name: str) -> None:
    loaded = load_plan(name)
    loaded = type(loaded)(loaded.plan, loaded.source, SMALL)
    output = Output(fps=2, labels_every=0)
    done = simulate(loaded, tmp_path / name, noise="clean", output=output)
    found = json.loads((tmp_path / name / "scene_gt.json").read_text())
    assert done.complete
    assert all(wall["observed"] for wall in found["walls"] if wall["counted"])
    assert all(room["visited"] for room in found["rooms"] if room["counted"])
    poses = np.loadtxt(tmp_path / name / "groundtruth.txt")
    assert np.linalg.norm(poses[-1, 1:4] - poses[0, 1:4]) < 0.2
    speed = np.linalg.norm(np.diff(poses[:, 1:4], axis=0), axis=1) * 2
    assert speed.max() < 0.8


def test_the_lookalike_rooms_are_alike_as_promised() -> None:
    def shapes(name: str) -> list[list[float]]:
        rooms = load_plan(name).plan.rooms
        return [np.ptp(np.array(room.polygon), axis=0).round(3).tolist() for room in rooms[:2]]

    same, different = shapes("lookalike_identical"), shapes("lookalike_different")
    assert same[0] == same[1]
    assert different[1][0] - different[0][0] == pytest.approx(0.4)
    assert different[0][1] == different[1][1]


def test_l_shape_is_turned_by_20_degrees() -> None:
    a, b, *_ = np.array(load_plan("l_shape").plan.rooms[0].polygon)
    assert math.degrees(math.atan2(*(b - a)[::-1])) == pytest.approx(20)


def test_a_folder_does_not_hide_an_included_plan(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "demo").mkdir()
    monkeypatch.chdir(tmp_path)
    assert load_plan("demo").plan.name == "demo"


def broken(path: str, value: Any) -> dict[str, Any]:
    """The plan with one value replaced (or, for `...`, removed); `path` like rooms.0.polygon."""
    changed = plan()
    *way, last = path.split(".")
    place: Any = changed
    for step in way:
        place = place[int(step) if step.isdigit() else step]
    if value is ...:
        del place[last]
    else:
        place[int(last) if last.isdigit() else last] = value
    return changed


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("rooms.0.polygom", [], r"rooms\[0\].polygom: unknown key; did you mean 'polygon'\?"),
        ("path.speeed", 1, r"path.speeed: unknown key; did you mean 'speed'\?"),
        ("quux", 1, r"quux: unknown key; known: "),
        ("rooms.0.polygon", ..., r'rooms\[0\]: "polygon" is missing'),
        ("path.waypoints", [], r"path.waypoints: must not be empty"),
        ("rooms.0.polygon", "square", r"rooms\[0\].polygon: expected a list of points, not 'square'"),
        ("rooms.0.polygon", [[0, 0], [5, 0], [0, 4], [5, 4]], r"rooms\[0\].polygon: edges cross"),
        ("rooms.0.polygon", [[0, 0], [0, 4], [5, 4], [5, 0]], r"rooms\[0\].polygon: runs clockwise"),
        ("rooms.0.polygon", [[0, 0], [5, 0]], r"rooms\[0\].polygon: needs at least 3 corners"),
        ("rooms.0.height", math.nan, r":\d+: NaN is no number"),
        ("rooms.0.height", True, r"rooms\[0\].height: expected a finite number, not true"),
        ("rooms.0.level", 1.5, r"rooms\[0\].level: expected a whole number"),
        ("rooms.0.skirting", 1, r"rooms\[0\].skirting: expected true or false"),
        ("rooms.0.wall_colour", "green", r'rooms\[0\].wall_colour: expected "#rrggbb"'),
        ("doors.0.at", [2, 0], r'doors\[0\].at: rooms "A" and "B" share no wall'),
        ("doors.0.leaf.angel_deg", 5, r"doors\[0\].leaf.angel_deg: unknown key; did you mean 'angle_deg'\?"),
        ("boxes.0.at", [4.9, 3.7], r"boxes\[0\] \(sideboard\): its corner"),
        ("boxes.0.size", [1, 2], r"boxes\[0\].size: expected 3 numbers, not 2"),
        ("boxes.0.kind", "throne", r'boxes\[0\].kind: unknown kind "throne"'),
        (
            "path.waypoints.1.at",
            [7, 3],
            r"path.waypoints\[0\]: the way on from here comes too close to wall 1",
        ),
        ("fps", 0, r"fps: must lie in"),
        ("seed", -1, r"seed: expected a whole number"),
        ("camera", {"width": 640}, r"camera: give all of"),
        ("camera.fx", -3.0, r"camera: fx must be"),
    ],
)
def test_wrong_plans_name_file_and_key(tmp_path: Path, path: str, value: Any, message: str) -> None:
    file = tmp_path / "place.json"
    file.write_text(json.dumps(broken(path, value)))
    with pytest.raises(InputError) as error:
        simulate(file, tmp_path / "out")
    text = str(error.value)
    assert text.startswith(f"{file}:")
    assert re.search(message, text), text
    assert "\n" not in text
    assert not (tmp_path / "out").exists()


def test_files_that_are_no_plans(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no plan 'one_rom'; did you mean 'one_room'"):
        load_plan("one_rom")
    for content, message in (('{"rooms": [,]}', r":1: not valid JSON"), ("[]", "expected an object")):
        file = tmp_path / "place.json"
        file.write_text(content)
        with pytest.raises(InputError, match=message):
            load_plan(file)
    with pytest.raises(InputError, match="cannot read plan"):
        load_plan(tmp_path / "absent.json")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"noise": "loud"}, "noise must be one of sensor, clean"),
        ({"noise": {"blurr": True}}, "unknown effect 'blurr'"),
        ({"noise": {"baseline_m": -1}}, "noise.baseline_m: must lie in"),
        ({"seed": -1}, "seed must lie in"),
        ({"frames": 0}, "frames must be at least 1"),
        ({"output": Output(every=0)}, "every must be at least 1"),
        ({"output": Output(image_format="gif")}, "image_format must be jpg or png"),
    ],
)
def test_wrong_options(tmp_path: Path, arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        simulate(plan(), tmp_path / "out", **arguments)
    assert list(tmp_path.iterdir()) == []


def test_every_key_is_documented() -> None:
    text = (Path(__file__).parent.parent / "docs" / "simulator.md").read_text()

    def keys(table: Table) -> set[str]:
        found = set(table.keys)
        for kind in table.keys.values():
            inner = kind[0] if isinstance(kind, list) else kind
            if isinstance(inner, Table):
                found |= keys(inner)
        return found

    missing = [key for key in sorted(keys(PLAN) | set(EXTRA_KEYS)) if f"`{key}`" not in text]
    assert missing == []


def test_a_folder_behind_a_link_or_without_a_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to("real")
    simulate(plan(), tmp_path / "link", frames=1)
    assert (tmp_path / "link").is_symlink()
    assert len(open_sequence(tmp_path / "real").frames) == 1
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    assert simulate(plan(), "", frames=1).frames == 1
    with pytest.raises(InputError, match="is not empty"):
        simulate(plan(), "/", frames=1)


@pytest.mark.parametrize("name", ["every", "labels_every", "workers"])
def test_numbers_beyond_reason(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match=f"{name} must be at least") as caught:
        simulate(plan(), tmp_path / "out", output=Output(**{name: 10**400}))
    assert len(str(caught.value)) < 200
