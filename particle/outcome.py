"""Outcome: the states of a part, and how its run ended, for people."""

from __future__ import annotations

import enum


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
    Outcome.WORK_LIMIT: "The integrator stopped at its limit of work before the end of the run.",
}
