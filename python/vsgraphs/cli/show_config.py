"""`vsgraphs config`: every option with its default, range and meaning."""

from __future__ import annotations

from typing import Any

from vsgraphs.errors import InputError


def show_config(search: str | None, *, as_yaml: bool) -> None:
    """Prints a table, or YAML that `vsgraphs run --config` reads."""
    from vsgraphs.compiled import core

    options = core().Config().describe()
    if search:
        options = [option for option in options if search.lower() in option["key"].lower()]
        if not options:
            raise InputError(f"no option's key contains '{search}'; `vsgraphs config` lists all")
    if as_yaml:
        print(format_yaml(options))
    else:
        _print_table(options)


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


def _print_table(options: list[dict[str, Any]]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table("option", "default", "range", "meaning", box=None, header_style="bold")
    for option in options:
        table.add_row(option["key"], _text(option["default"]), _range(option, ""), option["meaning"])
    console = Console()
    if not console.is_terminal:  # in a pipe nobody sees the width: keep each option on a line
        console = Console(width=240)
    console.print(table)


def _range(option: dict[str, Any], before: str) -> str:
    if option.get("allowed"):
        return before + " | ".join(str(value) for value in option["allowed"])
    if isinstance(option["default"], bool | str) or option.get("minimum") is None:
        return ""
    return f"{before}{option['minimum']:g} to {option['maximum']:g}"


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else (str(value) or '""')
