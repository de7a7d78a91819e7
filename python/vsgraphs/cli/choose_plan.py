"""What `vsgraphs simulate` renders: a plan by name or file, or a generated building."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from vsgraphs.errors import InputError
from vsgraphs.export.atomic import write_atomically
from vsgraphs.plans import building, drawn, load_plan, plan_path, plan_text
from vsgraphs.reading import read_text


@dataclass(frozen=True)
class PlanChoice:
    """The command's options; None: not given."""

    name: str | None
    building: str | None = None
    rooms: int | None = None
    furnishings: int | None = None
    storeys: int | None = None
    seed: int = 0
    drawn: str | None = None
    robot: bool = False

    def plan(self) -> str | Mapping[str, Any]:
        """A name or file, or the building's plan. Raises InputError."""
        given = {"rooms": self.rooms, "furnishings": self.furnishings, "storeys": self.storeys}
        options: dict[str, Any] = {key: value for key, value in given.items() if value is not None}
        if self.robot and self.drawn is None:
            raise InputError("--robot goes with --drawn; a plan says it with path.robot")
        if self.drawn is not None:
            return self._drawn(options)
        if self.building is None:
            if self.name is None:
                raise InputError(
                    "what to simulate? give a PLAN (a name or a file), or --building KIND, or --drawn KIND"
                )
            if options:
                raise InputError(f"--{next(iter(options))} goes with --building, not with a PLAN")
            return self.name
        if self.name is not None:
            raise InputError(f"give either the plan {self.name} or --building {self.building}, not both")
        if self.storeys is not None and self.building != "storeys":
            raise InputError(f"--storeys goes with --building storeys, not with {self.building}")
        return building(self.building, seed=self.seed, **options)

    def _drawn(self, options: dict[str, Any]) -> Mapping[str, Any]:
        for other, value in (("the plan", self.name), ("--building", self.building)):
            if value is not None:
                raise InputError(f"give either {other} {value} or --drawn {self.drawn}, not both")
        if options:
            raise InputError(f"--{next(iter(options))} goes with --building, not with --drawn")
        return drawn(self.drawn or "", self.seed, carrier="robot" if self.robot else "hand")


def write_plan(choice: PlanChoice, file: Path, *, overwrite: bool, with_out: bool) -> None:
    """`--plan-only`: the plan as a file that can be edited. Raises InputError."""
    if with_out:
        raise InputError("--plan-only renders nothing: leave --out away")
    plan = choice.plan()
    if file.exists() and not overwrite:
        raise InputError(f"{file} exists: choose another name, or allow overwriting it with --overwrite")
    load_plan(plan)
    text = read_text(plan_path(plan), "plan") if isinstance(plan, str) else plan_text(plan)
    write_atomically(file, text)
    print(f"plan in {file}")
