"""The hall in which corridors meet: a regular polygon, every other side open to one."""

from __future__ import annotations

import math

from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.buildings.furnishing import Density
from vsgraphs.plans.buildings.office import WALL_M
from vsgraphs.plans.buildings.site import Frame, Site
from vsgraphs.plans.buildings.wing import MIDDLE_M

_SIDE_M = 2.4  # at least: an opening between corridors and something beside it
_MIN_APOTHEM_M = 2.6

_THINGS = (
    ("sofa", 1.6, 0.8, 0.8),
    ("sideboard", 1.2, 0.42, 0.8),
    ("drawers", 0.8, 0.45, 0.9),
    ("plant", 0.4, 0.4, 1.2),
)


class Hall:
    """Centre at the origin; side 2 i faces arm i. arms: sides that could open; open_arms: those that do."""

    name = "H"

    def __init__(self, site: Site, arms: int, open_arms: int, seed: int) -> None:
        self._site, self._arms, self._open, self._seed = site, arms, open_arms, seed
        half_angle = math.pi / (2 * arms)
        self._apothem = round(max(_MIN_APOTHEM_M, _SIDE_M / 2 / math.tan(half_angle)), 3)
        self._side = 2 * self._apothem * math.tan(half_angle)
        self.reach = self._apothem + WALL_M  # from the centre to where a corridor begins

    def _sides(self) -> list[tuple[int, Frame]]:
        """Of each closed side: its wall's number and a frame with its middle as origin, y into the hall."""
        closed = [i for i in range(2 * self._arms) if i % 2 or i // 2 >= self._open]
        turned = [(i, Frame(angle_deg=180 * i / self._arms)) for i in closed]
        return [(i, frame.part(self._apothem, 0, 90)) for i, frame in turned]

    def arm(self, number: int) -> Frame:
        """Of the corridor at an arm: its start, on its right-hand side."""
        return Frame(angle_deg=360 * number / self._arms).part(self.reach, -MIDDLE_M)

    def build(self, density: Density) -> None:
        """Room, furniture and pictures; each closed side has its own."""
        radius = self._apothem / math.cos(math.pi / (2 * self._arms))
        angles = [180 * (i - 0.5) / self._arms for i in range(2 * self._arms)]
        corners = [Frame(angle_deg=angle).point((radius, 0)) for angle in angles]
        room = {"id": self.name, "polygon": corners, "floor": "tiles", "wall_colour": "#d8d2c4"}
        self._site.rooms.append(room)
        draw = Draw(self._seed, "hall")
        things = draw.shuffled(_THINGS)
        for number, (wall, frame) in enumerate(self._sides()):
            kind, length, deep, high = things[number % len(things)]
            item = {"kind": kind, "at": (0, deep / 2 + 0.02), "size": [length, deep, high], "yaw_deg": 0.0}
            item["seed"] = draw.seed()
            if draw.chance(density.furniture):
                self._site.box(frame, self.name, item)
            for along in (0.27, 0.73):
                hung = {"room": self.name, "wall": wall, "along": round(along * self._side, 3), "z": 1.6}
                shape = draw.choose((("poster", 0.55, 0.8), ("board", 0.9, 0.75), ("picture", 0.7, 0.5)))
                hung |= {"width": shape[1], "height": shape[2], "kind": shape[0], "seed": draw.seed()}
                if not draw.chance(density.bareness):
                    self._site.posters.append(hung)

    def look_around(self) -> None:
        """Once around in the middle, beginning with the first corridor."""
        for quarter in range(4):
            frame = Frame(angle_deg=90 * quarter)
            self._site.go(frame, self.name, (0.25, 0), (self.reach, 0))

    def cross(self) -> None:
        """Through the middle."""
        self._site.go(Frame(), self.name, (0, 0))
