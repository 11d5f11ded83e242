"""What a part does, how its path ends, and what happens to it at one moment: for kernels, and for people."""

from __future__ import annotations

import enum


class Mode(enum.IntEnum):
    """What a part does; the first three are also the states of a trajectory."""

    RESTING = 0
    SLIDING = 1
    FLYING = 2
    MANIFOLD = 3  # it slides, in its first moments (`events.breakaway`)


class Verdict(enum.IntEnum):
    """How a path ends; the last three are no ends: a cell is lacking, nobody waits any more, or a jump is refused."""

    GOES_ON = 0
    DETACHED = 1
    LEFT_PLATE = 2
    OVERLOADED = 3
    TIPPED = 4
    WORK_LIMIT = 5
    LACKS_CELL = 6
    INTERRUPTED = 7
    JUMPS = 8


class EventKind(enum.IntEnum):
    """What happens to the part at one moment."""

    SLIPS = 0  # begins to slide
    STOPS = 1  # comes to rest on the surface
    REVERSES = 2  # stops sliding and slides on in another direction at once
    DETACHES = 3  # comes off
    LEAVES_PLATE = 4  # goes over the rim
    OVERLOADS = 5  # is pressed on more than the friction law covers
    TIPS = 6  # lifts an edge of its face
    LANDS = 7  # touches the surface again after a flight


NO_EVENT = -1
END_EVENTS = 2  # the event of a path that ends is EventKind(END_EVENTS + verdict)


class State(enum.IntEnum):
    """How the part is in contact."""

    STICK = 0  # at rest on the surface
    SLIP = 1  # sliding
    FLIGHT = 2  # off the surface


class Outcome(enum.StrEnum):
    """How a run ended; `sentence` says it in full."""

    STUCK = "stuck"
    MOVING = "moving"
    DETACHED = "detached"
    LEFT_PLATE = "left the plate"
    OVERLOADED = "overloaded"
    TIPPED = "tipped"
    WORK_LIMIT = "work limit"

    @property
    def sentence(self) -> str:
        """What happened, in one sentence."""
        return _SENTENCES[self]


_SENTENCES = {
    Outcome.STUCK: "The part rests on the surface at the end of the run.",
    Outcome.MOVING: "The part is still on the move at the end of the run.",
    Outcome.DETACHED: "The surface pulled away faster than adhesion could follow: the part came off.",
    Outcome.LEFT_PLATE: "The part went over the rim of the plate.",
    Outcome.OVERLOADED: "The load on the part is more than the contact model covers.",
    Outcome.TIPPED: "An edge of the part lifted: it tips over, or rocks.",
    Outcome.WORK_LIMIT: "The integrator stopped at its limit of work before the end of the run.",
}
