"""Threshold: a condition on the results, such as distance > 1 um, and where it begins to hold over two axes."""

from __future__ import annotations

import difflib
import re
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from active_surface.arrays import BoolArray, FloatArray
from active_surface.studies.record import COLUMNS, OUTCOMES, REFUSED
from coupling.case import Quantity, quoted

if TYPE_CHECKING:
    import xarray


EXAMPLES: Final = {"m": "1 um", "s": "1 ms", "N": "1 uN"}
OF_REFUSED: Final = ("outcome", "mistakes")
"""Columns with a meaning at refused points."""
EXPECTED: Final = 'a condition such as "distance > 1 um" or "outcome = stuck"'


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
        raise ValueError(f"must be {EXPECTED}; the results have no {column}, but {_named(column, COLUMNS)}")
    if (sign == "=") != (column == "outcome"):
        raise ValueError(f"must have < or > for a figure, and = for the outcome; got {quoted(text)}")
    if column == "outcome":
        if value not in OUTCOMES:
            raise ValueError(f"must be {EXPECTED}; there is no outcome {value}, but {_named(value, OUTCOMES)}")
        return Threshold(column, sign, OUTCOMES.index(value), condition)
    unit = COLUMNS[column].unit
    if unit in EXAMPLES:
        return Threshold(column, sign, Quantity(unit, EXAMPLES[unit]).parse(value), condition)
    if not re.fullmatch(r"[+-]?\d+(\.\d*)?(e[+-]?\d{1,2})?", value, re.IGNORECASE):
        raise ValueError(f"must compare {column} with a number; got {quoted(value)}")
    return Threshold(column, sign, float(value), condition)


def _named(word: str, known: Any) -> str:
    return ", ".join(difflib.get_close_matches(word, known, 1) or known)


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
