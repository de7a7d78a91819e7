"""YAML as far as options and cameras need it: mappings, lists, words and numbers.

No value is made by a tag (no dates, no objects), and aliases are never multiplied out: a file of 400 bytes
can stand for a terabyte.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.reading.files import read_text
from vsgraphs.reading.shown import shortened

YAML_LIMIT = 1_000_000  # bytes of a file
_DEEPEST = 32
_MOST = 20_000  # values, those that aliases stand for included
_TAGS = "tag:yaml.org,2002:"
_NAMED = {".inf": "inf", "-.inf": "-inf", ".nan": "nan"}  # as YAML writes what Python writes without the dot
# Tags that say what we would read anyway.
_NEEDLESS = frozenset(_TAGS + name for name in ("map", "seq", "int", "float", "bool", "null"))


@dataclass
class YamlNode:
    """A mapping, a list or a word. lines: of a mapping's keys; size: the values it stands for, itself too."""

    value: str | list[YamlNode] | dict[str, YamlNode]
    line: int
    tag: str = ""
    quoted: bool = False
    lines: dict[str, int] = field(default_factory=dict)
    size: int = 1

    def plain(self) -> Any:
        """As Python's values: dict, list, str, bool, int, float, None."""
        if isinstance(self.value, dict):
            return {key: node.plain() for key, node in self.value.items()}
        if isinstance(self.value, list):
            return [node.plain() for node in self.value]
        if not self.quoted and self.value in ("", "~", "null", "Null", "NULL"):
            return None
        return self.value if self.quoted else plain_value(self.value)


def plain_value(text: str) -> bool | int | float | str:
    """'true' -> True, '3' -> 3, '1e-3' -> 0.001, anything else stays text. Beyond 64 bits a float."""
    lowered = text.lower()
    if lowered in ("true", "false"):
        return lowered == "true"
    try:
        if -(2**63) <= (whole := int(text)) < 2**63:
            return whole
    except ValueError:  # no whole number, or one of more digits than Python reads
        pass
    try:
        return float(_NAMED.get(lowered.lstrip("+"), text))
    except ValueError:
        return text


def read_yaml(
    path: Path, purpose: str, *, expected: str = "YAML", unique: bool = True, tags: Collection[str] = ()
) -> YamlNode | None:
    """What a YAML file holds, None where it is empty. Raises InputError: one line, the file, where it can the
    line.

    unique: the same key twice in one mapping is a mistake. tags: those whose nodes keep their tag; any other
    is a mistake.
    """
    text = read_text(path, purpose, YAML_LIMIT, expected=expected)
    return parse_yaml(text, str(path), unique=unique, tags=tags)


def parse_yaml(text: str, source: str, *, unique: bool = True, tags: Collection[str] = ()) -> YamlNode | None:
    """As `read_yaml`, of a text; `source` names it in messages."""
    import yaml

    builder = _Builder(shortened(source, 300), unique, tags)
    try:
        for event in yaml.parse(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
            builder.take(event)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = mark.line + 1 if mark else text.count("\n", 0, getattr(error, "position", 0)) + 1
        reason = getattr(error, "problem", None) or getattr(error, "reason", None) or "broken"
        raise InputError(f"{builder.source}:{line}: not valid YAML ({shortened(str(reason))})") from None
    return builder.root


class _Builder:
    """Events to nodes, without recursion."""

    def __init__(self, source: str, unique: bool, tags: Collection[str]) -> None:
        self.source = source
        self.root: YamlNode | None = None
        self._unique = unique
        self._tags = tags
        self._open: list[YamlNode] = []
        self._keys: list[YamlNode | None] = []  # of each open node: the key whose value comes next
        self._anchors: dict[str, YamlNode] = {}

    def take(self, event: Any) -> None:
        """The next event of the parser."""
        import yaml

        line = event.start_mark.line + 1
        if isinstance(event, yaml.DocumentStartEvent) and self.root is not None:
            raise self._wrong(line, "a second document begins ('---'); one is read")
        if isinstance(event, yaml.AliasEvent):
            self._add(self._meant(str(event.anchor), line), line)
        elif isinstance(event, yaml.ScalarEvent):
            tag = self._tag(event.tag, line)
            quoted = event.style in ("'", '"', "|", ">") or event.tag in ("!", _TAGS + "str")
            self._begin(event, YamlNode(event.value, line, tag, quoted))
            self._end(line)
        elif isinstance(event, yaml.CollectionStartEvent):
            empty: list[YamlNode] | dict[str, YamlNode] = (
                {} if isinstance(event, yaml.MappingStartEvent) else []
            )
            self._begin(event, YamlNode(empty, line, self._tag(event.tag, line)))
        elif isinstance(event, yaml.CollectionEndEvent):
            self._end(line)

    def _begin(self, event: Any, node: YamlNode) -> None:
        if len(self._open) >= _DEEPEST:
            raise self._wrong(node.line, f"nested deeper than {_DEEPEST} levels")
        if event.anchor:
            self._anchors[event.anchor] = node
        self._open.append(node)
        self._keys.append(None)

    def _end(self, line: int) -> None:
        node = self._open.pop()
        self._keys.pop()
        self._add(node, node.line if isinstance(node.value, str) else line)

    def _add(self, node: YamlNode, line: int) -> None:
        if not self._open:
            self.root = node
            return
        parent, key = self._open[-1], self._keys[-1]
        parent.size += node.size
        if parent.size > _MOST:
            raise self._wrong(line, f"more than {_MOST} values, those that aliases (*name) stand for counted")
        if isinstance(parent.value, list):
            parent.value.append(node)
        elif key is None:
            self._keys[-1] = node
        else:
            self._keys[-1] = None
            self._put(parent, key, node)

    def _put(self, parent: YamlNode, key: YamlNode, node: YamlNode) -> None:
        if not isinstance(key.value, str):
            raise self._wrong(key.line, "a mapping or a list cannot be a key")
        if key.value == "<<" and not key.quoted:
            for name, merged in self._merged(node):
                parent.value.setdefault(name, merged)  # type: ignore[union-attr]
            return
        first = parent.lines.get(key.value)
        if first is not None and self._unique:
            raise self._wrong(key.line, f"'{shortened(key.value)}' is there twice, first in line {first}")
        parent.lines[key.value] = key.line
        parent.value[key.value] = node  # type: ignore[index, call-overload]

    def _merged(self, node: YamlNode) -> Iterator[tuple[str, YamlNode]]:
        for part in node.value if isinstance(node.value, list) else [node]:
            if not isinstance(part.value, dict):
                raise self._wrong(node.line, "'<<' takes a mapping")
            yield from part.value.items()

    def _meant(self, name: str, line: int) -> YamlNode:
        node = self._anchors.get(name)
        if node is None:
            raise self._wrong(line, f"no &{shortened(name)} before *{shortened(name)}")
        if any(node is around for around in self._open):
            raise self._wrong(line, f"*{shortened(name)} stands within itself")
        return node

    def _tag(self, tag: str | None, line: int) -> str:
        if tag in (None, "!", _TAGS + "str") or tag in _NEEDLESS:
            return ""
        if tag in self._tags:
            return str(tag)
        short = str(tag).replace(_TAGS, "!!")
        raise self._wrong(line, f"the tag {shortened(short)} is not read; write the value without it")

    def _wrong(self, line: int, message: str) -> InputError:
        return InputError(f"{self.source}:{line}: {message}")
