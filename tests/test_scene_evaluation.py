from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest
from scene_worlds import building, camera_poses, moved, perfect_map

from vsgraphs.errors import InputError
from vsgraphs.evaluate.scene import (
    Detection,
    SceneOptions,
    SceneScores,
    align_poses,
    evaluate_scene,
    options_from,
    parse_scene_truth,
    trajectory_from_graph,
)
from vsgraphs.evaluate.scene.raster import common_cells, intersection_over_union, rasterise
from vsgraphs.scene_graph import SceneGraph
from vsgraphs.trajectory import Array, Trajectory

Raw = dict[str, Any]


@pytest.fixture(scope="module")
def world() -> tuple[Raw, Raw, tuple[Array, Array, Array], Array]:
    """The truth, the flawless map of it, its keyframes, the true poses."""
    truth = building()
    poses = camera_poses(truth)
    return truth, *perfect_map(truth, poses), poses


def scored(
    world: Any,
    raw: Raw | None = None,
    truth: Raw | None = None,
    options: SceneOptions | None = None,
    **more: Any,
) -> SceneScores:
    true_scene, perfect, keyframes, poses = world
    graph = SceneGraph.from_map(perfect if raw is None else raw, keyframes)
    estimate = np.array([keyframe.world_from_camera for keyframe in graph.keyframes.values()])
    parsed = parse_scene_truth(true_scene if truth is None else truth, "truth")
    return evaluate_scene(
        graph, parsed, align_poses(estimate, poses), options=options or SceneOptions(), **more
    )


def counts(score: Detection) -> tuple[int | None, int, int, int, int]:
    """Detected, true, false, duplicates, ignored."""
    return score.detected, score.true, score.false, score.duplicates, score.ignored


def test_a_flawless_graph_scores_one(world: Any) -> None:
    scores = scored(world)
    assert counts(scores.walls) == (12, 12, 0, 0, 4)  # the store room's walls are scenery
    assert counts(scores.ground) == (1, 1, 0, 0, 0)
    assert counts(scores.rooms) == (3, 3, 0, 0, 1)
    assert counts(scores.floors) == (1, 1, 0, 0, 0)
    assert counts(scores.doors) == (2, 2, 0, 0, 1)
    for score in (scores.walls, scores.ground, scores.rooms, scores.floors, scores.doors):
        assert score.precision == score.recall == score.f1 == 1.0
    assert scores.walls.mean_error("angle_deg") == pytest.approx(0, abs=1e-5)
    assert scores.walls.mean_error("offset_m") == pytest.approx(0, abs=1e-6)
    assert scores.rooms.mean_error("iou") == pytest.approx(1, abs=1e-9)
    assert scores.rooms.mean_error("centroid_m") == pytest.approx(0, abs=1e-6)
    assert counts(scores.building_components) == (13, 13, 0, 0, 4)


def in_truth_frame(raw: Raw, poses: Array) -> Raw:
    return moved(raw, poses[0])


def edited(world: Any, change: Any) -> Raw:
    """The flawless map after `change` of it in the truth's frame."""
    _, raw, _, poses = world
    out = in_truth_frame(raw, poses)
    change(out)
    return moved(out, np.linalg.inv(poses[0]))


def shift(plane: Raw, by: float) -> None:
    plane["d"] -= by
    plane["points"] = plane["points"] + by * plane["normal"]
    plane["anchor"] = plane["anchor"] + by * plane["normal"]


def test_a_shifted_wall_is_missed_and_false(world: Any) -> None:
    for by, expected in ((0.15, (12, 12, 0, 0, 4)), (0.25, (11, 12, 1, 0, 4))):
        scores = scored(world, edited(world, lambda raw, by=by: shift(raw["planes"][0], by)))
        assert counts(scores.walls) == expected
    assert scores.walls.recall == pytest.approx(11 / 12)
    # 0.25 m is within twice an ATE of 0.13 m, and no ATE excuses 0.45 m.
    raw = edited(world, lambda raw: shift(raw["planes"][0], 0.25))
    assert counts(scored(world, raw, ate_m=0.13).walls) == (12, 12, 0, 0, 4)
    assert scored(world, raw, ate_m=0.13).walls.mean_error("offset_m") == pytest.approx(0.25 / 12, abs=1e-4)
    raw = edited(world, lambda raw: shift(raw["planes"][0], 0.45))
    assert counts(scored(world, raw, ate_m=9.0).walls) == (11, 12, 1, 0, 4)


def test_missing_turned_and_mirrored_walls(world: Any) -> None:
    def drop(raw: Raw) -> None:
        raw["planes"][3]["role"] = "undecided"

    def mirror(raw: Raw) -> None:
        plane = raw["planes"][3]
        plane["normal"], plane["d"] = -plane["normal"], -plane["d"]

    def turn(raw: Raw) -> None:
        plane, angle = raw["planes"][3], np.radians(12)
        c, s = np.cos(angle), np.sin(angle)
        middle = plane["points"].mean(axis=0)
        plane["normal"] = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ plane["normal"]
        plane["d"] = -plane["normal"] @ middle

    assert counts(scored(world, edited(world, drop)).walls) == (11, 12, 0, 0, 4)
    assert counts(scored(world, edited(world, mirror)).walls) == (11, 12, 1, 0, 4)
    raw = edited(world, turn)
    assert counts(scored(world, raw).walls) == (11, 12, 1, 0, 4)
    assert counts(scored(world, raw, options=SceneOptions(angle_deg=15)).walls) == (12, 12, 0, 0, 4)


def piece(plane: Raw, number: int, low: float, high: float, axis: int = 0) -> Raw:
    out = copy.deepcopy(plane)
    along = out["points"][:, axis]
    out["id"], out["points"] = number, out["points"][(along > low) & (along < high)]
    return out


def test_a_repeated_wall_is_false_unless_far_from_the_first_piece(world: Any) -> None:
    def repeat(raw: Raw) -> None:
        raw["planes"].append(piece(raw["planes"][10], 99, 0.0, 8.0))  # the corridor's far wall, 8 m

    def broken(raw: Raw, gap: float) -> None:
        far = raw["planes"][10]
        raw["planes"].append(piece(far, 99, 4 + gap, 8.0))
        raw["planes"][10] = piece(far, 10, 0.0, 4.0)

    scores = scored(world, edited(world, repeat))
    assert counts(scores.walls) == (12, 12, 1, 1, 4)
    assert scores.walls.precision == pytest.approx(12 / 13)
    assert counts(scored(world, edited(world, lambda raw: broken(raw, 1.0))).walls) == (12, 12, 1, 1, 4)
    apart = scored(world, edited(world, lambda raw: broken(raw, 2.0))).walls
    assert counts(apart) == (12, 12, 0, 0, 4)
    assert apart.correct == 13  # both pieces


def test_one_plane_may_be_two_coplanar_walls(world: Any) -> None:
    def join(raw: Raw) -> None:  # the rooms' outer walls, y = 0
        a, b = raw["planes"][0], raw["planes"][4]
        a["points"] = np.concatenate([a["points"], b["points"]])
        b["role"] = "other"

    scores = scored(world, edited(world, join))
    assert counts(scores.walls) == (12, 12, 0, 0, 4)
    assert scores.walls.correct == 11


def test_a_short_overlap_is_no_wall(world: Any) -> None:
    def slide(raw: Raw) -> None:  # 4 m of wall, of which 0.9 lie on the true one
        plane = raw["planes"][0]
        plane["points"] = plane["points"] - np.array([3.1, 0, 0])

    assert counts(scored(world, edited(world, slide)).walls) == (11, 12, 1, 0, 4)
    assert counts(scored(world, edited(world, slide), options=SceneOptions(overlap=0.2)).walls)[0] == 12


def test_walls_of_another_storey_do_not_count(world: Any) -> None:
    def lift(raw: Raw) -> None:
        plane = raw["planes"][0]
        plane["points"] = plane["points"] + np.array([0, 0, 2.8])

    assert counts(scored(world, edited(world, lift)).walls) == (11, 12, 1, 0, 4)


def test_what_is_not_observed_is_not_missed(world: Any) -> None:
    truth = copy.deepcopy(world[0])
    truth["walls"][0]["observed"] = False
    truth["rooms"][1]["visited"] = False
    scores = scored(world, truth=truth)
    assert counts(scores.walls) == (11, 11, 0, 0, 5)
    assert counts(scores.rooms) == (2, 2, 0, 0, 2)
    assert counts(scores.doors) == (1, 1, 0, 0, 2)


def test_ground_pieces_tables_and_steps(world: Any) -> None:
    def table(raw: Raw) -> None:
        top = piece(raw["planes"][16], 99, 1.0, 2.0)
        shift(top, 0.75)
        raw["planes"].append(top)

    def twice(raw: Raw) -> None:
        raw["planes"].append(piece(raw["planes"][16], 99, 4.0, 8.0))

    assert counts(scored(world, edited(world, table)).ground) == (1, 1, 1, 0, 0)
    assert counts(scored(world, edited(world, twice)).ground) == (1, 1, 1, 1, 0)
    off = scored(world, edited(world, lambda raw: shift(raw["planes"][16], 0.1))).ground
    assert off.mean_error("offset_m") == pytest.approx(0.1, abs=1e-4)


def test_rooms_by_overlap(world: Any) -> None:
    def shrink(raw: Raw, share: float) -> None:
        polygon = raw["rooms"][0]["polygon"]
        polygon[:, 0] *= share

    def split(raw: Raw) -> None:
        half = copy.deepcopy(raw["rooms"][0])
        half["id"] = 9
        half["polygon"][:, 0] = half["polygon"][:, 0] * 0.4 + 2.4
        raw["rooms"][0]["polygon"][:, 0] *= 0.6
        raw["rooms"].append(half)

    smaller = scored(world, edited(world, lambda raw: shrink(raw, 0.75))).rooms
    assert counts(smaller) == (3, 3, 0, 0, 1)
    assert smaller.matches[-1].errors["iou"] == pytest.approx(0.75, abs=0.01)
    missed = scored(world, edited(world, lambda raw: shrink(raw, 0.45)))
    assert counts(missed.rooms) == (2, 3, 1, 0, 1)
    assert counts(missed.doors) == (1, 2, 1, 0, 1)  # its door no longer joins two known rooms
    assert counts(scored(world, edited(world, split)).rooms) == (3, 3, 1, 0, 1)


def test_a_landing_is_part_of_a_stairwell_that_is_not_scored(world: Any) -> None:
    def landing(raw: Raw) -> None:
        upper = copy.deepcopy(raw["rooms"][3])
        upper["id"] = 9
        upper["polygon"] += 2.8 * raw["up"]
        raw["rooms"].append(upper)

    def of_height(height_m: float) -> Raw:
        truth = copy.deepcopy(world[0])
        truth["rooms"][3].update(kind="stairs", height=height_m)
        return truth

    graph = edited(world, landing)
    assert counts(scored(world, graph, of_height(5.4)).rooms) == (3, 3, 0, 0, 2)
    assert counts(scored(world, graph, of_height(2.6)).rooms) == (3, 3, 1, 0, 1)


def test_doors_need_their_place_and_their_rooms(world: Any) -> None:
    def slide(raw: Raw, by: float) -> None:
        raw["doors"][0]["center"] = raw["doors"][0]["center"] + np.array([by, 0, 0])

    def other_rooms(raw: Raw) -> None:
        raw["doors"][0]["rooms"] = [0, 1]

    near = scored(world, edited(world, lambda raw: slide(raw, 0.4))).doors
    assert counts(near) == (2, 2, 0, 0, 1)
    assert near.mean_error("center_m") == pytest.approx(0.2, abs=1e-6)
    assert counts(scored(world, edited(world, lambda raw: slide(raw, 0.6))).doors) == (1, 2, 1, 0, 1)
    assert counts(scored(world, edited(world, other_rooms)).doors) == (1, 2, 1, 0, 1)


def test_not_estimated_is_not_zero(world: Any) -> None:
    bare = {key: world[1][key] for key in ("up", "planes")}
    figures = scored(world, bare).to_json()["structural_elements"]
    for name, true in (("rooms", 3), ("floors", 1), ("doors", 2)):
        assert figures[name]["note"] == "not estimated"
        assert figures[name]["true"] == true
        assert figures[name]["detected"] is figures[name]["recall"] is figures[name]["f1"] is None
    empty = scored(world, {**bare, "rooms": [], "floors": [], "doors": []}).to_json()["structural_elements"]
    assert empty["rooms"]["detected"] == empty["rooms"]["recall"] == empty["rooms"]["f1"] == 0
    assert empty["rooms"]["precision"] is None


def test_without_up_walls_are_scored_all_the_same(world: Any) -> None:
    scores = scored(world, {"up": None, "planes": world[1]["planes"]})
    assert counts(scores.walls) == (12, 12, 0, 0, 4)
    assert counts(scores.ground) == (1, 1, 0, 0, 0)


def test_alignment_is_the_trajectory_s_even_on_a_straight_walk() -> None:
    rng = np.random.default_rng(1)
    poses = np.tile(np.eye(4), (60, 1, 1))
    poses[:, 0, 3] = np.linspace(0, 10, 60)
    transform = np.eye(4)
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    transform[:3, :3], transform[:3, 3] = q * np.linalg.det(q), [3, -2, 1]
    estimate = np.linalg.inv(transform) @ poses
    np.testing.assert_allclose(align_poses(estimate, poses), transform, atol=1e-9)
    noisy = estimate.copy()
    noisy[:, :3, 3] += rng.normal(0, 0.01, (60, 3))
    found = align_poses(noisy, poses)
    turn = np.degrees(np.arccos((np.trace(found[:3, :3].T @ transform[:3, :3]) - 1) / 2))
    assert turn < 1.0  # centres alone leave the turn about the walk open


def test_frames_are_found_by_the_keyframes(world: Any) -> None:
    _, raw, keyframes, _ = world
    graph = SceneGraph.from_map(raw, keyframes)
    in_map = Trajectory(keyframes[1], keyframes[2])
    in_graph = Trajectory(keyframes[1], graph.poses_from_map(keyframes[2]))
    np.testing.assert_array_equal(trajectory_from_graph(graph, in_graph), np.eye(4))
    np.testing.assert_allclose(
        trajectory_from_graph(graph, in_map) @ graph.frame.world_from_map, np.eye(4), atol=1e-12
    )
    other = in_map.poses.copy()
    other[:, 0, 3] += np.linspace(0, 5, len(other))
    with pytest.raises(InputError, match="different runs"):
        trajectory_from_graph(graph, Trajectory(keyframes[1], other))
    with pytest.raises(InputError, match="different runs"):
        trajectory_from_graph(graph, Trajectory(keyframes[1] + 1000, in_map.poses))


def test_map_points(world: Any) -> None:
    truth, _, _, poses = world
    on_wall = np.array([[1.0, 0.03, 1.0], [2.0, 1.5, 0.0], [2.0, 1.5, 2.6], [0.04, 1.0, 1.0]])
    furniture = np.array([[2.0, 1.5, 1.0], [np.nan, 0, 0]])
    graph = SceneGraph.from_map(world[1], world[2])
    estimate = np.array([keyframe.world_from_camera for keyframe in graph.keyframes.values()])
    alignment = align_poses(estimate, poses)
    points = np.concatenate([on_wall, furniture])
    in_graph = (points - alignment[:3, 3]) @ alignment[:3, :3]
    score = evaluate_scene(graph, parse_scene_truth(truth, "t"), alignment, map_points=in_graph).map
    assert score is not None
    assert (score.points, score.structural_points, score.share_within) == (5, 4, 0.8)
    assert score.structural_rmse_m == pytest.approx(np.sqrt((0.03**2 + 0.04**2) / 4), abs=1e-9)
    assert score.rmse_m == pytest.approx(np.sqrt((0.03**2 + 0.04**2 + 1.0) / 5), abs=1e-9)


def test_rastered_areas() -> None:
    square = np.array([[0.0, 0.0], [2, 0], [2, 2], [0, 2]])
    l_shape = np.array([[0.0, 0.0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]])
    turned = (l_shape - 1) @ np.array([[0.8, 0.6], [-0.6, 0.8]]) + [5.3, -7.1]
    assert rasterise(square).cells == 10000
    assert rasterise(l_shape[::-1]).cells == 7500
    assert rasterise(turned).cells == pytest.approx(7500, rel=0.01)
    assert intersection_over_union(rasterise(square), rasterise(l_shape)) == pytest.approx(0.75)
    assert common_cells(rasterise(square), rasterise(square + np.array([1.5, -0.5]))) == pytest.approx(
        0.75 / 4e-4
    )
    assert common_cells(rasterise(square), rasterise(square + 5)) == 0


def test_tolerances_from_text() -> None:
    assert options_from(["offset_m=0.1", "room_iou=0.7"]) == SceneOptions(offset_m=0.1, room_iou=0.7)
    for text, message in (
        ("offset=1", "unknown tolerance 'offset'"),
        ("offset_m=wide", "not a number"),
        ("offset_m=-1", "must be finite and not negative"),
    ):
        with pytest.raises(InputError, match=message):
            options_from([text])
