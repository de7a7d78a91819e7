"""Where results go: --out or its default, and what an earlier run left there."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from conftest import Program, one_line_error, report
from PIL import Image

from vsgraphs.errors import InputError
from vsgraphs.run.output import remove_earlier, results_folder


@pytest.fixture(autouse=True)
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")


def names() -> list[str]:
    return sorted(path.name for path in Path().iterdir())


def take(source: Path | str) -> str:
    """The directory of a run that leaves something."""
    with results_folder(None, Path(source)) as folder:
        (folder / "run.json").touch()
    return str(folder)


def test_a_run_without_out(recorded: Path, vsgraphs: Program) -> None:
    for name in ("slide_vsgraphs", "slide_vsgraphs-2"):
        done = vsgraphs("run", recorded, "--max-frames", 3, "--mode", "slam")
        assert done.returncode == 0, done.stderr
        assert f"results in {name}: trajectory.txt keyframes.txt map.ply run.json" in done.stdout
        assert report(Path(name))["frames"] == 3
    assert names() == ["slide_vsgraphs", "slide_vsgraphs-2"]


def test_a_run_that_never_began_leaves_no_directory(recorded: Path, vsgraphs: Program) -> None:
    one_line_error(vsgraphs("run", recorded, "--mode", "magic"))
    one_line_error(vsgraphs("run", "nowhere"))
    assert names() == []


@pytest.mark.parametrize(
    ("source", "name"),
    [
        ("recordings/desk", "desk"),
        ("desk/", "desk"),
        ("my desk (2nd)", "my_desk__2nd_"),
        ("-rf", "rf"),
        (".hidden", "hidden"),
        ("küche", "küche"),
        ("a\nb", "a_b"),
        ("/", "sequence"),
        ("é" * 120, "é" * 100),
    ],
)
def test_names_are_made_safe(source: str, name: str) -> None:
    assert take(source) == f"{name}_vsgraphs"


def test_the_current_directory_has_a_name() -> None:
    assert take(".") == "here_vsgraphs"


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    Path("a_vsgraphs").touch()  # a file
    Path("a_vsgraphs-2").symlink_to(tmp_path / "gone")
    assert take("a") == "a_vsgraphs-3"
    assert Path("a_vsgraphs").read_bytes() == b""
    assert take("a") == "a_vsgraphs-4"


def test_runs_at_once_take_different_numbers() -> None:
    with ThreadPoolExecutor(8) as pool:
        folders = list(pool.map(take, ["a"] * 40))
    assert len(set(folders)) == 40


def test_a_directory_that_stays_empty_is_removed_but_not_one_that_was_named() -> None:
    with pytest.raises(InputError, match="wrong"), results_folder(None, Path("a")):
        raise InputError("wrong")
    named = Path("named")
    named.mkdir()
    with results_folder(named, Path("a")) as folder:
        assert folder == named
    assert names() == ["named"]


def test_a_place_that_cannot_be_written_to(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir("/proc")
    with pytest.raises(
        InputError, match=r"^cannot create a_vsgraphs in /proc: .*; name a directory with --out"
    ):
        take("a")


EARLIER = ("run.json", "scene_graph.json", "floorplan.svg", "trajectory.txt")


def test_an_earlier_run_s_files_are_not_mixed_with_these(tmp_path: Path) -> None:
    told: list[str] = []
    for name in (*EARLIER, "notes.txt", "house.vsg"):
        (tmp_path / name).touch()
    remove_earlier(tmp_path, ["run.json", "trajectory.txt", "map.ply"], told.append)
    left = {path.name for path in tmp_path.iterdir() if path.is_file()}
    assert left == {"run.json", "trajectory.txt", "notes.txt", "house.vsg"}
    assert "of an earlier run: floorplan.svg, scene_graph.json" in told[0]


def test_a_run_that_tracks_nothing_leaves_good_results_alone(
    sequence: Path, tmp_path: Path, vsgraphs: Program
) -> None:
    out = tmp_path / "results"
    assert vsgraphs("run", sequence, "--out", out, "--max-frames", 20).returncode == 0
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    for image in (sequence / "rgb").iterdir():  # the lens cap is on
        Image.new("RGB", Image.open(image).size).save(image)
    done = vsgraphs("run", sequence, "--out", out, "--max-frames", 20)
    assert done.returncode == 2
    assert f"the results of an earlier run in {out} stay" in done.stderr
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before
    assert json.loads((tmp_path / "results-2" / "run.json").read_text())["tracked"] == 0


def test_files_that_no_run_left_stay(tmp_path: Path) -> None:
    told: list[str] = []
    (tmp_path / "floorplan.svg").touch()
    remove_earlier(tmp_path, ["run.json"], told.append)
    assert (tmp_path / "floorplan.svg").exists()
    assert not told


def test_a_run_with_landmarks_only_into_the_directory_of_a_whole_one(
    recorded: Path, vsgraphs: Program
) -> None:
    assert vsgraphs("run", recorded, "--out", "o", "--max-frames", 3).returncode == 0
    assert Path("o/scene_graph.json").exists()
    done = vsgraphs("run", recorded, "--out", "o", "--max-frames", 3, "--mode", "slam")
    assert done.returncode == 0, done.stderr
    assert "removed from o, of an earlier run: floorplan.svg" in done.stderr
    assert "results in o: trajectory.txt" in done.stdout
    assert not Path("o/scene_graph.json").exists()
