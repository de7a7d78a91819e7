"""The runs of an ablation: its variants, and one run with everything measured about it."""

from __future__ import annotations

import hashlib
import json
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from run_sequences import Case, call, run_once
from sequence_figures import Figures

MODES = ("slam", "bc", "full")

_WHERE = (
    "import json, vsgraphs; from vsgraphs.compiled import core; from vsgraphs.version import commit; "
    "print(json.dumps([commit(core()), list(vsgraphs.__path__), core().__file__]))"
)

# No planes, the trajectory's frame: with it `eval --scene` scores the map's points where there is no graph.
EMPTY_GRAPH = {
    "format": "vsgraphs scene graph",
    "version": 1,
    "units": "metres, seconds",
    "frame": {
        "levelled": False,
        "world_from_map": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
        "ground": None,
    },
    "keyframes": [],
    "planes": [],
    "edges": [],
}


@dataclass(frozen=True)
class Variant:
    """A column of the ablation: a mode, with options set (KEY=VALUE) besides."""

    name: str
    mode: str
    settings: list[str] = field(default_factory=list)

    def arguments(self) -> list[str]:
        """For `vsgraphs run`."""
        return ["--mode", self.mode, *(word for setting in self.settings for word in ("--set", setting))]


def parse_variant(text: str, default_mode: str) -> Variant:
    """NAME:KEY=VALUE,KEY=VALUE; system.mode among the keys chooses the mode. Raises ValueError."""
    name, colon, rest = text.partition(":")
    settings = rest.split(",") if rest else []
    if not name or not colon or not settings or any("=" not in setting for setting in settings):
        raise ValueError(f"'{text}' is not NAME:KEY=VALUE,KEY=VALUE")
    mode = default_mode
    for setting in settings:
        if setting.startswith("system.mode="):
            mode = setting.partition("=")[2]
    return Variant(name, mode, [each for each in settings if not each.startswith("system.mode=")])


def known_modes(program: list[str]) -> list[str]:
    """Those of slam, bc and full that the program knows. Raises RuntimeError."""
    shown = call([*program, "config", "system.mode", "--yaml"])
    words = re.findall(r"\w+", shown.rpartition(";")[2])
    return [mode for mode in MODES if mode in words]


def build_of(program: str) -> str:
    """The commit the program was built from, with a hash of the installed package if its tree had changes.

    Asks the interpreter beside the program. Raises RuntimeError.
    """
    python = Path(program).with_name("python")
    if not python.exists():
        raise RuntimeError(f"no {python}: give --vsgraphs as the bin/vsgraphs of an installation")
    commit, folders, compiled = json.loads(call([str(python), "-c", _WHERE]))
    if re.fullmatch(r"[0-9a-f]{7,40}", commit):
        return str(commit)
    digest = hashlib.sha256(Path(compiled).read_bytes())
    for path in sorted(path for folder in folders for path in Path(folder).rglob("*.py")):
        digest.update(path.read_bytes())
    return f"{commit}-{digest.hexdigest()[:12]}"


def measure(program: list[str], case: Case, seed: int, variant: Variant, out: Path) -> dict[str, Any]:
    """One run, evaluated: {"figures", "scene"}. scene: `eval --scene`'s JSON, None without scene_gt.json.

    Raises RuntimeError.
    """
    run = run_once(program, case, seed, variant.arguments(), out)
    scene = score_scene(program, case.sequence, out)
    found: Figures = dict(run["figures"])
    found["map_points"] = float(run["run"]["landmarks"])
    found |= scene_figures(scene, estimated=variant.mode != "slam")
    return {"figures": found, "scene": scene}


def score_scene(program: list[str], sequence: Path, out: Path) -> dict[str, Any] | None:
    """`eval --scene`'s JSON. Raises RuntimeError."""
    truth = sequence / "scene_gt.json"
    if not truth.is_file():
        return None
    graph, report = out / "scene_graph.json", out / "scene_eval.json"
    if not graph.exists():
        graph.write_text(json.dumps(EMPTY_GRAPH))
    call([*program, "eval", "--scene", str(out), "--truth", str(truth), "--json", str(report)])
    found: dict[str, Any] = json.loads(report.read_text())
    return found


def scene_figures(scene: dict[str, Any] | None, *, estimated: bool) -> Figures:
    """Figures of the table. estimated: the mode looks for building components; else only the map counts."""
    if scene is None:
        return {}
    map_score = scene.get("map") or {}
    found = {
        "map_rmse_m": map_score.get("rmse_m"),
        "map_near_rmse_m": map_score.get("structural_rmse_m"),
    }
    if estimated:
        components = scene["building_components"]["all"]
        keys = ("precision", "recall", "f1", "angle_deg", "offset_m")
        found |= {key: components[key] for key in keys}
    return {key: float(value) for key, value in found.items() if value is not None}
