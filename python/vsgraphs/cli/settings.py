"""From the command line and a YAML file to the core's Config. Errors say file, line, key and the nearest
key.
"""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from vsgraphs.errors import InputError

Value = bool | int | float | str


def apply_file(config: Any, path: Path) -> None:
    """Sets every option of a YAML file (nested mappings or dotted keys) on a `vsgraphs.Config`."""
    for key, value, line in _leaves(_compose(path), ""):
        _set(config, key, value, f"{path}:{line}")


def apply_assignments(config: Any, assignments: list[str]) -> None:
    """Sets `key=value` options given on the command line; values are read as YAML reads them."""
    for assignment in assignments:
        key, equals, text = assignment.partition("=")
        if not equals or not key.strip():
            raise InputError(f"--set {assignment}: expected KEY=VALUE, e.g. --set tracker.max_features=1200")
        _set(config, key.strip(), parse_value(text.strip()), f"--set {assignment}")


def apply_shortcuts(config: Any, shortcuts: dict[str, Value]) -> None:
    """Sets options that have a command-line option of their own (--seed, --execution, ...)."""
    for key, value in shortcuts.items():
        _set(config, key, value, f"--{key.partition('.')[2].replace('_', '-')} {value}")


def parse_value(text: str) -> Value:
    """'true' -> True, '3' -> 3, '1e-3' -> 0.001, anything else stays text."""
    lowered = text.lower()
    if lowered in ("true", "false"):
        return lowered == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _set(config: Any, key: str, value: Value, where: str) -> None:
    known = config.keys()
    if key not in known:
        raise InputError(f"{where}: {unknown_key(key, known)}")
    try:
        config.set(key, _as_expected(value, config.get(key)))
    except ValueError as error:  # the core's InputError: type or range
        raise InputError(f"{where}: {error}") from None


def _as_expected(value: Value, current: Value) -> Value:
    """An int where a float is expected is one; a number where a text is expected (a file called 7) is
    text.
    """
    if isinstance(current, float) and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if isinstance(current, str) and not isinstance(value, str):
        return str(value)
    return value


def unknown_key(key: str, known: list[str]) -> str:
    """The message for a key that does not exist: names the nearest one."""
    near = get_close_matches(key, known, n=1, cutoff=0.5)
    if not near:  # a right name under a wrong group
        last = key.rpartition(".")[2]
        near = get_close_matches(last, [k.rpartition(".")[2] for k in known], n=1, cutoff=0.6)
        near = [k for k in known if near and k.rpartition(".")[2] == near[0]][:1]
    hint = f"did you mean '{near[0]}'?" if near else "`vsgraphs config` lists all"
    return f"unknown option '{key}'; {hint}"


def _compose(path: Path) -> Any:
    import yaml

    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"cannot read configuration {path}: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise InputError(f"configuration {path} is not text; expected YAML") from None
    try:
        return yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f":{mark.line + 1}" if mark else ""
        raise InputError(
            f"{path}{where}: not valid YAML ({getattr(error, 'problem', None) or error})"
        ) from None


def _leaves(node: Any, prefix: str) -> Iterator[tuple[str, Value, int]]:
    """(dotted key, value, line) of every leaf of a YAML document's node tree, which still knows its lines."""
    import yaml

    if node is None:
        return
    line = node.start_mark.line + 1
    if isinstance(node, yaml.MappingNode):
        for key_node, value_node in node.value:
            key = f"{prefix}.{key_node.value}" if prefix else str(key_node.value)
            yield from _leaves(value_node, key)
    elif isinstance(node, yaml.ScalarNode):
        if not prefix:
            raise InputError(f"{node.start_mark.name}:{line}: expected lines like 'tracker:' or 'key: value'")
        quoted = node.style in ("'", '"')
        yield prefix, node.value if quoted else parse_value(node.value), line
    else:
        raise InputError(f"line {line}: {prefix or 'the document'} is a list; options are single values")
