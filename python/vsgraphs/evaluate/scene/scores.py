"""What a comparison with the truth comes to."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

NOT_ESTIMATED = "not estimated"


@dataclass
class Match:
    """An estimated entity, the true one it is, and how far it is off (units in the names)."""

    estimated: int
    true: str
    errors: dict[str, float]


@dataclass
class Detection:
    """Entities of one kind.

    true: how many must be found. matches: one for each that was, by its best piece. correct, false:
    estimated entities that are (not) a true one that must be found; duplicates: those of `false` that
    describe one that was found already. ignored: estimated ones that are true but not scored. correct is
    None where nobody looked for this kind: that is no score of zero.
    """

    true: int
    matches: list[Match] = field(default_factory=list)
    correct: int | None = 0
    false: int = 0
    duplicates: int = 0
    ignored: int = 0
    error_names: tuple[str, ...] = ()

    @property
    def estimated(self) -> bool:
        """Whether this kind was looked for at all."""
        return self.correct is not None

    @property
    def detected(self) -> int | None:
        """True entities found."""
        return len(self.matches) if self.estimated else None

    @property
    def precision(self) -> float | None:
        """Correct share of the estimated ones; None if there are none."""
        if self.correct is None or self.correct + self.false == 0:
            return None
        return self.correct / (self.correct + self.false)

    @property
    def recall(self) -> float | None:
        """Found share of the true ones; None if there are none."""
        return len(self.matches) / self.true if self.estimated and self.true else None

    @property
    def f1(self) -> float | None:
        """Harmonic mean of both; 0 where nothing right was found, None where there was nothing to find."""
        if self.recall is None:
            return None
        precision = self.precision or 0.0
        total = precision + self.recall
        return 2 * precision * self.recall / total if total else 0.0

    def mean_error(self, name: str) -> float | None:
        """Mean over the matches."""
        values = [match.errors[name] for match in self.matches if name in match.errors]
        return sum(values) / len(values) if values else None

    def to_json(self) -> dict[str, Any]:
        """Plain values; null for what was not estimated."""
        out: dict[str, Any] = {
            "detected": self.detected,
            "true": self.true,
            "precision": self.precision,
            "recall": self.recall,
            "f1": self.f1,
            **{name: self.mean_error(name) for name in self.error_names},
        }
        if not self.estimated:
            return {**out, "note": NOT_ESTIMATED}
        out |= {"correct": self.correct, "false": self.false, "duplicates": self.duplicates}
        out["ignored"] = self.ignored
        out["matches"] = [{"estimated": m.estimated, "true": m.true, **m.errors} for m in self.matches]
        return out


def not_estimated(true: int, error_names: tuple[str, ...]) -> Detection:
    """The score of a kind that nobody looked for."""
    return Detection(true=true, correct=None, error_names=error_names)


def together(*parts: Detection) -> Detection:
    """Several kinds counted as one."""
    known = [part for part in parts if part.correct is not None]
    return Detection(
        true=sum(part.true for part in known),
        matches=[match for part in known for match in part.matches],
        correct=sum(part.correct or 0 for part in known),
        false=sum(part.false for part in known),
        duplicates=sum(part.duplicates for part in known),
        ignored=sum(part.ignored for part in known),
        error_names=known[0].error_names if known else (),
    )


@dataclass
class MapScore:
    """Distances of map points to the nearest true surface: walls, floors and ceilings of all rooms.

    rmse_m: of all points, furniture too (the truth holds none, so it counts as error). structural_*: of the
    points at most near_m from a surface. share_within: of all points, those at most within_m from one.
    """

    points: int
    rmse_m: float
    median_m: float
    near_m: float
    structural_points: int
    structural_rmse_m: float | None
    within_m: float
    share_within: float

    def to_json(self) -> dict[str, Any]:
        """Plain values."""
        return dict(vars(self))


@dataclass
class SceneScores:
    """Scores of a scene graph. structure: structural elements by their section: rooms, floors, doors, others.
    map: None where no points were given.
    """

    walls: Detection
    ground: Detection
    structure: dict[str, Detection]
    map: MapScore | None
    offset_tolerance_m: float
    notes: list[str] = field(default_factory=list)

    @property
    def rooms(self) -> Detection:
        """Of `structure`."""
        return self.structure["rooms"]

    @property
    def floors(self) -> Detection:
        """Of `structure`."""
        return self.structure["floors"]

    @property
    def doors(self) -> Detection:
        """Of `structure`."""
        return self.structure["doors"]

    @property
    def building_components(self) -> Detection:
        """Walls and grounds as one kind, as the paper counts them."""
        return together(self.walls, self.ground)

    def to_json(self) -> dict[str, Any]:
        """Plain values, units in the names."""
        all_components = self.building_components.to_json()
        all_components.pop("matches", None)
        return {
            "building_components": {
                "all": all_components,
                "walls": self.walls.to_json(),
                "ground": self.ground.to_json(),
            },
            "structural_elements": {name: score.to_json() for name, score in self.structure.items()},
            "map": None if self.map is None else self.map.to_json(),
            "offset_tolerance_m": self.offset_tolerance_m,
            "notes": self.notes,
        }
