"""Scratch memory of the path of a part on a film of air."""

from __future__ import annotations

from typing import Annotated, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.body import STAGES, Face, new_body_memory
from particle.events import Row
from particle.events.mechanics import Counts, Now
from particle.film.film import FUNCTIONS
from particle.film.gap import Gap
from particle.group import grouped
from particle.records import Record, new_records
from particle.surface import LocalSurface, Surface, new_local
from particle.types import FloatArray, IntArray

X, Y, V_X, V_Y, CONTENTS = range(5)
HEADING: Final = CONTENTS + FUNCTIONS
SPIN: Final = HEADING + 1  # of a part with a face; else these two are 0
SOLVED: Final = SPIN + 1  # numbers that collocation solves for: place, velocity and contents
WORK, LOSS, HEAT, PUMPED, Z, STORED = range(SOLVED, SOLVED + 6)  # two ledgers, and where the gap is looked for
RATES: Final = PUMPED  # numbers that have a rate at each stage
STATE: Final = STORED + 1


class Step(Record):
    """The state of part and film, and a step from it."""

    state: Annotated[FloatArray, STATE]
    end: Annotated[FloatArray, STATE]  # that at the end of the step
    probe: Annotated[FloatArray, STATE]  # that at a moment which is looked at
    rate: Annotated[FloatArray, RATES]  # as the step begins
    stages: Annotated[FloatArray, STAGES, STATE]
    rates: Annotated[FloatArray, STAGES, RATES]  # at the stages
    residuals: Annotated[FloatArray, STAGES, SOLVED]
    changes: Annotated[FloatArray, STAGES, SOLVED]  # Newton's step
    lead: Annotated[FloatArray, STAGES, SOLVED]  # the rate in powers of the time ahead: from it stages are guessed
    past: Annotated[FloatArray, STAGES, SOLVED]  # the rate over the step in powers of its share less 1
    turns: Annotated[FloatArray, SOLVED, SOLVED]  # by how much rates change with the state
    system: Annotated[FloatArray, SOLVED, SOLVED + 1]
    off: Annotated[FloatArray, SOLVED]
    before: float  # s, the last step


@grouped
class Memory(NamedTuple):
    """Scratch memory of a path."""

    local: LocalSurface  # of a part with a face those of `body`
    body: Any  # the memory of `body`, the equations of a part with a face; of a point None
    gap: NDArray[Gap]  # (STAGES + 2,) as a step begins, at its stages, and at a moment that is looked at
    step: NDArray[Step]  # (1,)
    system: NDArray[np.complex128]  # (SOLVED, SOLVED + 1)
    ahead: NDArray[np.complex128]  # (SOLVED,)
    now: NDArray[Now]  # (1,)
    counts: NDArray[Counts]  # (1,)
    row: NDArray[Row]  # (1,) what is about to be recorded
    stop: IntArray  # (1,) another thread sets it to 1 when nobody waits for the path any more


def new_memory(surface: Surface, face: Face | None, stop: IntArray) -> Memory:
    """Scratch memory that fits surface and face."""
    body = None if face is None else new_body_memory(surface, face, stop)
    gap = new_records(Gap, STAGES + 2)
    for each in gap:
        each.at = np.nan  # nothing is known yet
    return Memory(
        local=new_local(surface) if body is None else body.local,
        body=body,
        gap=gap,
        step=new_records(Step),
        system=np.zeros((SOLVED, SOLVED + 1), dtype=np.complex128),
        ahead=np.zeros(SOLVED, dtype=np.complex128),
        now=new_records(Now) if body is None else body.now,
        counts=new_records(Counts) if body is None else body.counts,
        row=new_records(Row),
        stop=stop,
    )
