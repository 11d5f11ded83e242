"""Scratch memory of the path of a part with a face."""

from __future__ import annotations

from typing import Annotated, Final, NamedTuple

from numpy.typing import NDArray

from particle.body.averages import Under, new_locals, new_under, prepare_locals
from particle.body.balance import Balance
from particle.body.collocation import STAGES
from particle.body.face import Face
from particle.body.limit import Search
from particle.events import Row
from particle.events.mechanics import Counts, Now
from particle.group import grouped
from particle.records import Record, new_records
from particle.surface import LocalSurface, Surface
from particle.types import FloatArray, IntArray

X, Y, HEADING, V_X, V_Y, SPIN, WORK, LOSS = range(8)
UNKNOWNS: Final = 3 * STAGES
STATE: Final = 8  # numbers of a state: place, its rates, and the ledger


class Step(Record):
    """The state of a part, and a step from it."""

    state: Annotated[FloatArray, STATE]
    lead: Annotated[FloatArray, STAGES, 3]  # acceleration in powers of the time ahead: from it stages are guessed
    stages: Annotated[FloatArray, STAGES, STATE]  # their states; in the ledger their powers
    rates: Annotated[FloatArray, STAGES, 3]  # their accelerations
    margins: Annotated[FloatArray, STAGES]  # how far each is from the end of contact
    turns: Annotated[FloatArray, STAGES, 3, 3]  # by how much their accelerations change with their rates
    system: Annotated[FloatArray, UNKNOWNS, UNKNOWNS]  # of Newton's steps, factorised
    pivots: Annotated[FloatArray, UNKNOWNS]  # its rows' order
    steps: Annotated[FloatArray, UNKNOWNS]
    end: Annotated[FloatArray, STATE]  # the state at the end of the step
    friction: float  # 1/s, friction's own rate as a step begins
    before: float  # s, the last step
    error: float  # that step's, over the tolerance
    speed: float  # m/s, of the slip as a step begins
    carried: Annotated[FloatArray, 6]  # the face's carried twist before a breakpoint
    gap: Annotated[FloatArray, 3]  # of a local contact as a step begins


@grouped
class Memory(NamedTuple):
    """Scratch memory of a path."""

    local: LocalSurface  # one for each point of the face, with an axis in front
    under: Under
    balance: NDArray[Balance]  # (1,)
    search: NDArray[Search]  # (1,)
    step: NDArray[Step]  # (1,)
    now: NDArray[Now]  # (1,)
    counts: NDArray[Counts]  # (1,)
    row: NDArray[Row]  # (1,) what is about to be recorded
    stop: IntArray  # (1,) another thread sets it to 1 when nobody waits for the path any more


def new_memory(surface: Surface, face: Face, stop: IntArray) -> Memory:
    """Scratch memory that fits surface and face."""
    local = new_locals(surface, len(face.places))
    prepare_locals(surface, local)
    return Memory(
        local=local,
        under=new_under(len(face.places)),
        balance=new_records(Balance),
        search=new_records(Search),
        step=new_records(Step),
        now=new_records(Now),
        counts=new_records(Counts),
        row=new_records(Row),
        stop=stop,
    )
