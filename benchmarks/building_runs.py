"""One run over a building with everything measured about it, and the file that keeps what was measured."""

from __future__ import annotations

import hashlib
import json
import threading
from pathlib import Path
from typing import Any

from ablation_runs import Variant, score_scene
from building_tables import FOUND, Row
from run_sequences import Case, run_once


def measured(
    program: list[str], sequence: Path, key: dict[str, Any], variant: Variant, out: Path
) -> dict[str, Any]:
    """The figures of one run, evaluated: numbers, and of FOUND {"found", "true", "false"} or None.

    Raises RuntimeError.
    """
    run = run_once(program, Case(sequence, key["execution"]), key["seed"], variant.arguments(), out)
    scene = score_scene(program, sequence, out)
    report = run["run"]
    found: dict[str, Any] = {
        name: report[name] for name in ("maps", "loops", "merges", "frames", "cpu_s", "keyframes")
    }
    found["ate_rmse_m"] = run["figures"].get("ate_rmse_m")
    found["completion"] = run["figures"]["completion"]
    found["peak_memory_mb"] = report["peak_memory_mb"]
    return found | {kind: _score(scene, kind) for kind in FOUND}


def _score(scene: dict[str, Any] | None, kind: str) -> dict[str, int] | None:
    if scene is None:
        return None
    group = "building_components" if kind == "walls" else "structural_elements"
    score = scene[group][kind]
    if score["detected"] is None:
        return None
    return {"found": score["detected"], "true": score["true"], "false": score["false"]}


def run_folder(key: dict[str, Any]) -> str:
    """A name for the results of a run, different for different keys."""
    digest = hashlib.sha256(json.dumps(key, sort_keys=True).encode()).hexdigest()[:8]
    return f"{key['place']}-{key['variant']}-draw{key['draw']}-seed{key['seed']}-{digest}"


class Results:
    """Runs as lines of JSON, appended one by one, so that what was stopped can be gone on with."""

    def __init__(self, file: Path) -> None:
        """Raises ValueError for a file that something else wrote."""
        self._file, self._lock = file, threading.Lock()
        text = file.read_text() if file.exists() else ""
        whole, _, torn = text.rpartition("\n")
        try:
            rows = [json.loads(line) for line in whole.splitlines() if line]
            self._rows: list[Row] = [{name: row[name] for name in ("key", "figures")} for row in rows]
        except (ValueError, TypeError, KeyError) as error:
            raise ValueError(f"{file} is no file of this program: {error}") from None
        if torn:  # stopped in the middle of a line: that run is made again
            file.write_text(whole + "\n" if whole else "")

    def of(self, key: dict[str, Any]) -> Row | None:
        """The run of this key, if it was made."""
        with self._lock:
            return next((row for row in self._rows if row["key"] == key), None)

    def add(self, key: dict[str, Any], figures: dict[str, Any]) -> None:
        """Keeps a run."""
        row = {"key": key, "figures": figures}
        with self._lock:
            self._rows.append(row)
            self._file.parent.mkdir(parents=True, exist_ok=True)
            with self._file.open("a") as file:
                file.write(json.dumps(row) + "\n")
