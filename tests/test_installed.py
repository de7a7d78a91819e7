"""The installed package: its version, its licences, the choice among its builds, and its neighbours."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

import vsgraphs
from vsgraphs import compiled
from vsgraphs.compiled import choose_level, core, installed_levels, processor_levels

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

import check_wheel  # noqa: E402  (after the path)

OLD: list[str] = []
SSE = ["x86-64-v2"]
AVX2 = [*SSE, "x86-64-v3"]
AVX512 = [*AVX2, "x86-64-v4"]


def test_the_version_is_one() -> None:
    written = re.search(r"project\(vsgraphs VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert written
    said = subprocess.check_output([sys.executable, "-m", "vsgraphs", "--version"], text=True)
    assert said == f"vsgraphs {written[1]}\n"
    assert metadata.version("vsgraphs") == vsgraphs.__version__ == core().build_info()["core"] == written[1]


def test_every_installed_file_has_a_licence() -> None:
    files = metadata.files("vsgraphs")
    assert files
    modules = 0
    for file in files:
        name = str(file)
        if name.startswith("vsgraphs/") and "__pycache__" not in name:
            assert not check_wheel.file_problems(name, Path(str(file.locate())).read_bytes())
            modules += name.endswith(".so")
    assert modules >= 1
    assert {Path(str(f)).name for f in files if ".dist-info/licenses/" in str(f)} == check_wheel.LICENCES


def test_what_a_wheel_must_not_hold_is_found() -> None:
    assert "licence" in check_wheel.file_problems("vsgraphs.libs/libcholmod-1.so", b"")[0]
    module = Path(core().__file__).read_bytes()
    name = "vsgraphs/_compiled/x86-64-v3/_core.cpython-311-x86_64-linux-gnu.so"
    assert not check_wheel.file_problems(name, module)
    for library in (b"libm.so.6", b"libc.so.6"):
        problems = check_wheel.file_problems(name, module.replace(library, b"libX11.so"[: len(library)]))
        assert any("neither inside nor promised" in problem for problem in problems)
    assert check_wheel.file_problems(name, module + b"cholmod_factorize")


@pytest.mark.parametrize(
    ("installed", "runs", "expected"),
    [
        (AVX2, AVX512, "x86-64-v3"),
        (AVX2, AVX2, "x86-64-v3"),
        (AVX2, SSE, "x86-64-v2"),
        (AVX512, AVX512, "x86-64-v4"),
        (["native"], OLD, "native"),  # built for this very machine
        (["generic"], OLD, "generic"),  # no x86
        (["native", "x86-64-v2"], AVX2, "x86-64-v2"),
    ],
)
def test_the_best_that_runs_is_taken(installed: list[str], runs: list[str], expected: str) -> None:
    assert choose_level(installed, runs) == expected


@pytest.mark.parametrize(
    ("installed", "runs", "wanted", "said"),
    [
        (AVX2, OLD, None, r"this processor is too old: .* x86-64-v2 and x86-64-v3 .*VSGRAPHS_CPU=native"),
        (["x86-64-v3"], SSE, None, r"this processor is too old: .* for x86-64-v3 "),
        (["x86-64-v3"], SSE, "x86-64-v3", r"VSGRAPHS_CPU=x86-64-v3: installed are x86-64-v3, .* runs none"),
        (AVX2, AVX2, "x86-64-v5", r"VSGRAPHS_CPU=x86-64-v5: .* runs x86-64-v2, x86-64-v3; unset"),
        ([], AVX2, None, "not built"),
    ],
)
def test_what_does_not_run_is_said(
    installed: list[str], runs: list[str], wanted: str | None, said: str
) -> None:
    with pytest.raises(ImportError, match=said) as caught:
        choose_level(installed, runs, wanted)
    assert "\n" not in str(caught.value)


def test_a_level_can_be_asked_for() -> None:
    assert choose_level(AVX2, AVX2, "x86-64-v2") == "x86-64-v2"
    assert choose_level(AVX2, AVX2, "") == "x86-64-v3"


def test_the_module_is_the_one_chosen() -> None:
    level = core().build_info()["processor_level"]
    assert Path(core().__file__).parent.name == level
    assert level == choose_level(installed_levels(), processor_levels())
    assert core() is sys.modules["vsgraphs._core"]


@pytest.mark.skipif(not processor_levels(), reason="not an x86-64 of 2009 or later")
def test_the_processor_is_asked() -> None:
    flags = Path("/proc/cpuinfo").read_text().split()
    assert processor_levels() == AVX512[: len(processor_levels())]
    assert ("x86-64-v3" in processor_levels()) == ("avx2" in flags)
    assert ("x86-64-v4" in processor_levels()) == ("avx512vl" in flags)


def test_the_program_refuses_an_old_processor_at_once(tmp_path: Path) -> None:
    """Before numpy, which would not load there either."""
    code = (
        "import sys, vsgraphs.compiled as compiled\n"
        "compiled.processor_levels = lambda: []\n"
        "compiled.installed_levels = lambda: ['x86-64-v2', 'x86-64-v3']\n"
        "from vsgraphs.cli import main\n"
        "sys.argv = ['vsgraphs', 'run', 'nowhere', '--out', 'out']\n"
        "try:\n    main()\nfinally:\n    assert 'numpy' not in sys.modules"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, check=False
    )
    assert done.returncode == 2
    assert done.stderr.startswith("error: this processor is too old: ")
    assert done.stderr.count("\n") == 1


def test_nothing_built_is_said(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(compiled, "_FOLDER", tmp_path)
    with pytest.raises(ImportError, match="not built"):
        core()
    compiled.check_processor()  # what needs no compiled module still runs


TRACK = """
import sys
for name in sys.argv[2].split(","):
    globals()[name] = __import__(name)
    if name == "cv2":  # loaded and used, with its own threads
        import numpy
        corners = cv2.goodFeaturesToTrack(numpy.eye(64, dtype=numpy.uint8) * 255, 10, 0.01, 2)
        assert corners is not None
    if name == "vsgraphs":
        vsgraphs.Slam
config = vsgraphs.Config()
config.set("system.execution", "serial")
sequence = vsgraphs.open_sequence(sys.argv[1])
slam = vsgraphs.Slam(config, sequence.camera)
for frame in sequence.frames[:20]:
    rgb, depth = frame.load()
    if "cv2" in sys.modules:
        cv2.GaussianBlur(rgb, (5, 5), 1.0)
    slam.track(rgb, depth, frame.timestamp)
slam.finish()
stamps, poses = slam.trajectory()
print(len(stamps), poses.tobytes().hex())
"""


def test_opencv_in_the_same_process_changes_nothing(recorded: Path) -> None:
    pytest.importorskip("cv2", reason="opencv-python-headless is not installed; it is in the extra `test`")

    def tracked(*imports: str) -> str:
        command = [sys.executable, "-c", TRACK, str(recorded), ",".join(imports)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    alone = tracked("vsgraphs")
    assert alone.startswith("20 ")
    assert tracked("cv2", "vsgraphs") == alone
    assert tracked("vsgraphs", "cv2") == alone
