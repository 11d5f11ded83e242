"""Record: what is kept of a path, as a row of an array, and what each column means."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle import Outcome, Trajectory

Records = NDArray[np.void]


class Column(NamedTuple):
    """A column of a record."""

    kind: str  # numpy's
    unit: str
    meaning: str


COLUMNS: Final = {
    "start_x": Column("f8", "m", "x at the start, jitter included"),
    "start_y": Column("f8", "m", "y at the start, jitter included"),
    "end_x": Column("f8", "m", "x at the end"),
    "end_y": Column("f8", "m", "y at the end"),
    "end_time": Column("f8", "s", "when the path ended"),
    "distance": Column("f8", "m", "from start to end"),
    "path_length": Column("f8", "m", "length of the way"),
    "last_motion": Column("f8", "s", "when the part moved last; 0: never"),
    "largest_load": Column("f8", "N", "largest normal force at events and steps"),
    "outcome": Column("i1", "", "how the path ended"),
    "evaluations": Column("i8", "1", "evaluations of the surface"),
    "mistakes": Column("i4", "1", "how many mistakes a refused point has"),
}
KIND: Final = np.dtype([(name, column.kind) for name, column in COLUMNS.items()])

REFUSED: Final = "refused"
OUTCOMES: Final = (*(outcome.value for outcome in Outcome), REFUSED)
"""The outcomes by their number."""
SENTENCES: Final = (
    *(outcome.sentence for outcome in Outcome),
    "The case of this point has mistakes, or its plate or path cannot be found.",
)


def new_records(count: int) -> Records:
    """Records of refused points: numbers that are not known are nan, counts 0."""
    records = np.zeros(count, KIND)
    for name, column in COLUMNS.items():
        records[name] = np.nan if column.kind == "f8" else 0
    records["outcome"] = OUTCOMES.index(REFUSED)
    return records


def put(records: Records, k: int, start: Sequence[float], trajectory: Trajectory) -> None:
    """Make row k the record of a path from a start (x, y) [m]."""
    at_rest, end = trajectory.at_rest_since, float(trajectory.time[-1])
    records[k] = (
        *start,
        *trajectory.position[-1].tolist(),
        end,
        trajectory.distance,
        trajectory.path_length,
        end if at_rest is None else at_rest,
        trajectory.normal_force.max(),
        OUTCOMES.index(trajectory.outcome.value),
        trajectory.evaluations,
        0,
    )
