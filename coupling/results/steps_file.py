"""What both result files of a run have in common: time steps, fields and metadata in transient VTKHDF."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from typing import Any

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

Metadata = Mapping[str, str | float | int]

FLUSH_AFTER = 0.1  # s, of which a kill of the process can lose the steps, and those of the block before
Filters = Mapping[str, Any]
GZIP: Filters = {"compression": "gzip", "compression_opts": 4, "shuffle": True}


class StepsFile:
    """Steps, fields and metadata of an open file, whose single piece keeps its topology.

    A scalar field has `shape` at each step, a vector field `(*shape, 3)`. `topologies` is () if VTK keeps one list
    of cells for this `data_type`, (k,) if it keeps k.
    """

    def __init__(
        self, file: h5py.File, data_type: str, shape: tuple[int, ...], topologies: tuple[int, ...], filters: Filters
    ) -> None:
        self._file = file
        self._filters = filters
        self._shape = shape
        self._n_points = math.prod(shape)
        self._times = np.empty(0)
        self._flushed = -math.inf  # when, on the monotonic clock
        self._fields: dict[str, h5py.Dataset] = {}
        self._metadata = file.create_group("active_surface")

        self._root = file.create_group("VTKHDF")
        self._root.attrs["Version"] = (2, 0)  # the first with time steps
        self._root.attrs["Type"] = np.bytes_(data_type)
        self._root["NumberOfPoints"] = [self._n_points]

        self._steps = self._root.create_group("Steps")
        self._steps.attrs["NSteps"] = 0
        growing(self._steps, "Values", np.float64)
        growing(self._steps, "PointOffsets", np.int64)
        # The same at every step: one piece, read from the start of its topology.
        cells = np.zeros((1, *topologies), np.int64)
        self._constants = {"CellOffsets": cells, "ConnectivityIdOffsets": cells}
        self._constants |= {"NumberOfParts": np.ones(1, np.int64), "PartOffsets": np.zeros(1, np.int64)}
        for name, row in self._constants.items():
            growing(self._steps, name, np.int64, row.shape[1:])

    @property
    def count(self) -> int:
        """How many steps it has."""
        return len(self._times)

    def add_metadata(self, metadata: Metadata) -> None:
        """Store texts and numbers as attributes of `/active_surface`; a key given before gets the new value."""
        for key, value in metadata.items():
            self._metadata.attrs[key] = value

    def add_arrays(self, group: str, arrays: Mapping[str, ArrayLike]) -> None:
        """Store arrays in the group `/active_surface/GROUP`, which has none of these names yet."""
        made = self._metadata.require_group(group)
        for name, array in arrays.items():
            data = np.asarray(array)
            made.create_dataset(name, data=data, **(self._filters if data.size else {}))

    def flush(self) -> None:
        """Put all steps so far on disk, where they outlive this process."""
        self._file.flush()  # the data first: NSteps must not count what is not there
        # VTK copies all of Values, unchecked, into room for NSteps numbers. So the two change only here, together.
        _write(self._steps["Values"], 0, self._times)
        self._steps.attrs.modify("NSteps", self.count)
        self._file.flush()
        self._flushed = time.monotonic()

    def _append(self, times: ArrayLike, fields: Mapping[str, ArrayLike], points: ArrayLike | None = None) -> None:
        """Write a step or k, with points (3,) or (k, 3) if these move; or nothing, if a time or a field is refused."""
        at = np.asarray(times, np.float64)
        arrays = {name: self._checked(name, value, at.shape) for name, value in fields.items()}
        new_times = self._later(at.ravel())
        if not self.count:
            self._fields = {name: self._create_field(name, array) for name, array in arrays.items()}
        elif arrays.keys() != self._fields.keys():
            missing, new = sorted(self._fields.keys() - arrays.keys()), sorted(arrays.keys() - self._fields.keys())
            raise ValueError(f"the first step fixed the fields: {missing} missing, {new} new")

        first = self.count
        steps = np.arange(first, first + len(new_times))
        for name, array in arrays.items():
            _write(self._fields[name], first * self._n_points, array)
            _write(self._steps["PointDataOffsets"][name], first, steps * self._n_points)
        for name, row in self._constants.items():
            _write(self._steps[name], first, np.repeat(row, len(steps), axis=0))
        _write(self._steps["PointOffsets"], first, np.zeros_like(steps) if points is None else steps)
        if points is not None:
            _write(self._root["Points"], first, np.reshape(points, (-1, 3)))

        self._times = np.concatenate([self._times, new_times])
        if time.monotonic() - self._flushed >= FLUSH_AFTER:
            self.flush()

    def _later(self, times: NDArray[np.float64]) -> NDArray[np.float64]:
        """The times (k,) [s] of further steps; ValueError unless they are finite and increase."""
        before = np.concatenate([self._times[-1:] if self.count else [-np.inf], times[:-1]])
        refused = times[~(np.isfinite(times) & (times > before))]
        if len(refused):
            raise ValueError(f"time {refused[0]} s is refused: the times of the steps are finite and increase")
        return times

    def _checked(self, name: str, value: ArrayLike, steps: tuple[int, ...]) -> NDArray[np.generic]:
        """The field at one step () or at (k,) as rows (points,) or (points, 3), which its dataset can hold."""
        array = np.asarray(value)
        scalar, dataset = (*steps, *self._shape), self._fields.get(name)
        if array.dtype.kind not in "biuf":
            raise ValueError(f"field {name!r} is not numeric: its type is {array.dtype}")
        if array.shape not in (scalar, (*scalar, 3)):
            raise ValueError(f"field {name!r} has shape {array.shape}; it must have {scalar} or {(*scalar, 3)}")
        rows = array.reshape(math.prod(scalar), *array.shape[len(scalar) :])
        if dataset is not None and rows.shape[1:] != dataset.shape[1:]:
            raise ValueError(f"field {name!r} has shape {array.shape}, unlike in the first step")
        if dataset is not None and not np.can_cast(rows.dtype, dataset.dtype, "same_kind"):
            raise ValueError(f"field {name!r} is of type {rows.dtype}; in the first step it was {dataset.dtype}")
        return rows

    def _create_field(self, name: str, array: NDArray[np.generic]) -> h5py.Dataset:
        dtype = array.dtype if array.dtype == np.float32 else np.float64 if array.dtype.kind == "f" else np.int64
        growing(self._steps, f"PointDataOffsets/{name}", np.int64)
        return growing(self._root, f"PointData/{name}", dtype, array.shape[1:], self._n_points, self._filters)


def growing(
    group: h5py.Group,
    name: str,
    dtype: DTypeLike,
    columns: tuple[int, ...] = (),
    rows_per_step: int = 1,
    filters: Filters = GZIP,
) -> h5py.Dataset:
    """A dataset without rows yet. Large steps make a chunk each, which the filters compress, and so are written once.

    Single rows share chunks that are rewritten with each row. They stay uncompressed, lest the chunks move about.
    """
    chunk, filters = (256, {}) if rows_per_step == 1 else (rows_per_step, filters)
    shape, limits, chunks = ((rows, *columns) for rows in (0, None, chunk))
    return group.create_dataset(name, shape, dtype, maxshape=limits, chunks=chunks, **filters)


def _write(dataset: h5py.Dataset, start: int, rows: NDArray[np.generic]) -> None:
    """Make `rows` the last rows of the dataset, from row `start` on."""
    dataset.resize(start + len(rows), axis=0)
    if len(rows):
        dataset[start:] = rows
