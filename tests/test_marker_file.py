"""The marker file: what is read, and that each mistake is one line which names the key."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from vsgraphs.errors import InputError
from vsgraphs.markers import DICTIONARIES, NamedMarker, load_markers

Values = dict[str, Any]


def values() -> Values:
    return {
        "dictionary": "4x4_50",
        "size_m": 0.16,
        "markers": {
            "7": {"name": "kitchen", "kind": "room"},
            "3": {"name": "front door", "kind": "door", "size_m": 0.1},
        },
    }


def load(tmp_path: Path, content: Values | str) -> Any:
    file = tmp_path / "markers.json"
    file.write_text(content if isinstance(content, str) else json.dumps(content))
    return load_markers(file)


def test_names_kinds_and_sizes(tmp_path: Path) -> None:
    registry = load(tmp_path, values())
    assert registry.dictionary == "4x4_50"
    assert registry.markers == {
        3: NamedMarker("front door", "door", 0.1),
        7: NamedMarker("kitchen", "room", 0.16),
    }
    assert (registry.size_of(3), registry.size_of(7), registry.size_of(49)) == (0.1, 0.16, 0.16)


def change(path: str, value: Any) -> Callable[[Values], None]:
    """Sets, or with `...` deletes, what stands at a dotted path."""

    def apply(document: Values) -> None:
        *way, last = path.split(".")
        for key in way:
            document = document[key]
        if value is ...:
            del document[last]
        else:
            document[last] = value

    return apply


@pytest.mark.parametrize(
    ("path", "value", "complaint"),
    [
        ("dictionary", ..., '"dictionary" is missing'),
        ("size_m", ..., '"size_m" is missing'),
        ("markers", ..., '"markers" is missing'),
        (
            "dictionary",
            "4x4_5",
            "dictionary: unknown dictionary '4x4_5'; did you mean '4x4_50'? known: 4x4_50,",
        ),
        ("dictionary", 5, "dictionary: unknown dictionary 5; known: 4x4_50"),
        ("size_m", 0, "size_m: expected the black square's side in metres, not 0"),
        ("size_m", 160, "size_m: expected the black square's side in metres, not 160"),
        ("size_m", True, "size_m: expected"),
        ("size_m", "0.16", "size_m: expected"),
        ("size", 0.16, "size: unknown key; did you mean 'size_m'?"),
        ("markers", [], "markers: expected an object"),
        (
            "markers.50",
            {"name": "x", "kind": "room"},
            "markers.50: no marker of 4x4_50, whose ids are 0 to 49",
        ),
        ("markers.-1", {"name": "x", "kind": "room"}, "markers.-1: no marker of 4x4_50"),
        ("markers.seven", {"name": "x", "kind": "room"}, "markers.seven: no marker of 4x4_50"),
        ("markers.07", {"name": "x", "kind": "room"}, "markers.07: marker 7 is there twice"),
        ("markers.7", "kitchen", "markers.7: expected an object, not 'kitchen'"),
        (
            "markers.7.kind",
            "rom",
            "markers.7.kind: unknown kind 'rom'; did you mean 'room'? known: room, corridor, door",
        ),
        ("markers.7.kind", ..., 'markers.7: "kind" is missing'),
        ("markers.7.name", ..., 'markers.7: "name" is missing'),
        ("markers.7.name", "  ", "markers.7.name: expected a name"),
        ("markers.7.name", 7, "markers.7.name: expected a name, not 7"),
        ("markers.7.size_m", -1, "markers.7.size_m: expected"),
        ("markers.7.colour", "red", "markers.7.colour: unknown key; known: name, kind, size_m"),
    ],
)
def test_mistakes_name_file_and_key(tmp_path: Path, path: str, value: Any, complaint: str) -> None:
    document = values()
    change(path, value)(document)
    with pytest.raises(InputError) as error:
        load(tmp_path, document)
    text = str(error.value)
    assert text.startswith(str(tmp_path / "markers.json"))
    assert complaint in text
    assert "\n" not in text


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("{", "not valid JSON"),
        ("[]", "expected an object, not []"),
        ('{"markers": {"7": 1, "7": 2}}', '"7" is there twice'),
        ("[" * 100_000, "not valid JSON"),
        ('{"dictionary": "4x4_50", "size_m": NaN, "markers": {}}', ":1: NaN is no number"),
    ],
)
def test_files_that_are_none(tmp_path: Path, text: str, complaint: str) -> None:
    with pytest.raises(InputError) as error:
        load(tmp_path, text)
    assert complaint in str(error.value)


def test_missing_and_binary_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read marker file .*none\.json: No such file"):
        load_markers(tmp_path / "none.json")
    (tmp_path / "binary.json").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="not text"):
        load_markers(tmp_path / "binary.json")


def test_every_dictionary_is_opencvs() -> None:
    cv2 = pytest.importorskip("cv2")
    for name, count in DICTIONARIES.items():
        dictionary = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, f"DICT_{name.upper()}"))
        assert len(dictionary.bytesList) == count, name
