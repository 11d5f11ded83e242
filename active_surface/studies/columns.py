"""Columns: what is kept of a path, as a row of an array, and conditions on it, such as distance > 1 um."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from active_surface.arrays import BoolArray, FloatArray
from coupling import near
from coupling.case import Quantity, quoted
from particle import Outcome, Trajectory

if TYPE_CHECKING:
    import xarray

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
    "turned": Column("f8", "rad", "from the heading at the start to that at the end; nan: a point"),
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
EXAMPLES: Final = {"m": "1 um", "s": "1 ms", "N": "1 uN", "rad": "5 deg"}
OF_REFUSED: Final = ("outcome", "mistakes")
"""Columns with a meaning at refused points."""
EXPECTED: Final = 'a condition such as "distance > 1 um" or "outcome = stuck"'


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
        np.nan if trajectory.heading is None else trajectory.heading[-1] - trajectory.heading[0],
        end if at_rest is None else at_rest,
        trajectory.normal_force.max(),
        OUTCOMES.index(trajectory.outcome.value),
        trajectory.evaluations,
        0,
    )


class Threshold(NamedTuple):
    """A column of the results, a comparison, and the level: an SI value, or the number of an outcome."""

    column: str
    sign: str  # <, > or =
    level: float
    text: str

    def holds(self, dataset: xarray.Dataset, repeats: int) -> BoolArray:
        """Whether the condition holds at each point, or for at least half of its repeats, the last dimension."""
        values: NDArray[Any] = dataset[self.column].values
        compare = {"<": np.less, ">": np.greater, "=": np.equal}[self.sign]
        holds: BoolArray = compare(values, self.level)
        if self.column not in OF_REFUSED:  # whose other counts are numbers, too
            holds &= dataset["outcome"].values != OUTCOMES.index(REFUSED)
        return holds.mean(axis=-1) >= 0.5 if repeats > 1 else holds


def read_threshold(text: object) -> Threshold:
    """The condition in a text; raises ValueError with what is wrong with it."""
    match = re.fullmatch(r"\s*(\w+)\s*([<>=])\s*(\S.*?)\s*", text) if isinstance(text, str) else None
    if match is None:
        raise ValueError(f"must be {EXPECTED}; got {quoted(text)}")
    column, sign, value = match.groups()
    condition = f"{column} {sign} {value}"
    if column not in COLUMNS:
        raise ValueError(
            f"must be {EXPECTED}; the results have no {column}, but {near(column, COLUMNS) or ', '.join(COLUMNS)}"
        )
    if (sign == "=") != (column == "outcome"):
        raise ValueError(f"must have < or > for a figure, and = for the outcome; got {quoted(text)}")
    if column == "outcome":
        if value not in OUTCOMES:
            raise ValueError(
                f"must be {EXPECTED}; there is no outcome {value}, but {near(value, OUTCOMES) or ', '.join(OUTCOMES)}"
            )
        return Threshold(column, sign, OUTCOMES.index(value), condition)
    unit = COLUMNS[column].unit
    if unit in EXAMPLES:
        return Threshold(column, sign, Quantity(unit, EXAMPLES[unit]).parse(value), condition)
    if not re.fullmatch(r"[+-]?\d+(\.\d*)?(e[+-]?\d{1,2})?", value, re.IGNORECASE):
        raise ValueError(f"must compare {column} with a number; got {quoted(value)}")
    return Threshold(column, sign, float(value), condition)


def lowest(up: FloatArray, holds: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Where along the second axis a condition begins to hold, for each value of the first one.

    up: its values (m,), in any order.  holds: (n, m).
    Returns (n,) twice: the lowest value where it holds, nan where it does nowhere; and the value before, where it does
    not yet, nan where it holds from the first value on.
    """
    order = np.argsort(up)
    values, ordered = up[order], holds[:, order]
    first = np.argmax(ordered, axis=1)
    anywhere = ordered.any(axis=1)
    return (
        np.where(anywhere, values[first], np.nan),
        np.where(anywhere & (first > 0), values[first - 1], np.nan),
    )
