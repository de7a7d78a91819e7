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


def _without_types(tree: ast.Module) -> ast.Module:
    """The module less what stands under `if TYPE_CHECKING`, which is never run."""

    class Cut(ast.NodeTransformer):
        def visit_If(self, node: ast.If) -> ast.AST | list[ast.stmt]:
            self.generic_visit(node)
            test = node.test
            named = test.id if isinstance(test, ast.Name) else getattr(test, "attr", "")
            return node.orelse if named == "TYPE_CHECKING" else node

    Cut().visit(tree)
    return tree


def circles(source: Path) -> list[list[str]]:
    """Modules that import each other, imports within functions included, each circle once and sorted.

    What is imported for types alone does not count, nor that a package's `__init__` runs before its modules.
    """
    modules = {_dotted(path, source): path for path in sorted(source.rglob("*.py"))}
    below: dict[str, set[str]] = {}
    for name, path in modules.items():
        relative = path.relative_to(source)
        found = _imports(_without_types(ast.parse(path.read_text())), ("vsgraphs", *relative.parts[:-1]))
        targets = {full if full in modules else full.rpartition(".")[0] for _, full in found}
        below[name] = (targets & set(modules)) - {name, "vsgraphs"}
    reached = {name: _reached(name, below) for name in below}
    in_one = {
        name: tuple(sorted(other for other in reached[name] if name in reached[other]))
        for name in below
        if name in reached[name]
    }
    return [list(circle) for circle in sorted(set(in_one.values()))]


def _dotted(path: Path, source: Path) -> str:
    parts = path.relative_to(source).with_suffix("").parts
    return ".".join(["vsgraphs", *(part for part in parts if part != "__init__")])


def _reached(start: str, below: dict[str, set[str]]) -> set[str]:
    """All that imports lead to from a module; itself only by a circle."""
    reached: set[str] = set()
    ahead = list(below[start])
    while ahead:
        name = ahead.pop()
        if name not in reached:
            reached.add(name)
            ahead += below[name]
    return reached


def check(root: Path) -> list[str]:
    """Checks that each part of the Python package imports only parts of lower rows, and no module itself."""
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
    problems += [f"python/vsgraphs: {' and '.join(circle)} import each other" for circle in circles(source)]
    return problems
