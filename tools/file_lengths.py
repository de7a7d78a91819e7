#!/usr/bin/env python3
"""Reports sources longer than the project aims for; fails on those nobody could find their way in."""

import sys
from pathlib import Path

AIM = 200
LIMIT = 400
SUFFIXES = {".cpp", ".h", ".py"}


def main() -> int:
    """Looks at the sources of the checkout this file belongs to."""
    root = Path(__file__).resolve().parent.parent
    folders = ("core", "simulate", "bindings", "python", "tests", "tools", "benchmarks", "examples")
    paths = [path for folder in folders for path in (root / folder).rglob("*") if path.suffix in SUFFIXES]
    lengths = {str(path.relative_to(root)): len(path.read_text().splitlines()) for path in paths}
    long = sorted(((length, name) for name, length in lengths.items() if length > AIM), reverse=True)
    for length, name in long:
        print(f"{name}: {length} lines" + (f", more than {LIMIT}: split it" if length > LIMIT else ""))
    if long:
        print(f"{len(long)} of {len(lengths)} sources are longer than {AIM} lines")
    return 1 if any(length > LIMIT for length, _ in long) else 0


if __name__ == "__main__":
    sys.exit(main())
