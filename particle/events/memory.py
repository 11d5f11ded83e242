"""Scratch memory of a path: where the part is, what it does, and what the steps need."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.events.mechanics import Counts, Motion, Now, as_numbers
from particle.events.record import Row
from particle.events.rest import Rest, new_rest
from particle.events.tableau import Pairs
from particle.group import grouped
from particle.records import new_records
from particle.surface import LocalSurface, Surface, new_local, prepare
from particle.types import FloatArray, IntArray


@grouped
class Step(NamedTuple):
    """Scratch memory and result of a step. Names with `_numbers` are the same memory without names."""

    rates: NDArray[Motion]  # (stages + 1,)
    rate_numbers: FloatArray  # (stages + 1, SIZE)
    stage: NDArray[Motion]  # (1,)
    end: NDArray[Motion]  # (1,)
    plane: NDArray[Motion]  # (1,) the motion at the start, its velocity in the plane's coordinates
    loads: FloatArray  # (stages + 1,) N, normal force at each stage
    margins: FloatArray  # (stages + 1,) how far each stage is from the end of contact


def new_step(pairs: Pairs) -> Step:
    stages = len(pairs.long.c)
    rates, stage = new_records(Motion, stages), new_records(Motion)
    return Step(
        rates=rates,
        rate_numbers=as_numbers(rates),
        stage=stage,
        end=new_records(Motion),
        plane=new_records(Motion),
        loads=np.zeros(stages),
        margins=np.zeros(stages),
    )


@grouped
class Memory(NamedTuple):
    """Scratch memory of a path."""

    local: LocalSurface
    rest: Rest
    step: Step
    motion: NDArray[Motion]  # (1,)
    motion_numbers: FloatArray  # (1, SIZE), the same memory without names
    now: NDArray[Now]  # (1,)
    counts: NDArray[Counts]  # (1,)
    row: NDArray[Row]  # (1,) what is about to be recorded
    stop: IntArray  # (1,) another thread sets it to 1 when nobody waits for the path any more


def new_memory(surface: Surface, pairs: Pairs, stop: IntArray) -> Memory:
    """Scratch memory that fits the surface as far as its cells are built."""
    motion = new_records(Motion)
    return Memory(
        local=new_local(surface),
        rest=new_rest(),
        step=new_step(pairs),
        motion=motion,
        motion_numbers=as_numbers(motion),
        now=new_records(Now),
        counts=new_records(Counts),
        row=new_records(Row),
        stop=stop,
    )


def clear_memory(surface: Surface, memory: Memory) -> None:
    """Make the scratch memory of another path, over a surface of the same measures, as good as new."""
    prepare(surface, memory.local)
    for array in (memory.motion, memory.now, memory.counts):
        array[0] = 0
