"""What a building is asked to be, and what its offices hold."""

from __future__ import annotations

from dataclasses import dataclass, field

from vsgraphs.plans.buildings.draw import Draw
from vsgraphs.plans.buildings.furnishing import Density, Furnishing, make_furnishing
from vsgraphs.plans.buildings.site import Item


@dataclass(frozen=True)
class Order:
    """What was asked for, checked. Storeys have the same places; the last of upper storeys may stay empty."""

    kind: str
    rooms: int
    furnishings: int
    seed: int
    storeys: int = 1
    density: Density = field(default_factory=Density)
    corridor_posters: bool = True

    @property
    def places(self) -> int:
        """For offices, on each storey."""
        return -(-self.rooms // self.storeys)

    def _numbers(self, storey: int) -> list[int]:
        """Which furnishing each office of a storey has, in the order of the places."""
        here = self.rooms // self.storeys + (storey < self.rooms % self.storeys)
        few = min(self.furnishings, self.places)
        order = Draw(self.seed, "order").shuffled([i % few for i in range(self.places)])[:here]
        if self.furnishings <= self.places:
            return order
        # Others on every storey, but of the same size at the same place.
        numbers = [number + storey * self.places for number in order]
        return numbers if self.furnishings == self.rooms else [n % self.furnishings for n in numbers]

    def _furnishing(self, number: int, density: Density) -> Furnishing:
        return make_furnishing(self.seed, number, number % self.places, density)

    def offices(self, storey: int = 0) -> list[Furnishing]:
        """The furnishings of a storey's offices, in the order of their places."""
        return [self._furnishing(number, self.density) for number in self._numbers(storey)]

    def designs(self) -> list[Item]:
        """What hangs in the offices and hangs in the corridors too."""
        numbers = sorted({number for storey in range(self.storeys) for number in self._numbers(storey)})
        made = [self._furnishing(number, Density()) for number in numbers]
        return [item for each in made for item in each.posters if item["kind"] in ("poster", "board")]
