"""JSON, strictly: no NaN, no number that no machine holds, no depth that ends us."""

from __future__ import annotations

import json
import math
from collections import Counter
from pathlib import Path
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.reading.files import SMALL, read_text
from vsgraphs.reading.shown import shortened

_LARGEST = 2**63


def read_json(path: Path, purpose: str, limit: int = SMALL, *, unique: bool = False, cure: str = "") -> Any:
    """What a JSON file holds. Raises InputError, one line that names the file and where it can the line.

    unique: the same key twice in one object is a mistake (JSON keeps the last in silence). cure: what to try,
    behind the message.
    """
    return parse_json(read_text(path, purpose, limit, expected="JSON"), str(path), unique=unique, cure=cure)


def parse_json(text: str, source: str, *, unique: bool = False, cure: str = "") -> Any:
    """As `read_json`, of a text; `source` names it in messages."""
    cure = f"; {cure}" if cure else ""
    source = shortened(source, 300)
    try:
        found = json.loads(
            text,
            parse_constant=_constant,
            parse_float=_real,
            parse_int=_whole,
            object_pairs_hook=_unique if unique else None,
        )
        if "\\u" in text:
            json.dumps(found, ensure_ascii=False).encode("utf-8")
    except json.JSONDecodeError as error:
        raise InputError(f"{source}:{error.lineno}: not valid JSON: {error.msg}{cure}") from None
    except RecursionError:
        raise InputError(f"{source}: not valid JSON: nested too deeply{cure}") from None
    except UnicodeEncodeError:
        raise InputError(f"{source}: a text holds half a character (\\ud800 to \\udfff){cure}") from None
    except _RefusedError as error:
        line = text.count("\n", 0, max(text.find(error.word), 0)) + 1
        raise InputError(f"{source}:{line}: {error}") from None
    return found


class _RefusedError(ValueError):
    """word: where to look for it in the text."""

    def __init__(self, message: str, word: str) -> None:
        super().__init__(message)
        self.word = word


def _constant(word: str) -> float:
    raise _RefusedError(f"{word} is no number; JSON has none of that name", word)


def _real(word: str) -> float:
    value = float(word)
    if not math.isfinite(value):
        raise _RefusedError(f"{shortened(word, 30)} is larger than any number here can be", word)
    return value


def _whole(word: str) -> int:
    if len(word) > 20 or not -_LARGEST <= (value := int(word)) < _LARGEST:
        raise _RefusedError(f"{shortened(word, 30)} is larger than any whole number here can be", word)
    return value


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        counts = Counter(key for key, _ in pairs)
        twice = next(key for key, count in counts.items() if count > 1)
        raise _RefusedError(f'"{shortened(twice)}" is there twice', json.dumps(twice))
    return found
