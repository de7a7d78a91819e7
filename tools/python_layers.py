"""The floors of the Python package, written down in pyproject.toml under `[tool.vsgraphs] python_layers`."""

from __future__ import annotations

import ast
import tomllib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


def _imports(tree: ast.Module, package: tuple[str, ...]) -> Iterator[tuple[int, str]]:
    """Yields (line, full dotted name) of each import; of `from a import b`, `a.b`."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, alias.name
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            stem = ".".join([*base, *([node.module] if node.module else [])])
            for alias in node.names:
                yield node.lineno, f"{stem}.{alias.name}"


def check(root: Path) -> list[str]:
    """Checks that each part of the Python package imports only parts of lower rows."""
    settings = tomllib.loads((root / "pyproject.toml").read_text())["tool"]["vsgraphs"]
    floor = {part: index for index, row in enumerate(settings["python_layers"]) for part in row}
    forbidden = set(settings["never_imported"])
    source = root / "python/vsgraphs"
    problems = []
    for path in sorted(source.rglob("*.py")):
        relative = path.relative_to(source)
        part = relative.parts[0].removesuffix(".py")
        where = path.relative_to(root)
        if part not in floor:
            problems.append(f"{where}: {part} is in no row of python_layers in pyproject.toml")
            continue
        package = ("vsgraphs", *relative.parts[:-1])
        for line, name in _imports(ast.parse(path.read_text()), package):
            top, *rest = name.split(".")
            if top in forbidden:
                problems.append(f"{where}:{line}: {top} is never imported by the package")
            target = rest[0] if top == "vsgraphs" and rest else ""
            if target in floor and target != part and floor[target] <= floor[part]:
                problems.append(f"{where}:{line}: {part} imports {target}, which is not below it")
    return problems
