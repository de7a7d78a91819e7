"""`vsgraphs config`: every option with default, unit, range and meaning; one explained; the files' schema."""

from __future__ import annotations

import json
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.run.settings import unknown_key

# What names end with -> unit for people. Longest first: _m2 is no _m.
_UNITS = (
    ("_m_per_s", "m/s"),
    ("_rad_per_s", "rad/s"),
    ("_m2", "m²"),
    ("_deg", "°"),
    ("_rad", "rad"),
    ("_px", "px"),
    ("_share", "share"),
    ("_sigmas", "sigma"),
    ("_ms", "ms"),
    ("_m", "m"),
    ("_s", "s"),
)


def show_config(search: str | None, *, as_yaml: bool, as_schema: bool = False) -> None:
    """Prints a table, YAML that `vsgraphs run --config` reads, or the JSON schema of such files."""
    options = described()
    if search:
        options = [option for option in options if search.lower() in option["key"].lower()]
        if not options:
            known = [option["key"] for option in described()]
            raise InputError(
                f"no option's key contains '{search}'; {unknown_key(search, known).partition('; ')[2]}"
            )
    if as_yaml:
        print(format_yaml(options))
    elif as_schema:
        print(json.dumps(json_schema(options), indent=1, ensure_ascii=False))
    else:
        _print_table(options)


def explain(key: str) -> None:
    """Prints all that is known of one option. Raises InputError naming the nearest key."""
    options = {option["key"]: option for option in described()}
    if key not in options:
        raise InputError(unknown_key(key, list(options)))
    option = options[key]
    rows = {
        "meaning": option["meaning"],
        "type": {"bool": "true or false", "int": "whole number", "float": "number", "str": "text"}[
            option["type"]
        ],
        "unit": unit_of(key),
        "default": _text(option["default"]),
        "range": _range(option, ""),
        "set it": f"vsgraphs run FOLDER --out DIR --set {key}={_example(option)}",
        "or in --config FILE": f"{key}: {_example(option)}",
    }
    print(key)
    for name, value in rows.items():
        if value:
            print(f"  {name + ':':<21}{value}")


def described() -> list[dict[str, Any]]:
    """Every option as the core describes it."""
    from vsgraphs.compiled import core

    options: list[dict[str, Any]] = core().Config().describe()
    return options


def unit_of(key: str) -> str:
    """The unit that a key's name ends with; "" where it has none."""
    return next((unit for ending, unit in _UNITS if key.endswith(ending)), "")


def format_yaml(options: list[dict[str, Any]]) -> str:
    """The options at their defaults, grouped, each with its meaning as a comment."""
    lines: list[str] = []
    group = ""
    for option in sorted(options, key=lambda option: option["key"].partition(".")[0]):
        head, _, name = option["key"].partition(".")
        if head != group:
            lines.append(f"{head}:")
            group = head
        lines.append(f"  {name}: {_text(option['default'])}  # {option['meaning']}{_range(option, '; ')}")
    return "\n".join(lines)


def json_schema(options: list[dict[str, Any]]) -> dict[str, Any]:
    """JSON Schema (2020-12) of the files that `run --config` reads: groups, dotted keys, or both."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Options of vsgraphs",
        **_group({option["key"]: _property(option) for option in options}),
    }


def _group(properties: dict[str, Any]) -> dict[str, Any]:
    """The schema of a mapping: its options by their dotted names, and what they have in common as groups."""
    heads = dict.fromkeys(key.partition(".")[0] for key in properties if "." in key)
    groups = {
        head: _group({k.partition(".")[2]: v for k, v in properties.items() if k.startswith(f"{head}.")})
        for head in heads
    }
    return {"type": "object", "additionalProperties": False, "properties": {**groups, **properties}}


def _property(option: dict[str, Any]) -> dict[str, Any]:
    kinds = {"bool": "boolean", "int": "integer", "float": "number", "str": "string"}
    unit = unit_of(option["key"])
    out = {
        "type": kinds[option["type"]],
        "default": option["default"],
        "description": option["meaning"] + (f" [{unit}]" if unit else ""),
    }
    if option["allowed"]:
        out["enum"] = list(option["allowed"])
    elif option["minimum"] is not None:
        whole = option["type"] == "int"
        out["minimum"], out["maximum"] = (
            int(option[end]) if whole else option[end] for end in ("minimum", "maximum")
        )
    return out


def _print_table(options: list[dict[str, Any]]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table("option", "default", "unit", "range", "meaning", box=None, header_style="bold")
    for option in options:
        unit = unit_of(option["key"])
        table.add_row(option["key"], _text(option["default"]), unit, _range(option, ""), option["meaning"])
    console = Console()
    if not console.is_terminal:  # in a pipe nobody sees the width: keep each option on a line
        console = Console(width=250)
    console.print(table)


def _range(option: dict[str, Any], before: str) -> str:
    if option.get("allowed"):
        return before + " | ".join(str(value) for value in option["allowed"])
    if isinstance(option["default"], bool | str) or option.get("minimum") is None:
        return ""
    return f"{before}{option['minimum']:.10g} to {option['maximum']:.10g}"


def _example(option: dict[str, Any]) -> str:
    """A value that is allowed and not the default, where one is easily found."""
    if option["allowed"]:
        return str(next((v for v in option["allowed"] if v != option["default"]), option["default"]))
    if option["type"] == "bool":
        return _text(not option["default"])
    if option["type"] == "str":
        return "FILE"
    return _text(option["default"])


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else (str(value) or '""')
