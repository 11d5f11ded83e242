"""Scratch memory of the path of a part with a face."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.body.averages import new_locals, prepare_locals
from particle.body.balance import Balance, new_balance
from particle.body.collocation import STAGES
from particle.body.face import Face
from particle.body.limit import Search, new_search
from particle.events.mechanics import Counts, Now
from particle.events.record import Row
from particle.records import new_records
from particle.surface import LocalSurface, Surface
from particle.types import FloatArray, IntArray

X, Y, HEADING, V_X, V_Y, SPIN, WORK, LOSS = range(8)
STATE = 8  # numbers of a state: place, its rates, and the ledger


class Memory(NamedTuple):
    """Scratch memory of a path."""

    local: LocalSurface  # one for each point of the face, with an axis in front
    slots: IntArray  # (n,) which of them each point has
    balance: Balance
    search: Search
    state: FloatArray  # (8,)
    lead: FloatArray  # (2, 3) acceleration and jerk, from which a step's stages are guessed
    stages: FloatArray  # (5, 8), their states; in the ledger their powers
    rates: FloatArray  # (5, 3), their accelerations
    margins: FloatArray  # (5,) how far each is from the end of contact
    turns: FloatArray  # (5, 3, 3), by how much their accelerations change with their rates
    system: FloatArray  # (15, 16)
    steps: FloatArray  # (15,)
    end: FloatArray  # (8,), the state at the end of the step
    now: NDArray[Now]  # (1,)
    counts: NDArray[Counts]  # (1,)
    row: NDArray[Row]  # (1,) what is about to be recorded
    stop: IntArray  # (1,) another thread sets it to 1 when nobody waits for the path any more


def new_memory(surface: Surface, face: Face, stop: IntArray) -> Memory:
    """Scratch memory that fits surface and face."""
    points, unknowns = len(face.places), 3 * STAGES
    local = new_locals(surface, points)
    prepare_locals(surface, local)
    return Memory(
        *(local, np.zeros(points, dtype=np.int64), new_balance(), new_search(), np.zeros(STATE), np.zeros((2, 3))),
        *(np.zeros((STAGES, STATE)), np.zeros((STAGES, 3)), np.zeros(STAGES), np.zeros((STAGES, 3, 3))),
        *(np.zeros((unknowns, unknowns + 1)), np.zeros(unknowns), np.zeros(STATE)),
        *(new_records(Now), new_records(Counts), new_records(Row), stop),
    )
