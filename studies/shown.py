"""Shown: what of a sweep's results its picture shows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from coupling.readable import Unit, readable
from studies.axis import Axis
from studies.record import OUTCOMES
from studies.study import Study
from studies.threshold import BoolArray

if TYPE_CHECKING:
    import xarray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

MOST_POINTS = 100_000  # of random ones
NAMED = "m", "s", "N", "Hz", "m/s", "Pa"
"""Units that take a prefix."""
UNEVEN = 4.0
"""Listed values whose largest step is more times the smallest one are not drawn at their places."""


@dataclass(frozen=True, eq=False)
class Scale:
    """An axis of the picture; what has `texts` is drawn at their numbers, which `values` has."""

    axis: Axis
    unit: Unit
    values: FloatArray
    logarithmic: bool = False
    texts: tuple[str, ...] = ()

    @classmethod
    def of(cls, axis: Axis, values: NDArray[Any]) -> Scale:
        if axis.field.kind == "text":
            texts = tuple(dict.fromkeys(str(value) for value in values))
            return cls(axis, Unit("", 1.0), np.array([texts.index(str(value)) for value in values], float), texts=texts)
        numbers = np.asarray(values, dtype=float)
        unit = _unit(numbers, axis.field.unit)
        return cls(axis, unit, numbers, axis.logarithmic)

    def in_cells(self) -> Scale:
        """The same of ascending values with no cell that is much narrower than others.

        Where steps are uneven, but ratios are not, it is logarithmic; else all cells are as wide, and named.
        """
        if self.texts or self.logarithmic or _even(self.values):
            return self
        if self.values[0] > 0 and _even(np.log(self.values)):
            return replace(self, logarithmic=True)
        names = tuple(f"{value:.6g}" for value in self.drawn)
        return replace(self, unit=Unit(self.unit.name, 1.0), values=np.arange(len(names), dtype=float), texts=names)

    @property
    def label(self) -> str:
        return self.axis.name if self.unit.name in ("", "1") else f"{self.axis.name} [{self.unit.name}]"

    @property
    def drawn(self) -> FloatArray:
        """Its values in its unit."""
        return self.values * self.unit.per_si


def _unit(numbers: FloatArray, si: str) -> Unit:
    if si == "kg" and np.abs(numbers).max() < 1:
        grams = readable(1e3 * numbers, "g")
        return Unit(grams.name, 1e3 * grams.per_si)
    return readable(numbers, si) if si in NAMED else Unit(si, 1.0)


def _even(values: FloatArray) -> bool:
    steps = np.diff(values)
    return len(steps) < 2 or float(steps.max()) <= UNEVEN * float(steps.min())


@dataclass(frozen=True, eq=False)
class Shown:
    """Results along at most two axes of a grid, or at points; repeats are along the last dimension.

    Numbers along an axis of a grid ascend.

    fixed: the values of axes that are not shown, in words.  holds: where the study's threshold holds, if it has one.
    """

    study: Study
    axes: tuple[Scale, ...]
    distance: FloatArray  # m, nan where refused
    outcome: IntArray
    end: FloatArray  # (..., 2) m
    fixed: dict[str, str]
    scattered: bool
    numbers: IntArray  # of the paths
    holds: BoolArray | None = None

    @classmethod
    def of(cls, study: Study, dataset: xarray.Dataset) -> Shown:
        points = study.points
        scattered = points.sampling != "grid"
        picked: dict[str, Any] = {"point": slice(0, MOST_POINTS)} if scattered else {}
        axes = points.axes[:2] if scattered else points.longest
        fixed = {}
        for axis in () if scattered else points.axes:
            if axis in axes and axis.field.kind != "text":
                picked[axis.name] = np.argsort(axis.values)
            elif axis not in axes:
                order = np.argsort(axis.values) if axis.field.kind != "text" else np.arange(len(axis.values))
                picked[axis.name] = int(order[len(order) // 2])
                scale = Scale.of(axis, np.array([axis.values[picked[axis.name]]], axis.kind))
                number = scale.texts[0] if scale.texts else f"{scale.drawn[0]:.4g} {scale.unit.name}".rstrip("1 ")
                fixed[axis.name] = number
        part = dataset.isel(picked)
        arrays = {name: part[name].values for name in ("distance", "outcome", "end_x", "end_y")}
        numbers = np.arange(len(points)).reshape(tuple(points.dimensions.values()))
        arrays["number"] = numbers[np.ix_(*_rows(picked, points.dimensions))].reshape(arrays["distance"].shape)
        if points.repeats == 1:
            arrays = {name: array[..., None] for name, array in arrays.items()}
        scales = tuple(Scale.of(axis, part[axis.name].values) for axis in axes)
        return cls(
            study,
            scales if scattered else tuple(scale.in_cells() for scale in scales),
            arrays["distance"],
            arrays["outcome"].astype(np.int64),
            np.stack([arrays["end_x"], arrays["end_y"]], axis=-1),
            fixed,
            scattered,
            arrays["number"],
            study.threshold and study.threshold.holds(part, points.repeats),
        )

    @property
    def mean_distance(self) -> FloatArray:
        """The mean over repeats [m]; nan where all were refused."""
        return mean(self.distance)

    @property
    def usual_outcome(self) -> IntArray:
        """The most frequent outcome of the repeats, of two that are as frequent that with the lower number."""
        counts = np.stack([(self.outcome == k).sum(axis=-1) for k in range(len(OUTCOMES))])
        return np.argmax(counts, axis=0)


def _rows(picked: dict[str, Any], sizes: dict[str, int]) -> list[IntArray]:
    """The rows along each dimension that are picked."""
    return [np.atleast_1d(np.arange(size)[picked.get(name, slice(None))]) for name, size in sizes.items()]


def mean(values: FloatArray) -> FloatArray:
    """The mean over repeats; nan where none has a value."""
    known = np.isfinite(values)
    total, count = np.where(known, values, 0.0).sum(axis=-1), known.sum(axis=-1)
    return np.divide(total, count, out=np.full(total.shape, np.nan), where=count > 0)
