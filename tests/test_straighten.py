"""Lenses beyond Brown and Conrady's: their images become a pinhole's at reading."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from vsgraphs.datasets import open_sequence, read_camera_file
from vsgraphs.datasets.calibration import Calibration, LensModel
from vsgraphs.datasets.straighten import StraightGrid, bend
from vsgraphs.errors import InputError
from vsgraphs.plans import plan_path
from vsgraphs.simulate import Output, simulate

CAMERA = {"width": 160, "height": 120, "fx": 110.0, "fy": 110.0, "cx": 79.5, "cy": 59.5}
KANNALA, RATIONAL = [0.03, -0.02, 0.004, -0.001], [-0.2, 0.05, 0.002, -0.001, 0.01, 0.03, 0.01, 0.0]


def test_kannala_brandt_against_its_formula() -> None:
    x, y = 0.6, -0.3
    theta = math.atan(math.hypot(x, y))
    bent = theta + 0.03 * theta**3 - 0.02 * theta**5 + 0.004 * theta**7 - 0.001 * theta**9
    found = bend(LensModel("kannala_brandt", tuple(KANNALA)), np.array(x), np.array(y))
    assert np.hypot(*found) == pytest.approx(bent)
    assert found[1] / found[0] == pytest.approx(y / x)


def test_rational_against_its_formula() -> None:
    x, y = 0.5, 0.4
    k1, k2, p1, p2, k3, k4, k5, k6 = RATIONAL
    r2 = x * x + y * y
    scale = (1 + k1 * r2 + k2 * r2**2 + k3 * r2**3) / (1 + k4 * r2 + k5 * r2**2 + k6 * r2**3)
    found = bend(LensModel("rational", tuple(RATIONAL)), np.array(x), np.array(y))
    assert found[0] == pytest.approx(x * scale + 2 * p1 * x * y + p2 * (r2 + 2 * x * x))
    assert found[1] == pytest.approx(y * scale + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y)


@pytest.mark.parametrize(("lens", "k"), [("kannala_brandt", KANNALA), ("rational", RATIONAL)])
def test_what_is_simulated_through_a_lens_reads_as_through_none(
    lens: str, k: list[float], tmp_path: Path
) -> None:
    plan_effects = {"bent": {"lens": lens, "lens_k": k}, "straight": {}}
    loaded = {}
    for name, effects in plan_effects.items():
        plan = {**json.loads(plan_path("demo").read_text()), "camera": CAMERA}
        output = Output(image_format="png", labels_every=0, every=150)
        simulate(plan, tmp_path / name, sensor="clean", effects=effects, frames=2, output=output)
        sequence = open_sequence(tmp_path / name)
        loaded[name] = [frame.load() for frame in sequence.frames][1]
        assert sequence.camera.fx == 110.0
    (bent, bent_depth), (straight, depth) = loaded["bent"], loaded["straight"]
    seen = (bent_depth > 0) & (depth > 0)
    assert seen.mean() > 0.6
    off = np.abs(bent_depth[seen].astype(float) / depth[seen] - 1)
    assert np.median(off) < 0.004
    assert (off < 0.03).mean() > 0.93
    assert np.median(np.abs(bent[seen].astype(float) - straight[seen])) < 4
    raw = np.abs(bent[seen].astype(float) - np.roll(straight, 3, axis=1)[seen])
    assert np.median(np.abs(bent[seen].astype(float) - straight[seen])) < 0.6 * np.median(raw)


def test_pixels_the_lens_does_not_show_are_empty() -> None:
    narrow, wide = (Calibration(**{**CAMERA, "cx": cx}) for cx in (79.5, 120.0))  # type: ignore[arg-type]
    ones = np.full((120, 160), 7, np.uint16)
    assert (StraightGrid(narrow, LensModel("kannala_brandt", (-0.1,))).depth(ones) == 7).all()
    grid = StraightGrid(wide, LensModel("rational", (0.4,)))
    assert (grid.depth(ones)[:, 0] == 0).all()
    assert (grid.colour(np.full((120, 160, 3), 9, np.uint8))[60, 0] == 0).all()


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (
            "model: rational\nmodel_coefficients: [1, 2, 3, 4, 5, 6, 7, 8, 9]\n",
            "at most 8 model_coefficients, not 9",
        ),
        ("model: kannala_brandt\n", "model_coefficients is null, expected a list"),
        ("model: equidistant\nmodel_coefficients: [0.1]\n", "go with model: kannala_brandt or rational"),
        ("model: rational\nmodel_coefficients: [0.1]\ndistortion: [0.1, 0, 0, 0]\n", "not both"),
    ],
)
def test_wrong_lenses_are_named(lines: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "camera.yaml"
    path.write_text("".join(f"{key}: {value}\n" for key, value in CAMERA.items()) + lines)
    with pytest.raises(InputError, match=message):
        read_camera_file(path)
