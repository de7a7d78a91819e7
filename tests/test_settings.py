from __future__ import annotations

from pathlib import Path

import pytest
from fake_core import Config

from vsgraphs.errors import InputError
from vsgraphs.reading import plain_value
from vsgraphs.run.settings import apply_assignments, apply_file, apply_shortcuts


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "fast.yaml"
    path.write_text(text)
    return path


def test_file_nested_or_dotted(tmp_path: Path) -> None:
    config = Config()
    text = "# mine\ntracker:\n  max_features: 500\n  huber_px: 3\n"
    text += "mapper.enabled: false\nsystem: {execution: serial}\n"
    apply_file(config, written(tmp_path, text))
    assert config.values == {
        "system.seed": 0,
        "system.mode": "slam",
        "system.realtime": False,
        "system.execution": "serial",
        "system.replay": "",
        "tracker.max_features": 500,
        "tracker.huber_px": 3.0,
        "mapper.enabled": False,
    }


def test_empty_file_changes_nothing(tmp_path: Path) -> None:
    config = Config()
    apply_file(config, written(tmp_path, "# nothing\n"))
    assert config.values == Config().values


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "tracker:\n  max_feature: 5\n",
            r"fast\.yaml:2: unknown option 'tracker.max_feature'; did you mean 'track",
        ),
        ("a: 1\ntracer.max_features: 5\n", r"fast\.yaml:1: unknown option 'a'; `vsgraphs config` lists all"),
        (
            "mapper:\n  max_features: 5\n",
            r"yaml:2: unknown option 'mapper.max_features'; did you mean 'tracker.max_f",
        ),
        ("tracker:\n\n\n  huber_px: [1, 2]\n", r"fast\.yaml:4: tracker.huber_px is a list"),
        ("tracker:\n  huber_px: -1\n", r"fast\.yaml:2: tracker.huber_px: -1.0 is out of range, 0 to"),
        ("tracker:\n  max_features: many\n", r"fast\.yaml:2: tracker.max_features: expected int, not 'many'"),
        ("tracker:\n  max_features: 3.5\n", r"fast\.yaml:2: tracker.max_features: expected int"),
        ("tracker: {a\n", r"fast\.yaml:\d: not valid YAML"),
        ("max_features\n", r"expected lines like 'tracker:' or 'key: value'"),
        ("- 1\n", r"the document is a list"),
    ],
)
def test_mistakes_in_a_file_name_line_and_cure(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        apply_file(Config(), written(tmp_path, text))


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read configuration .*: No such file"):
        apply_file(Config(), tmp_path / "none.yaml")


def test_assignments() -> None:
    config = Config()
    apply_assignments(config, ["tracker.max_features=800", "tracker.huber_px = 1e1", "mapper.enabled=False"])
    assert config.get("tracker.max_features") == 800
    assert config.get("tracker.huber_px") == 10.0
    assert config.get("mapper.enabled") is False
    with pytest.raises(InputError, match="expected KEY=VALUE"):
        apply_assignments(config, ["tracker.max_features"])
    with pytest.raises(InputError, match=r"--set sistem.seed=3: .* did you mean 'system.seed'"):
        apply_assignments(config, ["sistem.seed=3"])


def test_shortcuts_name_their_option() -> None:
    config = Config()
    apply_shortcuts(config, {"system.seed": 7, "system.execution": "serial"})
    assert config.get("system.seed") == 7
    with pytest.raises(InputError, match=r"--seed -1: system.seed: -1 is out of range"):
        apply_shortcuts(config, {"system.seed": -1})


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("true", True),
        ("False", False),
        ("3", 3),
        ("-2.5", -2.5),
        ("1e-3", 0.001),
        ("serial", "serial"),
        ("", ""),
    ],
)
def test_values(text: str, value: object) -> None:
    assert plain_value(text) == value
    assert type(plain_value(text)) is type(value)
