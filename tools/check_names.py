#!/usr/bin/env python3
"""Fails where two types of the core share a name: the linker would take either for both."""

from __future__ import annotations

import re
import sys
from collections import defaultdict
from pathlib import Path

TYPE = re.compile(r"^(?:struct|class|enum class) (\w+)(?! *;)\b[^;]*$", re.MULTILINE)


def shared_names(root: Path) -> dict[str, list[str]]:
    """Names of types that more than one header of core and simulate declares, with those headers."""
    found: dict[str, set[str]] = defaultdict(set)
    for header in sorted([*(root / "core").rglob("*.h"), *(root / "simulate").rglob("*.h")]):
        for name in TYPE.findall(header.read_text()):
            found[name].add(str(header.relative_to(root)))
    return {name: sorted(headers) for name, headers in sorted(found.items()) if len(headers) > 1}


def main() -> int:
    """Prints what is shared; 1 if anything is."""
    shared = shared_names(Path(__file__).resolve().parent.parent)
    for name, headers in shared.items():
        print(f"{name} is declared in {' and '.join(headers)}: rename one")
    print(f"name check: {len(shared)} shared")
    return 1 if shared else 0


if __name__ == "__main__":
    sys.exit(main())
