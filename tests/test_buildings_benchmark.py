from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parent.parent / "benchmarks" / "buildings.py"
sys.path.insert(0, str(SCRIPT.parent))
import building_places  # noqa: E402
import building_runs  # noqa: E402
import building_tables  # noqa: E402
import buildings  # noqa: E402

# Stands in for vsgraphs: notes what it is asked and answers with the draw and the options it was given.
PROGRAM = """#!{python} -S
import json, sys
from pathlib import Path
words = sys.argv[1:]
value = lambda option: words[words.index(option) + 1] if option in words else None
with open({log!r}, "a") as log:
    print(words[0], *(word for word in words[1:] if word.startswith(("system", "--s"))), file=log)
if words[0] == "simulate" and value("--plan-only"):
    Path(value("--plan-only")).write_text(json.dumps({{"name": " ".join(words[1:9])}}))
elif words[0] == "simulate":
    out = Path(value("--out"))
    out.mkdir(parents=True)
    (out / "groundtruth.txt").write_text("")
    (out / "scene_gt.json").write_text(json.dumps({{"draw": int(value("--seed"))}}))
    if Path(words[1]).stem == "broken":
        sys.exit("interrupted: the frames so far are kept")
elif words[0] == "run":
    draw = json.loads((Path(words[1]) / "scene_gt.json").read_text())["draw"]
    out = Path(value("--out"))
    out.mkdir(parents=True, exist_ok=True)
    loops = 0 if "system.loop_closing=false" in words else 3
    report = dict(completion=0.5 + draw / 10, cpu_s=10.0 + draw, frames=100, maps=1, loops=loops, merges=0)
    report |= dict(keyframes=9, landmarks=1, peak_memory_mb=50.0, skipped={{}}, stages={{"track": {{}}}})
    report["draw"] = draw
    (out / "run.json").write_text(json.dumps(report))
elif "--scene" in words:
    score = lambda found, true: dict(detected=found, true=true, false=1)
    scores = dict(structural_elements=dict(rooms=score(12, 13), doors=score(10, 12)))
    scores["building_components"] = dict(walls=score(40, 52))
    Path(value("--json")).write_text(json.dumps(scores))
else:
    draw = json.loads((Path(words[1]) / "run.json").read_text())["draw"]
    Path(value("--json")).write_text(json.dumps(dict(ate=dict(rmse_m=0.01 + 0.1 * draw), completion=None)))
"""


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """The stand-in; what it was asked is in `log` beside it."""
    folder = tmp_path / "bin"
    folder.mkdir()
    file = folder / "vsgraphs"
    file.write_text(PROGRAM.format(python=sys.executable, log=str(folder / "log")))
    beside = folder / "python"
    beside.write_text("""#!/bin/sh\necho '["0123456", [], ""]'\n""")
    for each in (file, beside):
        each.chmod(0o755)
    return file


def asked(program: Path) -> list[str]:
    log = program.with_name("log")
    words = log.read_text().splitlines()
    log.unlink()
    return words


def plan_file(folder: Path, name: str = "office", text: str = "{}") -> Path:
    file = folder / f"{name}.json"
    file.write_text(text)
    return file


def run_main(monkeypatch: pytest.MonkeyPatch, program: Path, *words: object) -> int:
    monkeypatch.setattr(sys, "argv", ["buildings.py", *map(str, words), "--vsgraphs", str(program)])
    return buildings.main()


def test_tables(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = plan_file(tmp_path)
    out = tmp_path / "out"
    assert run_main(monkeypatch, program, out, "--plans", plan, "--draws", 0, 1) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("| office")]
    found = "1 | 3 | 0 | 12/13 (1) | 10/12 (1) | 40/52 (1) | 100"
    assert lines == [
        f"| office | default | 0 | 0 | 0.0100 | 50.0 | {found} | 10.0 |",
        f"| office | default | 1 | 0 | 0.1100 | 60.0 | {found} | 11.0 |",
        "| office | default | 2 | 0.0600 / 0.1100 | 55.0 / 50.0 | 1 / 1 | 3 / 3 | 0 / 0 "
        "| 1 / 1 (1 / 1) | 2 / 2 (1 / 1) | 12 / 12 (1 / 1) | 10.5 / 11 |",
    ]


def test_variants_share_a_sequence_and_nothing_is_done_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan, out = plan_file(tmp_path), tmp_path / "out"
    words = ["--plans", plan, "--jobs", 2, "--variant", "plain"]
    words += ["--variant", "open", "system.loop_closing=false"]
    assert run_main(monkeypatch, program, out, *words) == 0
    done = asked(program)
    assert sum(line.startswith("simulate") for line in done) == 1
    assert sorted(line for line in done if line.startswith("run")) == [
        "run --seed",
        "run --seed --set system.loop_closing=false",
    ]
    shown = capsys.readouterr().out
    assert "| office | plain | 0 | 0 | 0.0100 | 50.0 | 1 | 3 |" in shown
    assert "| office | open | 0 | 0 | 0.0100 | 50.0 | 1 | 0 |" in shown
    assert run_main(monkeypatch, program, out, *words) == 0
    assert not program.with_name("log").exists()
    assert capsys.readouterr().out == shown
    plan.write_text('{"name": "changed"}')
    assert run_main(monkeypatch, program, out, *words) == 0
    assert sum(line.startswith("simulate") for line in asked(program)) == 1


def test_a_run_that_was_stopped_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, program: Path
) -> None:
    plan, out = plan_file(tmp_path), tmp_path / "out"
    assert run_main(monkeypatch, program, out, "--plans", plan, "--draws", 0, 1) == 0
    file = out / "results.jsonl"
    first, second = file.read_text().splitlines()
    file.write_text(f"{first}\n{second[:40]}")  # as when the disk was full
    asked(program)
    assert run_main(monkeypatch, program, out, "--plans", plan, "--draws", 0, 1) == 0
    assert [line.split()[0] for line in asked(program)] == ["run", "eval", "eval"]
    assert file.read_text().splitlines() == [first, second]


def test_a_broken_simulation_is_no_sequence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plans = [plan_file(tmp_path, "broken"), plan_file(tmp_path)]
    assert run_main(monkeypatch, program, tmp_path / "out", "--plans", *plans) == 1
    shown = capsys.readouterr()
    assert "broken default draw 0 seed 0: failed:" in shown.err
    assert "1 of 2 runs failed" in shown.err
    assert "| office |" in shown.out
    assert [folder.name[:6] for folder in (tmp_path / "out" / "runs").iterdir()] == ["office"]


def test_named_buildings(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert building_places.building_arguments("line-24-4") == [
        *("--building", "line", "--rooms", "24", "--furnishings", "4", "--seed", "0")
    ]
    assert building_places.building_arguments("ring-16-16-7")[-1] == "7"
    for wrong in ("line", "line-24", "hall-24-4", "line-24-x", "line-1-2-3-4"):
        with pytest.raises(ValueError, match="is no building"):
            building_places.building_arguments(wrong)
    assert run_main(monkeypatch, program, tmp_path / "out", "--buildings", "line-4-2") == 0
    assert "| line-4-2 |" in capsys.readouterr().out
    plan = json.loads((tmp_path / "out" / "plans" / "line-4-2.json").read_text())
    assert plan["name"].startswith("--building line --rooms 4")


def test_mistakes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = plan_file(tmp_path)
    list_, torn = plan_file(tmp_path, "list", "[]"), plan_file(tmp_path, "torn", "{")
    other = tmp_path / "other"
    other.mkdir()
    (other / "results.jsonl").write_text("[]\n")
    for words, message in (
        ([tmp_path], "nothing to run: give --plans or --buildings"),
        ([tmp_path, "--plans", tmp_path / "none.json"], "cannot read plan"),
        ([tmp_path, "--plans", torn], "cannot read plan"),
        ([tmp_path, "--plans", list_], "is no plan"),
        ([tmp_path, "--plans", plan, "--variant", "a", "b"], "'b' is not KEY=VALUE"),
        ([tmp_path, "--plans", plan, "--variant", "a", "--variant", "a"], "same name"),
        ([tmp_path, "--buildings", "hall-3-3"], "is no building"),
        ([other, "--plans", plan], "is no file of this program"),
    ):
        assert run_main(monkeypatch, program, *words) == 2
        assert message in capsys.readouterr().err
    assert not program.with_name("log").exists()


def test_a_run_without_rooms_has_no_score() -> None:
    scene = {"structural_elements": {"rooms": {"detected": None, "true": 3}}}
    assert building_runs._score(scene, "rooms") is None
    figures = dict.fromkeys(building_tables.FOUND) | {"ate_rmse_m": None, "completion": 0.0}
    figures |= dict.fromkeys(("maps", "loops", "merges", "frames", "cpu_s"), 1)
    row = {"key": {"place": "a", "variant": "b", "draw": 0, "seed": 0}, "figures": figures}
    assert "| - | 0.0 | 1 | 1 | 1 | - | - | - | 1 | 1.0 |" in building_tables.runs_table([row])
    assert "| - | 0.0 / 0.0 |" in building_tables.draws_table([row])


def test_the_real_program(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = json.loads(
        (Path(building_places.__file__).parent / "../python/vsgraphs/plans/demo.json").read_text()
    )
    plan["camera"] = {"width": 320, "height": 240, "fx": 262.0, "fy": 262.0, "cx": 159.5, "cy": 119.5}
    program = tmp_path / "vsgraphs"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m vsgraphs "$@"\n')
    program.chmod(0o755)
    (tmp_path / "python").symlink_to(sys.executable)
    monkeypatch.setattr(buildings, "build_of", lambda program: "0123456")
    file = plan_file(tmp_path, "small", json.dumps(plan))
    assert (
        run_main(monkeypatch, program, tmp_path / "out", "--plans", file, "--every", 3, "--frames", 10) == 0
    )
    row = json.loads((tmp_path / "out" / "results.jsonl").read_text())["figures"]
    assert (row["frames"], row["maps"]) == (10, 1)
    assert row["ate_rmse_m"] < 0.05
    assert row["rooms"]["true"] == 1
    assert "| small |" in capsys.readouterr().out
