#!/usr/bin/env python3
"""Reports sources longer than the project aims for; fails on those nobody could find their way in."""

import subprocess
import sys
from pathlib import Path

AIM = 200
LIMIT = 400


def main() -> int:
    """Looks at the sources git knows in the checkout this file belongs to."""
    root = Path(__file__).resolve().parent.parent
    git = ["git", "-C", str(root), "ls-files", "*.cpp", "*.h", "*.py"]
    names = subprocess.run(git, check=True, capture_output=True, text=True).stdout.split()
    lengths = {name: len((root / name).read_text().splitlines()) for name in names if (root / name).exists()}
    long = sorted(((length, name) for name, length in lengths.items() if length > AIM), reverse=True)
    for length, name in long:
        print(f"{name}: {length} lines" + (f", more than {LIMIT}: split it" if length > LIMIT else ""))
    if long:
        print(f"{len(long)} of {len(lengths)} sources are longer than {AIM} lines")
    return 1 if any(length > LIMIT for length, _ in long) else 0


if __name__ == "__main__":
    sys.exit(main())
