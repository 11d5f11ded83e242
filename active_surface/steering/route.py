"""Route: a part that is to get from where it starts over one way-point after the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from active_surface.steering.tables import Settings
from active_surface.steering.task import Mistake, Task, misplaced, mistakes
from coupling.case import Case

Place = tuple[float, float]


@dataclass(frozen=True)
class Route:
    """A case whose part is to be carried over way-points (x, y) in m, to each within the case's duration.

    Raises
    ------
    ValueError
        An input makes no sense, such as a way-point off the plate or a first one that cannot be reached; has all.
    """

    case: Case
    through: tuple[Place, ...]  # m
    settings: Settings = field(default_factory=Settings)
    name: str = ""  # of the files that are written; "": that of the case

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", self.name or self.case.name)
        wrong = [] if self.through else ["through must be one way-point or more; got none"]
        for number, place in enumerate(self.through):
            # Where legs after the first begin is not known yet: `leg` looks at what depends on it.
            known = mistakes(self.case, self.settings, place) if number == 0 else _misplaced(self.case, place)
            wrong += [f"{f'way-point {number}' if key == 'target' else key} {message}" for key, message in known]
        if wrong:
            raise ValueError("\n".join(wrong))

    def leg(self, number: int, start: Place) -> Task:
        """What is to be done to get to a way-point, counted from 0, from a place [m] where the part rests.

        Raises ValueError where it cannot be reached from there.
        """
        part = self.case.part.model_copy(update={"position": start, "velocity": (0.0, 0.0)} if number else {})
        case = self.case.model_copy(update={"part": part, "source": None})
        return Task(case, self.through[number], self.settings, f"{self.name}_{number}")


def _misplaced(case: Case, place: Place) -> Iterator[Mistake]:
    yield from (("target", message) for message in misplaced(case, place))
