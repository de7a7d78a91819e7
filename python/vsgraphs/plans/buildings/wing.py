"""A straight corridor with offices on its sides. Its frame: x along it from its start, y across, from 0."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.buildings.furnishing import Furnishing
from vsgraphs.plans.buildings.office import DOOR_M, WALL_M, Office, Storey, add_office, door_place, visit
from vsgraphs.plans.buildings.site import Frame, Item, Site

CORRIDOR_M = 2.0  # width
MIDDLE_M = CORRIDOR_M / 2
PASSAGE_M = 1.6  # width of openings between corridors
_END_M = 0.8  # how near the camera comes to an end


def row_length(furnishings: Sequence[Furnishing]) -> float:
    """Of offices in a row with the walls between them, metres."""
    return sum(f.width + WALL_M for f in furnishings) - WALL_M if furnishings else 0.0


@dataclass
class Wing:
    """name: the corridor's room. seed: of the building."""

    site: Site
    frame: Frame
    name: str
    length: float
    seed: int
    storey: Storey = field(default_factory=Storey)
    offices: list[tuple[float, Office]] = field(default_factory=list)  # x of the door, office
    _openings: dict[str, list[tuple[float, float]]] = field(default_factory=lambda: {"N": [], "S": []})

    def build(self) -> None:
        """The corridor itself."""
        corners = ((0, 0), (self.length, 0), (self.length, CORRIDOR_M), (0, CORRIDOR_M))
        room: Item = {
            "id": self.name,
            "kind": "corridor",
            "polygon": [self.frame.point(corner) for corner in corners],
            "floor": "terrazzo",
            "wall_colour": "#d2cabc",
            **self.storey.keys(),
        }
        self.site.rooms.append(room)

    def part(self, side: str, x: float, width: float) -> Frame:
        """The frame of a room `width` long beside the corridor, beginning at x. side: N (left) or S."""
        if side == "N":
            return self.frame.part(x, CORRIDOR_M + WALL_M)
        return self.frame.part(x + width, -WALL_M, 180)

    def add_row(self, side: str, start: float, furnishings: Sequence[Furnishing], prefix: str) -> None:
        """Offices side by side from `start`, named PREFIX0, PREFIX1, ... (after their storey, if any)."""
        level = f"L{self.storey.level}" if self.site.stacked else ""
        for number, furnishing in enumerate(furnishings):
            door = door_place(Draw(self.seed, "door", prefix, number), furnishing.width)
            frame = self.part(side, start, furnishing.width)
            office = Office(f"{level}{prefix}{number}", frame, furnishing, door)
            add_office(self.site, office, self.name, self.storey)
            x = start + (door if side == "N" else furnishing.width - door)
            self.offices.append((x, office))
            self.keep_open(side, x, DOOR_M)
            start += furnishing.width + WALL_M

    def keep_open(self, side: str, x: float, width: float) -> None:
        """Nothing will hang here."""
        self._openings[side].append((x - width / 2, x + width / 2))

    def hang_posters(self, designs: Sequence[Item], draw: Draw, *, bareness: float, ends: str) -> None:
        """Posters about every four metres, of the offices' designs. ends: the solid ones, of "01"."""
        for side in ("S", "N"):
            taken = [(low - 0.1, high + 0.1) for low, high in self._openings[side]]
            x = 1.95
            while x < self.length - 0.6:
                at = x + draw.uniform(-0.4, 0.4)
                design, hangs = draw.choose(designs), not draw.chance(bareness)
                places = [at + shift for shift in (0, 0.6, -0.6, 1.2, -1.2)]
                half = design["width"] / 2
                free = [
                    p
                    for p in places
                    if half + 0.1 < p < self.length - half - 0.1
                    and all(p + half < low or p - half > high for low, high in taken)
                ]
                if free and hangs:
                    taken.append((free[0] - half - 0.1, free[0] + half + 0.1))
                    along = free[0] if side == "S" else self.length - free[0]
                    self._hang(0 if side == "S" else 2, along, design)
                x += 3.9
        for end in ends:
            picture = {"z": 1.55, "width": 0.6, "height": 0.6, "kind": "picture", "seed": draw.seed()}
            if not draw.chance(bareness):
                self._hang(3 if end == "0" else 1, MIDDLE_M, picture)

    def _hang(self, wall: int, along: float, design: Item) -> None:
        self.site.posters.append({"room": self.name, **design, "wall": wall, "along": round(along, 3)})

    def go(self, x: float, look_x: float | None = None, **more: float) -> None:
        """A way-point in the corridor's middle that looks along it; without look_x along the way."""
        look = None if look_x is None else (look_x, MIDDLE_M)
        self.site.go(self.frame, self.name, (x, MIDDLE_M), look, **more)

    def visit_all(self, draw: Draw, *, backwards: bool = False) -> None:
        """Every office in the order of the doors."""
        for _, office in sorted(self.offices, key=lambda pair: pair[0], reverse=backwards):
            visit(self.site, office, self.name, MIDDLE_M + WALL_M, draw)

    def turn_at_end(self) -> None:
        """To the end's wall and about."""
        self.go(self.length - _END_M, self.length)
        self.go(self.length - _END_M - 0.2, 0.0)
