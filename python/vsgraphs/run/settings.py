"""From the command line and a YAML file to the core's Config. Errors say file, line, key and the nearest
key.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vsgraphs.errors import InputError
from vsgraphs.reading import YamlNode, plain_value, read_yaml, shortened, shown

if TYPE_CHECKING:
    from vsgraphs.run.request import RunRequest

Value = bool | int | float | str


def make_config(core: Any, request: RunRequest, *, live: bool = False) -> Any:
    """The core's Config: defaults, then the file, then the options, then those with keywords of their own.

    live: the source is a camera, for which nothing waits unless `request` says otherwise.
    """
    config = core.Config()
    if request.config is not None:
        apply_file(config, Path(request.config))
    if isinstance(request.options, Mapping):
        apply_values(config, request.options)
    else:
        apply_assignments(config, request.options)
    shortcuts = request.shortcuts()
    apply_shortcuts(config, {"system.realtime": True, **shortcuts} if live else shortcuts)
    return config


def apply_file(config: Any, path: Path) -> None:
    """Sets every option of a YAML file (nested mappings or dotted keys) on a `vsgraphs.Config`."""
    node = read_yaml(path, "configuration")
    if node is None:
        return
    seen: dict[str, int] = {}
    for key, leaf, line in _leaves(node, "", node.line, str(path)):
        if key in seen:
            raise InputError(f"{path}:{line}: {shown(key)} is there twice, first in line {seen[key]}")
        seen[key] = line
        _set(config, key, str(leaf.value), f"{path}:{line}", quoted=leaf.quoted)


def apply_assignments(config: Any, assignments: Iterable[str]) -> None:
    """Sets `key=value` options given on the command line; values are read as in a file."""
    for assignment in assignments:
        key, equals, text = assignment.partition("=")
        if not equals or not key.strip():
            raise InputError(
                f"--set {shortened(assignment)}: expected KEY=VALUE, e.g. --set tracker.max_features=1200"
            )
        _set(config, key.strip(), text.strip(), f"--set {shortened(assignment)}")


def apply_values(config: Any, values: Mapping[str, Value]) -> None:
    """Sets options given as {key: value}; texts are taken as they are."""
    for key, value in values.items():
        _set(config, key, value, "options", quoted=True)


def apply_shortcuts(config: Any, shortcuts: dict[str, Value]) -> None:
    """Sets options that have a command-line option of their own (--seed, --execution, ...)."""
    for key, value in shortcuts.items():
        _set(config, key, value, f"--{key.partition('.')[2].replace('_', '-')} {shortened(str(value))}")


def _set(config: Any, key: str, value: Value, where: str, *, quoted: bool = False) -> None:
    known = config.keys()
    if key not in known:
        raise InputError(f"{where}: {unknown_key(key, known)}")
    current = config.get(key)
    if isinstance(value, str) and not isinstance(current, str) and not quoted:
        value = plain_value(value)
    if isinstance(value, str) and not _is_text(value):
        raise InputError(f"{where}: holds bytes that are no text (UTF-8); give the file another name")
    try:
        config.set(key, _as_expected(value, current))
    except ValueError as error:  # the core's InputError: type or range
        raise InputError(f"{where}: {error}") from None


def _is_text(value: str) -> bool:
    try:
        value.encode("utf-8")
    except UnicodeEncodeError:
        return False
    return True


def _as_expected(value: Value, current: Value) -> Value:
    """An int where a float is expected is one; a whole number that no option holds is out of any range."""
    if isinstance(value, bool) or not isinstance(value, int):
        return value
    if not -(2**63) <= value < 2**63:
        return math.inf if value > 0 else -math.inf
    return float(value) if isinstance(current, float) else value


def unknown_key(key: str, known: list[str]) -> str:
    """The message for a key that does not exist: names the nearest one."""
    near = get_close_matches(key, known, n=1, cutoff=0.5)
    if not near:  # a right name under a wrong group
        last = key.rpartition(".")[2]
        near = get_close_matches(last, [k.rpartition(".")[2] for k in known], n=1, cutoff=0.6)
        near = [k for k in known if near and k.rpartition(".")[2] == near[0]][:1]
    hint = f"did you mean '{near[0]}'?" if near else "`vsgraphs config` lists all"
    return f"unknown option {shown(key)}; {hint}"


def _leaves(node: YamlNode, prefix: str, line: int, source: str) -> Iterator[tuple[str, YamlNode, int]]:
    """(dotted key, its word, line) of every leaf of a file."""
    if isinstance(node.value, dict):
        for key, value in node.value.items():
            dotted = f"{prefix}.{key}" if prefix else key
            yield from _leaves(value, dotted, node.lines.get(key, value.line), source)
    elif isinstance(node.value, list):
        what = shortened(prefix) if prefix else "the document"
        raise InputError(f"{source}:{line}: {what} is a list; options are single values")
    elif not prefix:
        raise InputError(f"{source}:{line}: expected lines like 'tracker:' or 'key: value'")
    else:
        yield prefix, node, line
