"""`vsgraphs config` and what the shell completes, against the real options."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import jsonschema
import pytest
import yaml

import vsgraphs
from vsgraphs.cli import completion
from vsgraphs.cli.show_config import described, explain, format_yaml, json_schema, show_config, unit_of
from vsgraphs.errors import InputError


def test_the_table_has_every_option_with_its_unit(capsys: pytest.CaptureFixture[str]) -> None:
    show_config(None, as_yaml=False)
    lines = {line.split()[0]: line for line in capsys.readouterr().out.splitlines() if line.strip()}
    for option in described():
        assert option["meaning"][:20] in lines[option["key"]]
    assert " px " in lines["tracker.search_radius_px"]
    assert " m² " in lines["scene.extraction.min_area_m2"]


@pytest.mark.parametrize(
    ("key", "unit"),
    [
        ("a.b_m", "m"),
        ("a.b_m2", "m²"),
        ("a.b_m_per_s", "m/s"),
        ("a.b_rad", "rad"),
        ("a.seed", ""),
        ("a.beam", ""),
    ],
)
def test_units_by_name(key: str, unit: str) -> None:
    assert unit_of(key) == unit


def test_explain_says_how_to_set_it(capsys: pytest.CaptureFixture[str]) -> None:
    explain("system.mode")
    out = capsys.readouterr().out
    assert "slam | bc | full" in out
    assert "--set system.mode=slam" in out
    explain("tracker.search_radius_px")
    out = capsys.readouterr().out
    for words in ("unit:                px", "default:             15", "range:               2 to 200"):
        assert words in out


@pytest.mark.parametrize(
    ("key", "near"),
    [("tracker.search_radius", "tracker.search_radius_px"), ("max_features", "orb.max_features")],
)
def test_explain_of_an_unknown_key_names_the_nearest(key: str, near: str) -> None:
    with pytest.raises(InputError, match=rf"unknown option '{key}'; did you mean '{near}'\?"):
        explain(key)


def test_a_search_without_hits_says_so() -> None:
    with pytest.raises(InputError, match=r"no option's key contains 'zzz'; `vsgraphs config` lists all"):
        show_config("zzz", as_yaml=False)


def test_the_schema_takes_what_config_takes_and_no_more() -> None:
    schema = json_schema(described())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    validator.validate(
        yaml.safe_load(format_yaml(described()))
    )  # `config --yaml`, groups and dotted keys mixed
    validator.validate({"tracker": {"keyframe": {"min_rotation_rad": 0.2}}, "system.mode": "bc"})
    for wrong in (
        {"tracker": {"serch_radius_px": 3.0}},
        {"system": {"mode": "fast"}},
        {"tracker.search_radius_px": 1e6},
        {"orb": {"max_features": 1.5}},
        {"nothing": 1},
    ):
        with pytest.raises(jsonschema.ValidationError):
            validator.validate(wrong)
    assert json.dumps(schema)


def test_the_yaml_is_what_run_reads(tmp_path: object) -> None:
    values = yaml.safe_load(format_yaml(described()))
    assert values["system"]["mode"] == vsgraphs.Config().get("system.mode")


def test_completion_of_set_and_explain() -> None:
    offered = dict(completion.assignments("tracker.sea"))
    assert list(offered) == ["tracker.search_radius_px="]
    assert offered["tracker.search_radius_px="]
    assert [v for v, _ in completion.assignments("system.mode=")] == [
        "system.mode=slam",
        "system.mode=bc",
        "system.mode=full",
    ]
    assert [v for v, _ in completion.assignments("system.realtime=t")] == ["system.realtime=true"]
    assert completion.assignments("nothing=") == []
    assert "orb.max_features" in completion.option_keys("orb")
    assert completion.config_words("exp") == ["explain"]
    assert "orb" in completion.config_words("")
    assert "tum-fr1" in completion.cameras("tum")
    assert "two_rooms" in completion.plans("two")


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("run x --out y --set orb.max_f", "orb.max_features="),
        ("config explain orb.max_f", "orb.max_features"),
        ("run x --mode b", "bc"),
        ("vi", "view"),
    ],
)
def test_the_shell_gets_its_completions(words: str, expected: str) -> None:
    """As bash asks: the program itself answers, from its environment."""
    line = f"vsgraphs {words}"
    environment = {
        **os.environ,
        "_VSGRAPHS_COMPLETE": "complete_bash",
        "COMP_WORDS": line,
        "COMP_CWORD": str(len(line.split()) - 1),
    }
    program = [
        sys.executable,
        "-c",
        "import sys; sys.argv[0] = 'vsgraphs'; import vsgraphs.cli as c; c.main()",
    ]
    done = subprocess.run(program, env=environment, capture_output=True, text=True, check=False, timeout=60)
    assert expected in done.stdout.split()
