"""Whose file an atlas is saved in. A stand-in for the core takes texts that begin with ATLAS for atlases."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from vsgraphs.errors import InputError
from vsgraphs.export.lock import Locks
from vsgraphs.run.atlas_target import AtlasTarget


class Core:
    """What a target asks of the compiled module."""

    @staticmethod
    def require_writable(path: Path) -> None:
        if not path.parent.is_dir():
            raise InputError(f"cannot write {path}: there is no folder")

    @staticmethod
    def atlas_revision(path: Path) -> str | None:
        content = path.read_text() if path.is_file() else ""
        return content if content.startswith("ATLAS") else None


@dataclass
class Atlas:
    """What is saved."""

    content: str

    def save(self, path: Path, keep: int) -> str:
        if keep and path.exists():
            path.with_name(path.name + ".1").write_text(path.read_text())
        path.write_text(self.content)
        return self.content


@pytest.fixture
def house(tmp_path: Path) -> Path:
    path = tmp_path / "house.vsg"
    path.write_text("ATLAS good")
    return path


def claim(path: Path, load: Path | None = None, *, overwrite: bool = False, keep: int = 1) -> AtlasTarget:
    with Locks(print) as locks:
        return AtlasTarget.claim(Core, path, load, overwrite=overwrite, keep=keep, locks=locks)


def files(path: Path) -> dict[str, str]:
    return {entry.name: entry.read_text() for entry in path.parent.iterdir()}


def test_a_file_that_is_there_needs_overwrite(house: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError) as error:
        claim(house)
    assert str(error.value) == (
        f"{house}: is there, and this run does not start from it; give --load-atlas {house} to go on in it, "
        "another name to save in, or --overwrite"
    )
    other = tmp_path / "other.vsg"
    other.write_text("ATLAS other")
    with pytest.raises(InputError, match=rf"does not start from it but from {other}; "):
        claim(house, other)
    house.write_text("a letter")
    with pytest.raises(InputError, match="is there, and no atlas that can be read"):
        claim(house, house)
    assert claim(house, overwrite=True).save(Atlas("ATLAS new")) is None
    assert files(house)["house.vsg"] == "ATLAS new"
    assert files(house)["house.vsg.1"] == "a letter"


def test_a_run_may_replace_what_it_started_from(house: Path, tmp_path: Path) -> None:
    link, copy = tmp_path / "link.vsg", tmp_path / "copy.vsg"
    link.symlink_to(house)
    copy.write_text("ATLAS good")
    for save_to, load in ((house, house), (link, house), (house, link), (house, copy)):
        assert claim(save_to, load).started_from_it
    target = claim(house, house)
    target.loaded("ATLAS good")
    assert target.save(Atlas("ATLAS better")) is None
    assert files(house)["house.vsg"] == "ATLAS better"


def test_what_was_there_before_the_run_is_kept_however_often_it_saves(house: Path) -> None:
    target = claim(house, house)
    for number in range(3):
        assert target.save(Atlas(f"ATLAS {number}")) is None
    assert files(house) == {"house.vsg": "ATLAS 2", "house.vsg.1": "ATLAS good"}


def test_a_version_that_another_program_left_meanwhile_stays(house: Path) -> None:
    target = claim(house, house)
    target.save(Atlas("ATLAS 1"))
    house.write_text("ATLAS of somebody else")
    house.with_name("house-1.vsg").write_text("taken")
    assert target.save(Atlas("ATLAS 2")) == (
        f"{house} was changed by another program while this one ran, and is left as it is"
    )
    assert target.save(Atlas("ATLAS 3")) is None
    assert target.path == house.with_name("house-2.vsg")
    assert files(house) == {
        "house.vsg": "ATLAS of somebody else",
        "house.vsg.1": "ATLAS good",
        "house-1.vsg": "taken",
        "house-2.vsg": "ATLAS 3",
    }


def test_so_does_one_that_came_between_looking_and_loading(house: Path) -> None:
    target = claim(house, house)
    house.write_text("ATLAS newer")
    target.loaded("ATLAS newer")  # that is what the run goes on from
    assert target.save(Atlas("ATLAS 1")) is None
    assert files(house)["house.vsg.1"] == "ATLAS newer"
    target = claim(house, overwrite=True)
    house.write_text("no atlas at all")
    assert target.save(Atlas("ATLAS 2")) is not None
    assert files(house)["house.vsg"] == "no atlas at all"


def test_a_file_that_came_where_there_was_none_stays(tmp_path: Path) -> None:
    target = claim(tmp_path / "new.vsg")
    assert not target.occupied()
    (tmp_path / "new.vsg").write_text("a letter")
    assert target.occupied()
    assert target.save(Atlas("ATLAS")) is not None
    assert files(tmp_path / "x") == {"new.vsg": "a letter", "new-1.vsg": "ATLAS"}


def test_a_file_that_went_is_written_again(house: Path) -> None:
    target = claim(house, house)
    house.unlink()
    assert target.save(Atlas("ATLAS")) is None
    assert files(house) == {"house.vsg": "ATLAS"}


def test_another_program_holds_the_file(house: Path) -> None:
    with Locks(print) as locks:
        locks.hold_file(house)
        for overwrite in (False, True):
            with pytest.raises(InputError, match=r"house\.vsg: another vsgraphs writes there"):
                claim(house, house, overwrite=overwrite)
