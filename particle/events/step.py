"""Scratch memory and result of one Runge-Kutta step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.events.mechanics import Motion, as_numbers
from particle.events.tableau import Pairs
from particle.records import new_records
from particle.types import FloatArray


class Step(NamedTuple):
    """Scratch memory and result of a step. Names with `_numbers` are the same memory without names."""

    rates: NDArray[Motion]  # (stages + 1,)
    rate_numbers: FloatArray  # (stages + 1, SIZE)
    stage: NDArray[Motion]  # (1,)
    stage_numbers: FloatArray  # (1, SIZE)
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
        stage_numbers=as_numbers(stage),
        end=new_records(Motion),
        plane=new_records(Motion),
        loads=np.zeros(stages),
        margins=np.zeros(stages),
    )
