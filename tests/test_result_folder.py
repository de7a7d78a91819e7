from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import fake_core
import pytest

from vsgraphs.errors import InputError
from vsgraphs.export.atomic import remove_unfinished, write_atomically
from vsgraphs.run.atlas_files import AtlasFiles
from vsgraphs.run.atlas_target import AtlasTarget
from vsgraphs.run.ending import AtlasSaver
from vsgraphs.run.result_folder import ResultFolder, Write, new_folder_beside

NAMES = ("a.txt", "b.txt", "c.txt")


def file(name: str, before: Callable[[], object] = lambda: None) -> tuple[str, Write]:
    def write(folder: Path) -> None:
        before()
        write_atomically(folder / name, f"{name}\n")

    return name, write


class Folder:
    """A result folder and what it said."""

    def __init__(self, out: Path) -> None:
        out.mkdir(parents=True)
        self.said: list[str] = []
        self.shown: list[str] = []
        self.results = ResultFolder(out, NAMES, self.said.append)

    def write(self, *files: tuple[str, Write]) -> None:
        self.results.write(files, self.shown.append)


def names_in(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_all_is_written(tmp_path: Path) -> None:
    made = Folder(tmp_path / "out")
    made.write(*map(file, NAMES))
    assert names_in(tmp_path / "out") == list(NAMES)
    assert made.shown == [f"writing {name}" for name in NAMES]
    assert (made.said, made.results.warnings, made.results.failure()) == ([], [], None)


def test_a_folder_that_went_away_is_replaced_by_one_beside_it(tmp_path: Path) -> None:
    out = tmp_path / "out"
    (tmp_path / "out-2").mkdir()  # taken
    made = Folder(out)
    made.write(file("a.txt"), file("b.txt", lambda: shutil.rmtree(out, ignore_errors=True)), file("c.txt"))
    assert made.results.folder == tmp_path / "out-3"
    assert names_in(tmp_path / "out-3") == list(NAMES)
    assert not out.exists()
    assert names_in(tmp_path / "out-2") == []
    assert made.results.failure() is None
    assert made.said == [f"warning: {made.results.warnings[0]}"]
    assert "cannot write" in made.said[0]
    assert "No such file or directory; the results are in" in made.said[0]


def test_a_folder_whose_name_is_another_s_now_too(tmp_path: Path) -> None:
    out = tmp_path / "out"
    made = Folder(out)
    out.rmdir()
    out.write_text("a file")
    made.write(*map(file, NAMES))
    assert names_in(tmp_path / "out-2") == list(NAMES)
    assert out.read_text() == "a file"


def test_the_working_directory_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    said: list[str] = []
    results = ResultFolder(Path(), NAMES, said.append)
    (tmp_path / "here").rmdir()
    results.write([file("a.txt")], said.append)
    assert names_in(tmp_path / "here-2") == ["a.txt"]


def full_disk(monkeypatch: pytest.MonkeyPatch, is_full: Callable[[str], bool]) -> None:
    """A disk on which files of some names cannot be written."""
    fsync = os.fsync

    def full(descriptor: int) -> None:
        if is_full(str(Path(f"/proc/self/fd/{descriptor}").readlink())):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        fsync(descriptor)

    monkeypatch.setattr(os, "fsync", full)


def test_on_a_full_disk_what_can_be_written_is_and_the_rest_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = Folder(tmp_path / "out")
    full_disk(monkeypatch, lambda name: ".a.txt" in name or ".b.txt" in name)
    made.write(*map(file, NAMES))
    assert names_in(tmp_path) == ["out"]  # no second folder where nothing could be written
    assert names_in(tmp_path / "out") == ["c.txt"]
    failure = made.results.failure()
    assert isinstance(failure, InputError)
    assert str(failure) == (
        f"cannot write {tmp_path / 'out' / 'a.txt'}: No space left on device, nor b.txt; written: c.txt"
    )
    assert not made.results.warnings


def test_where_the_disk_beside_has_room_everything_is_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = Folder(tmp_path / "out")
    full_disk(monkeypatch, lambda name: "/out/.b.txt" in name)
    made.write(*map(file, NAMES))
    assert made.results.failure() is None
    assert names_in(tmp_path / "out-2") == list(NAMES)


def test_what_cannot_be_written_again_is_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = Folder(tmp_path / "out")
    full_disk(monkeypatch, lambda name: "/out/.b.txt" in name or "/out-2/.a.txt" in name)
    made.write(*map(file, NAMES))
    assert made.results.failure() is None
    assert names_in(tmp_path / "out-2") == ["b.txt", "c.txt"]
    assert made.results.warnings[-1] == f"a.txt is in {tmp_path / 'out'}"


def test_nothing_at_all(tmp_path: Path) -> None:
    made = Folder(tmp_path / "deep" / "out")
    shutil.rmtree(tmp_path / "deep")
    (tmp_path / "deep").write_text("a file: no folder can be made in it")
    made.write(*map(file, NAMES))
    assert "nor b.txt, c.txt; nothing was written" in str(made.results.failure())


def test_a_defect_in_one_file_costs_no_other(tmp_path: Path) -> None:
    def broken() -> None:
        raise ZeroDivisionError

    made = Folder(tmp_path / "out")
    made.write(file("a.txt", broken), file("b.txt"))
    assert names_in(tmp_path / "out") == ["b.txt"]
    assert isinstance(made.results.failure(), ZeroDivisionError)
    assert names_in(tmp_path) == ["out"]


def test_last_words_tell_what_is_there_at_any_time(tmp_path: Path) -> None:
    made = Folder(tmp_path / "out")
    assert made.results.last_words() == "nothing was written; not written: a.txt, b.txt, c.txt"
    made.write(file("a.txt"), file("b.txt"))
    assert made.results.last_words() == f"written in {tmp_path / 'out'}: a.txt, b.txt; not written: c.txt"


def test_numbers_of_folders(tmp_path: Path) -> None:
    assert [new_folder_beside(tmp_path / "x").name for _ in range(3)] == ["x-2", "x-3", "x-4"]
    assert new_folder_beside(tmp_path / "gone" / "x").is_dir()


def test_a_process_that_ends_amid_a_file_leaves_the_old_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.txt"
    path.write_text("old")
    monkeypatch.setattr(os, "fsync", lambda _: remove_unfinished())
    with pytest.raises(InputError):
        write_atomically(path, "new")
    assert path.read_text() == "old"
    assert names_in(tmp_path) == ["a.txt"]


class Core:
    """Of the core, what an atlas is saved with."""

    def atlas_revision(self, path: Path) -> str | None:
        return path.read_text() if path.exists() else None


class Map:
    """Like vsgraphs.Atlas."""

    def __init__(self, keyframes: int) -> None:
        self.empty = keyframes == 0

    def save(self, path: Path, keep: int) -> str:
        write_atomically(path, "atlas")
        return "atlas"

    def info(self) -> dict[str, int]:
        return {"maps": 1, "keyframes": 3, "landmarks": 4, "rooms": 0}


def atlas_files(save_to: Path, keyframes: int = 3) -> AtlasFiles:
    files = AtlasFiles(target=AtlasTarget(Core(), save_to, 0))
    files._make = lambda _: Map(keyframes)
    return files


def test_an_atlas_that_cannot_be_saved_is_saved_with_the_results(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "house.vsg").write_text("another one")
    atlas, said = atlas_files(tmp_path / "gone" / "house.vsg"), []
    saver = AtlasSaver(atlas, fake_core.Slam(), said.append)
    saver.write(out)
    assert (out / "house-1.vsg").read_text() == "atlas"
    assert (out / "house.vsg").read_text() == "another one"
    assert "the atlas is in" in atlas.warnings[0]
    assert said == [f"warning: {atlas.warnings[0]}"]
    saver.write(tmp_path)  # the results moved: it is safe where it is
    assert atlas.save_to == out / "house-1.vsg"
    assert not (tmp_path / "house.vsg").exists()


def test_an_atlas_within_results_that_moved_moves_too(tmp_path: Path) -> None:
    out, beside = tmp_path / "out", tmp_path / "out-2"
    atlas = atlas_files(out / "house.vsg")
    saver = AtlasSaver(atlas, fake_core.Slam(), print)
    with pytest.raises(InputError):
        saver.write(out)
    beside.mkdir()
    saver.write(beside)
    assert names_in(beside) == ["house.vsg"]


def test_an_empty_map_is_not_worth_another_file(tmp_path: Path) -> None:
    saver = AtlasSaver(atlas_files(tmp_path / "gone" / "a.vsg", keyframes=0), fake_core.Slam(), print)
    with pytest.raises(InputError):
        saver.write(tmp_path)
    assert names_in(tmp_path) == []
