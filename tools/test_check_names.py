"""The name check finds what it is for."""

from __future__ import annotations

from pathlib import Path

from check_names import shared_names


def test_a_name_in_two_headers_is_found_and_declarations_are_not(tmp_path: Path) -> None:
    for folder, text in (
        ("scene", "struct Opening {\n  int a;\n};\nclass Map;\n"),
        ("simulate", "class Opening {\n};\nstruct Map;\n"),
        ("map", "class Map {\n};\n"),
    ):
        (tmp_path / "core" / folder).mkdir(parents=True)
        (tmp_path / "core" / folder / "things.h").write_text(text)
    assert shared_names(tmp_path) == {"Opening": ["core/scene/things.h", "core/simulate/things.h"]}


def test_this_checkout_shares_none() -> None:
    assert shared_names(Path(__file__).resolve().parent.parent) == {}
