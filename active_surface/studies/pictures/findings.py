"""Findings: results of a sweep with what its pictures need besides; all of it is in the file of the results."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import TypeAdapter

from active_surface.arrays import FloatArray
from active_surface.studies.axes import Axis
from active_surface.studies.points import longest
from active_surface.studies.sweep_file import LOGARITHMIC, key_of, read_dataset, whole
from active_surface.studies.threshold import Threshold, read_threshold
from coupling.case import Field

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, eq=False)
class Findings:
    """The results of a sweep, as its pictures show them."""

    name: str
    dataset: xarray.Dataset
    axes: tuple[Axis, ...]  # without values where they run along the points
    scattered: bool  # at points, not on a grid
    repeats: int
    threshold: Threshold | None  # the condition whose beginning is drawn
    actuators: FloatArray  # (N, 2) m
    rim: list[FloatArray]  # curves (k, 2) [m]; empty: there is a platform

    @classmethod
    def of(cls, name: str, dataset: xarray.Dataset, threshold: Threshold | None) -> Findings:
        about = dataset.attrs
        scattered = about["sampling"] != "grid"
        points = np.reshape(about["rim"], (-1, 2))
        curves = np.split(points, np.flatnonzero(np.isnan(points[:, 0])) + 1)[:-1]
        return cls(
            name,
            dataset,
            tuple(_axis(axis, dataset[axis], not scattered) for axis in about["axes"].split()),
            scattered,
            dataset.sizes.get("repeat", 1),
            threshold,
            np.reshape(about["actuators"], (-1, 2)),
            [curve[:-1] for curve in curves],
        )

    @property
    def longest(self) -> tuple[Axis, ...]:
        """The two axes of a grid with the most values, or the first two along the points."""
        return self.axes[:2] if self.scattered else longest(self.axes)


@contextmanager
def read_findings(path: Path) -> Iterator[Findings]:
    """Yield the findings in a file that a sweep left, which is closed at the end; ValueError when it is none."""
    if key_of(path) is None:
        raise ValueError(f"{path}: must be the netCDF file of a sweep; it is not")
    with whole(path):
        dataset = read_dataset(path)
    with dataset:
        if not {"axes", "rim"} <= dataset.attrs.keys():
            raise ValueError(f"{path}: must be of a sweep by this version of active-surface; it is of an older one")
        with whole(path):
            condition = tomllib.loads(dataset.attrs["study"]).get("map", {}).get("threshold")
            findings = Findings.of(path.stem, dataset, read_threshold(condition) if condition else None)
        yield findings


def _axis(name: str, array: xarray.DataArray, listed: bool) -> Axis:
    path, unit = str(array.attrs["field"]), str(array.attrs.get("units", ""))
    location = tuple(int(key) if key.isdecimal() else key for key in path.split("."))
    field = Field(path, (location,), unit, "number" if unit else "text", TypeAdapter(Any))
    values = tuple(array.values.tolist()) if listed else ()
    return Axis(name, field, values, logarithmic=array.attrs.get("spacing") == LOGARITHMIC)
