from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

import pytest

from vsgraphs.scene_graph import load_scene_graph

SCRIPT = Path(__file__).resolve().parent.parent / "benchmarks" / "ablation.py"
sys.path.insert(0, str(SCRIPT.parent))
import ablation  # noqa: E402
import ablation_runs  # noqa: E402
import ablation_statistics as statistics  # noqa: E402
import ablation_tables as tables  # noqa: E402
from ablation_sequences import LISTS, Sequences  # noqa: E402


def row(sequence: str, variant: str, ate_m: float | None, draw: int = 1, seed: int = 0) -> dict[str, Any]:
    figures = {"completion": 1.0} | ({} if ate_m is None else {"ate_rmse_m": ate_m})
    return {
        "key": {"sequence": sequence, "draw": draw, "seed": seed, "variant": variant},
        "figures": figures,
    }


ROWS = [
    row("hall", "slam", 0.10, draw=1),
    row("hall", "bc", 0.05, draw=1),
    row("hall", "slam", 0.20, draw=2),
    row("hall", "bc", 0.18, draw=2),
    row("rendered_room", "slam", 0.010, draw=0),
    row("rendered_room", "bc", 0.011, draw=0),
    row("rendered_room", "bc", 0.001, draw=0, seed=1),  # has no pair
]


@pytest.mark.parametrize(
    ("freedom", "quantile"),
    [(1, 12.7062), (8, 2.3060), (9, 2.2622), (10, 2.2281), (30, 2.0423), (999, 1.9623)],
)
def test_students_t(freedom: int, quantile: float) -> None:
    assert statistics.t_95(freedom) == pytest.approx(quantile, abs=1e-4)


def test_interval_of_a_mean() -> None:
    found = statistics.mean_interval([1.0, 2.0, 3.0])
    half = 4.3027 / 3**0.5  # the standard deviation is 1
    assert (found.mean, found.low, found.high) == pytest.approx((2.0, 2.0 - half, 2.0 + half))
    assert statistics.mean_interval([0.3]) == statistics.Interval(0.3, None, None)


def test_gains_are_paired_by_draw_and_seed() -> None:
    found = statistics.gains(list(reversed(ROWS)), "bc", "slam")
    assert found.sequences["hall"] == pytest.approx([0.5, 0.1])
    assert found.sequences["rendered_room"] == pytest.approx([-0.1])
    assert found.worst() == "rendered_room"
    overall = found.overall()  # sequences count alike, not runs
    assert overall is not None
    assert overall.mean == pytest.approx((0.3 - 0.1) / 2)
    assert overall.low is not None
    assert overall.low < -0.1


def test_a_run_without_truth_has_no_gain() -> None:
    rows = [row("desk", "slam", None), row("desk", "bc", 0.1), row("desk", "slam", 0.1, draw=2)]
    found = statistics.gains(rows, "bc", "slam")
    assert found.sequences == {}
    assert found.overall() is None
    assert found.worst() is None
    assert "no run" in tables.gains_table(rows, "slam")


def test_accuracy_table() -> None:
    lines = tables.accuracy_table(ROWS).splitlines()
    assert lines[0] == "| sequence | ORB-SLAM3 ATE m | slam ATE m | bc ATE m |"
    assert lines[1] == "|---|---:|---:|---:|"
    assert lines[2:] == ["| hall | - | 0.1500 | 0.1150 |", "| rendered_room | 0.18-0.21 | 0.0100 | 0.0060 |"]


def test_figures_table() -> None:
    rows = [row("hall", "slam", 0.1), row("hall", "bc", 0.2)]
    rows[1]["figures"] |= {"recall": 0.5, "cpu_s_per_1000": 8.126}
    assert tables.figures_table(rows).splitlines() == [
        "| sequence | variant | runs | ATE m | lowest completion | recall | CPU ms / frame |",
        "|---|---|---:|---:|---:|---:|---:|",
        "| hall | slam | 1 | 0.1000 | 1.000 | - | - |",
        "| hall | bc | 1 | 0.2000 | 1.000 | 0.50 | 8.13 |",
    ]


def test_a_lost_run_shows_among_good_ones() -> None:
    runs = [{"completion": share} for share in (1.0, 0.4, 1.0)]
    assert statistics.medians(runs, ["completion", "ate_rmse_m"]) == {"completion": 0.4}


def test_gains_table_and_summary() -> None:
    lines = tables.gains_table(ROWS, "slam").splitlines()
    assert lines[2] == "| hall | +30.0 % (worst +10.0 % of 2) |"
    assert lines[4] == "| **mean of sequences** | +10.0 % |"
    assert lines[5] == "| 95 % interval | -244.1 % to +264.1 % |"
    assert lines[6] == "| worst sequence | rendered_room |"
    summary = json.loads(json.dumps(tables.summary(ROWS, "slam")))
    assert summary["medians"]["hall"]["slam"] == pytest.approx(
        {"runs": 2, "ate_rmse_m": 0.15, "completion": 1.0}
    )
    assert summary["ate_gains"]["bc"]["overall"]["mean"] == pytest.approx(0.1)
    assert list(summary["ate_gains"]) == ["bc"]


def test_variants() -> None:
    found = ablation_runs.parse_variant("few:system.mode=bc,orb.levels=3", "full")
    assert found == ablation_runs.Variant("few", "bc", ["orb.levels=3"])
    assert found.arguments() == ["--mode", "bc", "--set", "orb.levels=3"]
    assert ablation_runs.parse_variant("few:orb.levels=3", "full").mode == "full"
    for wrong in ("few", ":a=1", "few:", "few:a", "few:a=1,"):
        with pytest.raises(ValueError, match="is not NAME:KEY=VALUE"):
            ablation_runs.parse_variant(wrong, "full")


def test_modes_are_those_the_program_knows(tmp_path: Path) -> None:
    program = tmp_path / "vsgraphs"
    program.write_text("#!/bin/sh\necho '  mode: bc  # slam (landmarks), full, bc; slam | bc'\n")
    program.chmod(0o755)
    assert ablation_runs.known_modes([str(program)]) == ["slam", "bc"]
    options = argparse.Namespace(vsgraphs=str(program), mode=["full"], variant=[], baseline="slam")
    with pytest.raises(ValueError, match="does not know mode full"):
        ablation.variants_of(options)


def test_modes_of_this_program() -> None:
    known = ablation_runs.known_modes([sys.executable, "-m", "vsgraphs"])
    assert known[:2] == ["slam", "bc"]


def test_components_count_only_where_they_are_looked_for() -> None:
    scores = {"precision": 0.5, "recall": 1.0, "f1": 2 / 3, "angle_deg": None, "offset_m": 0.01, "false": 2}
    scene = {
        "building_components": {"all": scores},
        "map": {"rmse_m": 0.2, "structural_rmse_m": 0.1},
    }
    in_map = {"map_rmse_m": 0.2, "map_near_rmse_m": 0.1}
    assert ablation_runs.scene_figures(scene, estimated=False) == in_map
    expected = in_map | {"precision": 0.5, "recall": 1.0, "f1": 2 / 3, "offset_m": 0.01}
    assert ablation_runs.scene_figures(scene, estimated=True) == expected
    assert ablation_runs.scene_figures(None, estimated=True) == {}


def test_a_map_without_a_scene_graph_is_scored_with_an_empty_one(tmp_path: Path) -> None:
    file = tmp_path / "scene_graph.json"
    file.write_text(json.dumps(ablation_runs.EMPTY_GRAPH))
    graph = load_scene_graph(file)
    assert not graph.keyframes
    assert not graph.planes
    assert graph.frame.world_from_map.tolist() == [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


def plan(tmp_path: Path, **changes: Any) -> list[dict[str, Any]]:
    (tmp_path / "kitchen").mkdir(exist_ok=True)
    options = {"sequences": ["kitchen", "one_room"], "list": None, "draws": [1, 2], "runs": 1, "every": 3}
    options |= {"realtime": False, "execution": "serial", **changes}
    sequences = Sequences(["vsgraphs"], tmp_path, tmp_path / "cache", options["every"])
    variants = [ablation_runs.Variant("slam", "slam"), ablation_runs.Variant("bc", "bc")]
    return ablation.keys_of(argparse.Namespace(**options), variants, sequences, "0123456")


def test_plan_of_runs(tmp_path: Path) -> None:
    keys = plan(tmp_path)
    shown = [(key["sequence"], key["draw"], key["every"], key["variant"]) for key in keys]
    assert shown == [
        ("kitchen", 0, 1, "slam"),
        ("kitchen", 0, 1, "bc"),
        ("one_room", 1, 3, "slam"),
        ("one_room", 1, 3, "bc"),
        ("one_room", 2, 3, "slam"),
        ("one_room", 2, 3, "bc"),
    ]
    named = plan(tmp_path, sequences=["one_room"], list="building_components", draws=[1])
    assert [key["sequence"] for key in named[::2]] == list(LISTS["building_components"])
    with pytest.raises(ValueError, match="no sequences"):
        plan(tmp_path, sequences=[])


def test_what_the_cache_holds_is_what_was_asked_for(tmp_path: Path) -> None:
    sequences = Sequences(["/bin/false"], None, tmp_path, 3)
    folder = tmp_path / "one_room_2_every3"
    assert sequences.simulated("one_room", 2) == folder
    with pytest.raises(RuntimeError, match="simulate one_room"):
        sequences.folder("one_room", 2)
    folder.mkdir()
    with pytest.raises(RuntimeError, match=r"no scene_gt\.json"):
        sequences.folder("one_room", 2)
    truth = folder / "scene_gt.json"
    truth.write_text('{"plan": "one_room", "noise_seed": 1}')
    with pytest.raises(RuntimeError, match="one_room, draw 2"):
        sequences.folder("one_room", 2)
    truth.write_text('{"plan": "one_room", "noise_seed": 2}')
    assert sequences.folder("one_room", 2) == folder


@pytest.fixture
def measured(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Stands in for the programs; the list of runs grows with each that is made."""
    made: list[str] = []

    def one_run(program: list[str], key: dict[str, Any], sequences: Sequences) -> dict[str, Any]:
        made.append(f"{key['sequence']} {key['variant']}")
        if key["sequence"] == "broken":
            raise RuntimeError("vsgraphs run broken\n  no frames")
        return {
            "key": key,
            "figures": {"ate_rmse_m": 0.1 if key["variant"] == "slam" else 0.08},
            "scene": None,
        }

    monkeypatch.setattr(ablation, "one_run", one_run)
    monkeypatch.setattr(ablation, "build_of", lambda program: "0123456")
    monkeypatch.setattr(ablation, "known_modes", lambda program: ["slam", "bc"])
    return made


def run_main(monkeypatch: pytest.MonkeyPatch, *words: object) -> int:
    monkeypatch.setattr(sys, "argv", ["ablation.py", *map(str, words)])
    return ablation.main()


def test_runs_already_made_are_not_made_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, measured: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "ablation.json"
    assert run_main(monkeypatch, "one_room", "--draws", 1, "--json", file) == 0
    assert measured == ["one_room slam", "one_room bc"]
    assert run_main(monkeypatch, "one_room", "corridor", "--draws", 1, "--json", file) == 0
    assert measured[2:] == ["corridor slam", "corridor bc"]
    assert "| **mean of sequences** | +20.0 % |" in capsys.readouterr().out
    document = json.loads(file.read_text())
    assert len(document["runs"]) == 4
    assert document["summary"]["ate_gains"]["bc"]["means"] == pytest.approx(
        {"one_room": 0.2, "corridor": 0.2}
    )
    monkeypatch.setattr(ablation, "build_of", lambda program: "fedcba9")
    assert run_main(monkeypatch, "one_room", "--draws", 1, "--json", file) == 0
    assert measured[4:] == ["one_room slam", "one_room bc"]


def test_failed_runs_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, measured: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_main(monkeypatch, "broken", "one_room", "--draws", 1, "--mode", "slam") == 1
    shown = capsys.readouterr()
    assert "broken draw 1 seed 0 slam: failed: vsgraphs run broken" in shown.err
    assert "1 of 2 runs failed" in shown.err
    assert "| one_room | - | 0.1000 |" in shown.out


def test_mistakes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, measured: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    other = tmp_path / "other.json"
    other.write_text("[]")
    for words, message in (
        ([], "no sequences"),
        (["one_room", "--json", other], "is no file of this program"),
        (["one_room", "--mode", "bc"], "the baseline slam is none of bc"),
        (["one_room", "--variant", "bc:a.b=1"], "same name"),
    ):
        assert run_main(monkeypatch, *words) == 2
        assert message in capsys.readouterr().err
    assert measured == []
    assert other.read_text() == "[]"
