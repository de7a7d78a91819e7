#!/usr/bin/env python3
"""Says what is in a wheel and under which licence; fails on anything that is not known, or copyleft.

tools/check_wheel.py WHEEL [--levels LEVEL...]
"""

from __future__ import annotations

import argparse
import io
import re
import struct
import sys
import zipfile
from pathlib import Path

SIZE_LIMIT_MB = 15
OURS = "Apache-2.0"
# What is compiled into each module beside our own code.
COMPILED_IN = {
    r"vsgraphs/_compiled/[\w.-]+/_core\.[\w.-]+\.so": (
        f"{OURS}; Eigen MPL-2.0; nanobind BSD-3-Clause; robin-map MIT"
    ),
    r"vsgraphs/_processor\.[\w.-]+\.so": OURS,
}
PLAIN = r"vsgraphs/[\w/.]+\.(py|pyi|json|typed)"
LICENCES = {"LICENSE", "NOTICE", "Eigen-MPL-2.0.txt", "nanobind-BSD-3-Clause.txt", "robin-map-MIT.txt"}
# The system's, promised by manylinux, not in the wheel: glibc, and GCC's run-time libraries (with exception).
FROM_THE_SYSTEM = {"libc.so.6", "libm.so.6", "libgcc_s.so.1", "libstdc++.so.6", "ld-linux-x86-64.so.2"}
# Linked by the tests' oracles; their names would show in a module that has them inside.
NEVER_INSIDE = (b"cholmod", b"ceres", b"suitesparse", b"opencv")


def licence_of(name: str) -> str | None:
    """The licence of a packaged file by its path in the package, None for one that nobody has thought of."""
    for pattern, licence in COMPILED_IN.items():
        if re.fullmatch(pattern, name):
            return licence
    return OURS if re.fullmatch(PLAIN, name) else None


def needed_libraries(elf: bytes) -> list[str]:
    """The shared libraries a 64-bit little-endian ELF file asks for. Raises ValueError for other files."""
    if elf[:6] != b"\x7fELF\x02\x01":
        raise ValueError("no 64-bit ELF file")
    (table,) = struct.unpack_from("<Q", elf, 40)
    size, count = struct.unpack_from("<HH", elf, 58)
    sections = [struct.unpack_from("<IIQQQQIIQQ", elf, table + i * size) for i in range(count)]
    names = []
    for _, kind, _, _, offset, length, link, *_ in sections:
        if kind != 6:  # SHT_DYNAMIC
            continue
        strings = sections[link][4]
        for tag, value in struct.iter_unpack("<qQ", elf[offset : offset + length]):
            if tag == 1:  # DT_NEEDED
                start = strings + value
                names.append(elf[start : elf.index(b"\0", start)].decode())
    return names


def module_problems(name: str, content: bytes) -> list[str]:
    """What a compiled module must not have."""
    problems = [
        f"{name}: needs {library}, which is neither inside nor promised by manylinux"
        for library in needed_libraries(content)
        if library not in FROM_THE_SYSTEM
    ]
    problems += [f"{name}: contains {word.decode()}" for word in NEVER_INSIDE if word in content.lower()]
    if b".symtab\0" in content:
        problems.append(f"{name}: is not stripped")
    return problems


def file_problems(name: str, content: bytes) -> list[str]:
    """What is wrong with one file of the package."""
    if licence_of(name) is None:
        return [f"{name}: its licence is not known to tools/check_wheel.py"]
    return module_problems(name, content) if name.endswith(".so") else []


def wheel_problems(wheel: Path, levels: list[str]) -> list[str]:
    """Checks each file, the size, the licences' texts and that each of `levels` is there; prints the list."""
    size_mb = wheel.stat().st_size / 1e6
    problems = [] if size_mb < SIZE_LIMIT_MB else [f"{wheel.name}: {size_mb:.1f} MB, {SIZE_LIMIT_MB} at most"]
    with zipfile.ZipFile(io.BytesIO(wheel.read_bytes())) as archive:
        names = [name for name in archive.namelist() if not name.endswith("/")]
        texts = {Path(name).name for name in names if ".dist-info/licenses/" in name}
        problems += [f"{wheel.name}: the text {text} is missing" for text in sorted(LICENCES - texts)]
        for level in levels:
            if not any(name.startswith(f"vsgraphs/_compiled/{level}/_core.") for name in names):
                problems.append(f"{wheel.name}: no module for {level}")
        plain = 0
        for name in names:
            if ".dist-info/" in name:
                continue
            content = archive.read(name)
            problems += file_problems(name, content)
            if name.endswith(".so"):
                needs = ", ".join(needed_libraries(content))
                print(f"{name} ({len(content) / 1e6:.1f} MB): {licence_of(name)}; loads {needs}")
            plain += not name.endswith(".so")
    print(f"{plain} other files: {OURS}")
    print(f"{wheel.name}: {size_mb:.1f} MB")
    return problems


def main() -> int:
    """Checks the wheel named on the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("wheel", type=Path)
    parser.add_argument("--levels", nargs="*", default=[], help="x86 levels that must be inside")
    arguments = parser.parse_args()
    problems = wheel_problems(arguments.wheel, arguments.levels)
    for problem in problems:
        print(problem)
    print(f"wheel check: {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
