#!/usr/bin/env python3
"""Fails on any include or import that leaves the architecture, and on words the core does without.

The floors of the core are read from core/CMakeLists.txt (`vsgraphs_layer(NAME ... BELOW ...)`), folders
beside the core from CMakeLists.txt, those of the Python package from pyproject.toml (see python_layers.py):
each is written down once.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import python_layers

if TYPE_CHECKING:
    from collections.abc import Iterator

CLOCKS_AND_THREADS = (
    r"^(atomic|barrier|chrono|condition_variable|ctime|future|latch|mutex|pthread\.h|semaphore|shared_mutex|"
    r"stop_token|sys/time\.h|thread|time\.h)$"
)


@dataclass(frozen=True)
class Rule:
    """What `pattern` matches may stand only in the core folders `allowed`, and in tests where `in_tests`."""

    pattern: re.Pattern[str]
    allowed: frozenset[str]
    in_tests: bool
    reason: str

    def forbids(self, text: str, folder: str, *, is_test: bool) -> bool:
        """Says whether `text`, found in core/`folder`, breaks this rule."""
        return (
            self.pattern.search(text) is not None
            and folder not in self.allowed
            and not (is_test and self.in_tests)
        )


def _rule(pattern: str, allowed: str, reason: str, *, in_tests: bool) -> Rule:
    return Rule(re.compile(pattern), frozenset(allowed.split()), in_tests, reason)


INCLUDE_RULES = (
    _rule(
        r"^(unsupported/)?Eigen/(?!Core$|Geometry$|StdVector$)", "solve geometry",
        "Eigen's solvers stay in core/solve and core/geometry", in_tests=False,
    ),
    _rule(r"^opencv2/", "", "the project does without OpenCV", in_tests=False),
    _rule(r"^(ceres|glog)/", "", "Ceres is an oracle for tests, never shipped", in_tests=True),
    _rule(
        CLOCKS_AND_THREADS, "system base",
        "clocks and threads stay in core/system and core/base", in_tests=True,
    ),
    _rule(r"^random$", "base", "random numbers come from core/base/rng.h", in_tests=True),
    _rule(r"^iostream$", "", "the core prints nothing: use the log sink", in_tests=True),
)  # fmt: skip

# A member function of such a name (x.exit(), Queue::abort()) is none of these.
_FREE = r"(?<![\w.>:])(?:std::|::)?"
WORD_RULES = (
    _rule(
        _FREE + r"(?:(?:f|v|vf)?printf|f?puts|putchar)\s*\(|std::(?:cout|cerr|clog)\b", "",
        "the core prints nothing: use the log sink", in_tests=True,
    ),
    _rule(
        _FREE + r"(?:_?exit|_Exit|quick_exit|abort|terminate)\s*\(", "",
        "the core throws, it never exits", in_tests=True,
    ),
    _rule(_FREE + r"s?rand\s*\(", "", "random numbers come from core/base/rng.h", in_tests=False),
    _rule(r"\bthread_local\b", "system base", "threads stay in core/system and core/base", in_tests=False),
    _rule(
        r"\bnew\b\s*[\w:(]|\bdelete\b\s*(?:\[\s*\])?\s*[\w(*]", "",
        "no naked new or delete", in_tests=True,
    ),
)  # fmt: skip

# Headers the build writes; they lie in no folder of the project.
GENERATED = {"build_info.h"}
VAGUE_NAMES = {"util", "utils", "common", "helper", "helpers", "manager", "misc"}


@dataclass(frozen=True)
class Layer:
    """One folder of core/: the folders it may include, and those its tests may include besides."""

    below: frozenset[str]
    for_tests: frozenset[str]


def read_layers(cmake: str) -> dict[str, Layer]:
    """Reads the floors of the core from the text of core/CMakeLists.txt."""
    text = re.sub(r"#.*", "", cmake)
    layers: dict[str, Layer] = {}
    for arguments in re.findall(r"vsgraphs_layer\(([^)]*)\)", text):
        name, *words = arguments.split()
        lists: dict[str, list[str]] = {}
        keyword = ""
        for word in words:
            if word.isupper():
                keyword = word
            else:
                lists.setdefault(keyword, []).append(word)
        tests = [word.removeprefix("vsgraphs_") for word in lists.get("TEST_LIBRARIES", [])]
        layers[name] = Layer(frozenset(lists.get("BELOW", [])), frozenset(tests))
    # A target is named after its folder, with _ for /.
    folders = {name.replace("/", "_"): name for name in layers}
    return {
        name: Layer(layer.below, frozenset(folders.get(test, test) for test in layer.for_tests))
        for name, layer in layers.items()
    }


def folder_of(path: str, layers: dict[str, Layer]) -> str:
    """Names the layer that a path below core/ lies in; the first folder of the path if it lies in none."""
    first, _, rest = path.partition("/")
    room = f"{first}/{rest.partition('/')[0]}"
    return room if room in layers else first


def cycle(layers: dict[str, Layer]) -> str | None:
    """Names a folder that may include itself through others, if there is one."""
    for start, layer in layers.items():
        reached: set[str] = set()
        waiting = list(layer.below)
        while waiting:
            name = waiting.pop()
            if name == start:
                return start
            if name not in reached:
                reached.add(name)
                waiting.extend(layers[name].below if name in layers else ())
    return None


_CODE_OR_NOISE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<tag>[^(\s]*)\(.*?\)(?P=tag)"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'',
    re.DOTALL,
)


def without_noise(text: str) -> str:
    """Blanks comments and literals, keeping the lines; text behind #include stays."""

    def blank(match: re.Match[str]) -> str:
        line_start = text.rfind("\n", 0, match.start()) + 1
        if text[line_start : match.start()].lstrip().startswith("#include") and match[0][0] == '"':
            return match[0]
        return "\n" * match[0].count("\n")

    return _CODE_OR_NOISE.sub(blank, text)


def layer_of(path: str, layers: dict[str, Layer]) -> str | None:
    """Names the layer that a path from the project's root lies in: a folder of core/, or one beside it."""
    top, _, rest = path.partition("/")
    if top == "core":
        return folder_of(rest, layers)
    return top if top in layers and rest else None


def _include_problems(
    folder: str, layers: dict[str, Layer], included: str, *, is_test: bool
) -> Iterator[str]:
    layer = layers[folder]
    target = layer_of(included, layers)
    if target is None:
        for rule in INCLUDE_RULES:
            if rule.forbids(included, folder.partition("/")[0], is_test=is_test):
                yield f"includes <{included}>: {rule.reason}"
        return
    allowed = layer.below | {folder} | (layer.for_tests if is_test else frozenset())
    if target not in allowed:
        yield f"{folder} includes {included}, but may include only {', '.join(sorted(allowed))}"


def check_cpp(root: Path) -> list[str]:
    """Checks core/, what stands beside it and bindings/; returns a line `path:line: problem` per finding."""
    top = root / "CMakeLists.txt"
    beside = sorted(read_layers(top.read_text())) if top.exists() else []
    layers = read_layers(
        "".join(path.read_text() for path in (root / "core/CMakeLists.txt", top) if path.exists())
    )
    problems = []
    if (culprit := cycle(layers)) is not None:
        problems.append(f"core/CMakeLists.txt: {culprit} stands below itself")
    holding = {
        folder_of(str(path.relative_to(root / "core")), layers)
        for path in root.glob("core/**/*")
        if path.suffix in {".h", ".cpp"} and path.parent != root / "core"
    }
    problems += [
        f"core/{folder}: not declared with vsgraphs_layer() in core/CMakeLists.txt"
        for folder in sorted(holding - set(layers))
    ]
    folders = ("core/*", *beside, "bindings")
    for path in [path for folder in folders for path in sorted(root.glob(f"{folder}/**/*"))]:
        if path.suffix not in {".h", ".cpp"}:
            continue
        name = path.relative_to(root)
        if VAGUE_NAMES & set(re.split(r"[_/.]", str(name))):
            problems.append(f"{name}: name it after what it holds")
        for number, line in enumerate(without_noise(path.read_text()).splitlines(), 1):
            problems += [f"{name}:{number}: {problem}" for problem in _line_problems(layers, name, line)]
    return problems


def _line_problems(layers: dict[str, Layer], name: Path, line: str) -> Iterator[str]:
    is_test = name.stem.endswith("_test") or name.stem.startswith("test_")
    folder = layer_of(name.as_posix(), layers)
    include = re.match(r'\s*#\s*include\s*(["<])([^">]+)[">]', line)
    if include:
        quote, included = include.groups()
        of_project = layer_of(included, layers) is not None or included.startswith("bindings/")
        if quote == '"' and not of_project and included not in GENERATED:
            yield f'includes "{included}": write the path from the project\'s root'
        elif folder is None:
            if included.startswith("opencv2/"):
                yield f"includes <{included}>: the project does without OpenCV"
        elif included.startswith("bindings/"):
            yield f"includes {included}: the core knows nothing of Python"
        elif folder in layers:
            yield from _include_problems(folder, layers, included, is_test=is_test)
    elif folder is not None:
        for rule in WORD_RULES:
            if rule.forbids(line, folder.partition("/")[0], is_test=is_test):
                yield rule.reason


def main() -> int:
    """Checks the checkout this file belongs to."""
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    problems = check_cpp(root) + python_layers.check(root)
    for problem in problems:
        print(problem)
    print(f"layer check: {len(problems)} violations")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
