"""Result files of a run: the plate and the part over time, in transient VTKHDF for ParaView and VTK.

`NAME.plate.vtkhdf` holds a mesh of triangles at rest, with fields that change; `NAME.part.vtkhdf` one moving point, or
of a part with a face its middle and a moving polygon around it.
Until its `with` block has ended well a file is called `NAME.partial.plate.vtkhdf` or `NAME.partial.part.vtkhdf`. One
that an exception leaves behind opens like any other and holds the steps so far; after a kill, those flushed.

    with plate_file("results", "run1", points, triangles, {"case": case_text}) as plate:
        plate.append(times, deflection=deflections)  # many steps at once: each write takes as long as that of one step
        plate.add_metadata({"summary": json.dumps(summary)})

Metadata are attributes, and further arrays datasets, of the group `/active_surface`, which VTK ignores.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Any

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from coupling.files import check_room, whole_file

Metadata = Mapping[str, str | float | int]
NONE: Metadata = MappingProxyType({})

FLUSH_AFTER = 0.1  # s, of which a kill of the process can lose the steps, and those of the block before
# Level 4 takes a third to a half longer, for files 2 % smaller.
GZIP: Mapping[str, Any] = {"compression": "gzip", "compression_opts": 1, "shuffle": True}
ROWS = 256  # of small datasets, in a chunk


class StepsFile:
    """Steps, fields and metadata of an open file, whose single piece keeps its topology.

    A scalar field has `shape` at each step, a vector field `(*shape, 3)`. `topologies` is () if VTK keeps one list
    of cells for this `data_type`, (k,) if it keeps k.
    """

    def __init__(self, file: h5py.File, data_type: str, shape: tuple[int, ...], topologies: tuple[int, ...]) -> None:
        self._file, self._shape, self._n_points = file, shape, math.prod(shape)
        self._times = np.empty(0)
        self._flushed = -math.inf  # when, on the monotonic clock
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
        made, data = self._metadata.require_group(group), {name: np.asarray(array) for name, array in arrays.items()}
        self.check_room(data)
        for name, array in data.items():
            made.create_dataset(name, data=array, **(GZIP if array.size else {}))

    def flush(self) -> None:
        """Put all steps so far on disk, where they outlive this process."""
        self._file.flush()  # the data first: NSteps must not count what is not there
        # VTK copies all of Values, unchecked, into room for NSteps numbers. So the two change only here, together.
        _write(self._steps["Values"], 0, self._times)
        self._steps.attrs.modify("NSteps", self.count)
        self._file.flush()
        self._flushed = time.monotonic()

    def append(self, times: ArrayLike, position: ArrayLike | None = None, **fields: ArrayLike) -> None:
        """Add the step at a time () [s], or k steps at times (k,), all with a first axis of k: much faster.

        Times increase. Fields are in SI units; the first step fixes which there are. Integers and truth values are
        stored as int64, float32 as it is, any other number as float64. Raises OSError, and writes nothing, where the
        disk has no room.

        position: (3,) [m] of the part, or (p, 3) of its middle and corners; z is the surface's height.
        """
        new, first = np.atleast_1d(np.asarray(times, np.float64)), self.count
        arrays = {name: np.asarray(values) for name, values in fields.items()}
        self.check_room(arrays)
        steps = np.arange(first, first + len(new))
        for name, array in arrays.items():
            rows = array.reshape(len(new) * self._n_points, *array.shape[np.ndim(times) + len(self._shape) :])
            if not first:
                dtype = array.dtype if array.dtype == np.float32 else float if array.dtype.kind == "f" else np.int64
                growing(self._steps, f"PointDataOffsets/{name}", np.int64)
                growing(self._root, f"PointData/{name}", dtype, rows.shape[1:], self._n_points)
            _write(self._root["PointData"][name], first * self._n_points, rows)
            _write(self._steps["PointDataOffsets"][name], first, steps * self._n_points)
        for name, row in self._constants.items():
            _write(self._steps[name], first, np.repeat(row, len(steps), axis=0))
        offsets = np.zeros_like(steps) if position is None else steps * self._n_points
        _write(self._steps["PointOffsets"], first, offsets)
        if position is not None:
            _write(self._root["Points"], first * self._n_points, np.reshape(position, (-1, 3)))
        self._times = np.concatenate([self._times, new])
        if time.monotonic() - self._flushed >= FLUSH_AFTER:
            self.flush()

    def check_room(self, arrays: Mapping[str, Any]) -> None:
        """Raise OSError where the disk has no room for arrays."""
        path, needed = Path(self._file.filename), sum(array.nbytes for array in arrays.values())
        check_room(path.parent, needed, f"; {path.name} has what was written before")


def plate_file(
    folder: str | Path, name: str, points: NDArray[np.float64], triangles: NDArray[np.int64], metadata: Metadata = NONE
) -> AbstractContextManager[StepsFile]:
    """Write `NAME.plate.vtkhdf` in an existing folder, replacing it when the `with` block ends well.

    `points` (n, 2) or (n, 3) [m] are at rest, with z = 0 if not given; `triangles` (m, 3) are their numbers from 0.
    Fields have the shape (n,) or (n, 3) at each step.

    Raises OSError if the file cannot be written, BlockingIOError where another process writes it.
    """
    mesh = {
        "Points": np.pad(points, ((0, 0), (0, 3 - points.shape[1]))),
        "Connectivity": triangles.ravel(),
        "Offsets": np.arange(0, triangles.size + 1, 3),
        "Types": np.full(len(triangles), 5, np.uint8),  # VTK_TRIANGLE
    }

    def lay_out(file: h5py.File) -> StepsFile:
        plate = StepsFile(file, "UnstructuredGrid", shape=(len(points),), topologies=())
        plate.check_room(mesh)
        for key, data in mesh.items():
            file["VTKHDF"].create_dataset(key, data=data, **GZIP)
        file["VTKHDF/NumberOfCells"] = [len(triangles)]
        file["VTKHDF/NumberOfConnectivityIds"] = [triangles.size]
        return plate

    return _written(lay_out, Path(folder), name, "plate", metadata)


def part_file(
    folder: str | Path, name: str, metadata: Metadata = NONE, corners: int = 0
) -> AbstractContextManager[StepsFile]:
    """Write `NAME.part.vtkhdf`, whose steps have a position and fields () or (3,); the rest is as in `plate_file`.

    corners: of the polygon around its middle; then steps have positions and fields of the middle and each corner.
    """

    def lay_out(file: h5py.File) -> StepsFile:
        part = StepsFile(file, "PolyData", shape=(1 + corners,) if corners else (), topologies=(4,))
        growing(file["VTKHDF"], "Points", np.float64, (3,))
        cells_of = {"Vertices": [0], "Lines": [], "Polygons": range(1, corners + 1), "Strips": []}  # VTK wants all four
        for key, points in cells_of.items():
            cells = file["VTKHDF"].create_group(key)
            cells["NumberOfCells"], cells["NumberOfConnectivityIds"] = [int(len(points) > 0)], [len(points)]
            cells["Connectivity"] = np.array(points, np.int64)
            cells["Offsets"] = np.array([0, len(points)] if len(points) else [0], np.int64)
        return part

    return _written(lay_out, Path(folder), name, "part", metadata)


@contextmanager
def _written(
    lay_out: Callable[[h5py.File], StepsFile], folder: Path, name: str, kind: str, metadata: Metadata
) -> Iterator[StepsFile]:
    """Yield the file that is laid out under its partial name; give it the final name if all goes well."""
    partial = folder / f"{name}.partial.{kind}.vtkhdf"
    try:
        with whole_file(folder / f"{name}.{kind}.vtkhdf", partial, keep=True), _opened(partial) as file:
            result = lay_out(file)
            result.add_metadata(metadata)
            try:
                yield result
            finally:
                result.flush()
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"interrupted; {partial} has the steps so far") from None


def _opened(path: Path) -> h5py.File:
    """The file, emptied unless another process writes it, which is a BlockingIOError."""
    try:
        try:
            h5py.File(path, "r").close()  # to open it for writing empties it before the lock is tried
        except BlockingIOError:
            raise
        except OSError:
            pass  # there is none, or what a kill left
        return h5py.File(path, "w")
    except BlockingIOError as error:
        raise BlockingIOError(error.errno, "another run is writing it", str(path)) from error


def growing(
    group: h5py.Group, name: str, dtype: DTypeLike, columns: tuple[int, ...] = (), rows_per_step: int = 1
) -> h5py.Dataset:
    """A dataset without rows yet. Large steps make a chunk each, which gzip compresses, and so are written once.

    Single rows share chunks that are rewritten with each row. They stay uncompressed, lest the chunks move about.
    """
    chunk, filters = (ROWS, {}) if rows_per_step == 1 else (rows_per_step, GZIP)
    shape, limits, chunks = ((rows, *columns) for rows in (0, None, chunk))
    return group.create_dataset(name, shape, dtype, maxshape=limits, chunks=chunks, **filters)


def _write(dataset: h5py.Dataset, start: int, rows: NDArray[Any]) -> None:
    """Make `rows` the last rows of the dataset, from row `start` on."""
    dataset.resize(start + len(rows), axis=0)
    if len(rows):
        dataset[start:] = rows
