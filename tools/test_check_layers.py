"""The layer check finds what it forbids and lets pass what it allows, in a small made-up project."""

from pathlib import Path

import pytest

import check_layers
import python_layers

CMAKE = """
vsgraphs_layer(base LIBRARIES Threads::Threads)
vsgraphs_layer(geometry BELOW base) # a word on it (BELOW stages)
vsgraphs_layer(map BELOW geometry base)
vsgraphs_layer(vision BELOW map geometry base)
vsgraphs_layer(scene BELOW map geometry base TEST_LIBRARIES vsgraphs_simulate)
vsgraphs_layer(system BELOW map
  geometry base)
"""
PYPROJECT = """
[tool.vsgraphs]
python_layers = [["cli"], ["__init__"], ["datasets", "evaluate"], ["_core"]]
never_imported = ["evo"]
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    for folder in ("base", "geometry", "map", "vision", "scene", "system"):
        (tmp_path / "core" / folder).mkdir(parents=True)
    (tmp_path / "core/CMakeLists.txt").write_text(CMAKE)
    (tmp_path / "CMakeLists.txt").write_text(
        "add_subdirectory(core)\nvsgraphs_layer(simulate BELOW geometry base)\n"
    )
    (tmp_path / "pyproject.toml").write_text(PYPROJECT)
    (tmp_path / "python/vsgraphs/cli").mkdir(parents=True)
    return tmp_path


def cpp_problems(project: Path, path: str, text: str) -> list[str]:
    (project / path).parent.mkdir(parents=True, exist_ok=True)
    (project / path).write_text(text)
    return check_layers.check_cpp(project)


def python_problems(project: Path, path: str, text: str) -> list[str]:
    (project / "python/vsgraphs" / path).write_text(text)
    return python_layers.check(project)


def test_reads_the_floors_from_cmake() -> None:
    layers = check_layers.read_layers(CMAKE)
    assert layers["system"].below == {"map", "geometry", "base"}
    assert layers["scene"].for_tests == {"simulate"}
    assert layers["base"].below == frozenset()


def test_finds_a_cycle() -> None:
    layers = check_layers.read_layers(
        "vsgraphs_layer(a BELOW b)\nvsgraphs_layer(b BELOW c)\nvsgraphs_layer(c BELOW a)"
    )
    assert check_layers.cycle(layers) is not None
    assert check_layers.cycle(check_layers.read_layers(CMAKE)) is None


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("core/geometry/a.h", '#include "core/map/ids.h"'),
        ("core/vision/a.h", '#include "core/scene/b.h"'),
        ("core/scene/a.cpp", '#include "simulate/b.h"'),
        ("simulate/a.cpp", '#include "core/map/b.h"'),
        ("simulate/a.cpp", "#include <mutex>"),
        ("core/map/a.h", '#include "bindings/map.h"'),
        ("core/map/a.h", '#include "ids.h"'),
        ("core/scene/a.cpp", "#include <Eigen/Cholesky>"),
        ("core/scene/a.cpp", "#include <Eigen/Dense>"),
        ("core/vision/a.cpp", "#include <opencv2/core.hpp>"),
        ("bindings/a.cpp", "#include <opencv2/core.hpp>"),
        ("core/scene/a.cpp", "#include <ceres/ceres.h>"),
        ("core/scene/a.cpp", "#include <mutex>"),
        ("core/scene/a.cpp", "  #  include <chrono>"),
        ("core/scene/a.cpp", "#include <random>"),
        ("core/system/a.cpp", "#include <iostream>"),
        ("core/system/a.cpp", 'void f() { std::printf("x"); }'),
        ("core/system/a.cpp", "void f() { std::cout << 1; }"),
        ("core/system/a.cpp", "void f() { int x = 1'000; std::cerr << 'a'; }"),
        ("core/base/a.cpp", "void f() { exit(1); }"),
        ("core/base/a.cpp", "void f() { std::abort(); }"),
        ("core/base/a.cpp", "int* f() { return new int(1); }"),
        ("core/base/a.cpp", "void f(int* x) { delete x; }"),
        ("core/map/a.cpp", "thread_local int x;"),
        ("core/map/map_utils.h", ""),
        ("core/extra/a.h", ""),
    ],
)  # fmt: skip
def test_forbids(project: Path, path: str, text: str) -> None:
    problems = cpp_problems(project, path, text + "\n")
    assert len(problems) == 1, problems
    assert problems[0].startswith(path.rsplit("/", 1)[0])


@pytest.mark.parametrize(
    ("path", "text"),
    [
        (
            "core/vision/a.cpp",
            '#include "core/vision/b.h"\n#include "core/map/c.h"',
        ),
        ("core/scene/a.cpp", "#include <Eigen/Core>\n#include <Eigen/Geometry>"),
        ("core/geometry/a.cpp", "#include <Eigen/SVD>"),
        (
            "core/scene/a_test.cpp",
            '#include <ceres/ceres.h>\n#include <thread>\n#include "simulate/b.h"',
        ),
        ("simulate/a.cpp", '#include "core/geometry/b.h"'),
        ("core/system/a.cpp", "#include <mutex>\n#include <thread>"),
        ("core/map/a.cpp", "// printf, std::cout, exit(1) and new things\n/* delete\n x; */"),
        ("core/map/a.cpp", 'const char* text = "std::cout << new int; exit(1)";'),
        ("core/map/a.cpp", "struct A { A(const A&) = delete; };\nvoid f(A& a) { a.exit(); }"),
        ("core/map/a.cpp", "void f(char* b) { std::snprintf(b, 3, x); int new_id = 2; }"),
        (
            "bindings/a.cpp",
            '#include "core/system/run/slam.h"\n#include "bindings/b.h"\n#include <nanobind/nanobind.h>',
        ),
    ],
)
def test_allows(project: Path, path: str, text: str) -> None:
    assert cpp_problems(project, path, text + "\n") == []


def test_names_the_line(project: Path) -> None:
    text = "/* two\nlines */\n\n#include <mutex>\n"
    assert cpp_problems(project, "core/map/a.h", text)[0].startswith("core/map/a.h:4: ")


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("datasets.py", "from vsgraphs.cli import main"),
        ("datasets.py", "from vsgraphs import cli"),
        ("datasets.py", "from . import cli"),
        ("datasets.py", "from .evaluate import ate"),
        ("datasets.py", "import vsgraphs.evaluate"),
        ("cli/run.py", "def f():\n    import evo.core"),
        ("extra.py", ""),
    ],
)
def test_forbids_in_python(project: Path, path: str, text: str) -> None:
    assert len(python_problems(project, path, text + "\n")) == 1


@pytest.mark.parametrize(
    ("path", "text"),
    [
        (
            "cli/run.py",
            "from vsgraphs import datasets, evaluate\nfrom . import progress\nfrom ..datasets import tum",
        ),
        ("datasets.py", "import numpy as np\nfrom vsgraphs import _core\nfrom vsgraphs._core import Slam"),
        ("__init__.py", "from vsgraphs._core import Slam"),
    ],
)
def test_allows_in_python(project: Path, path: str, text: str) -> None:
    assert python_problems(project, path, text + "\n") == []


def test_finds_modules_that_import_each_other(project: Path) -> None:
    python_problems(project, "cli/one.py", "def f():\n    from vsgraphs.cli.two import g\n")
    python_problems(project, "cli/two.py", "import vsgraphs.cli.three\n")
    problems = python_problems(project, "cli/three.py", "from .one import f\n")
    assert problems == [
        "python/vsgraphs: vsgraphs.cli.one and vsgraphs.cli.three and vsgraphs.cli.two import each other"
    ]
    types = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from .one import f\n"
    assert python_problems(project, "cli/three.py", types) == []


def test_this_checkout_keeps_its_layers(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.argv", ["check_layers.py"])
    assert check_layers.main() == 0, capsys.readouterr().out
