"""Result files of a run: the plate and the part over time, in transient VTKHDF for ParaView and VTK.

`NAME.plate.vtkhdf` holds a mesh of triangles at rest, with fields that change; `NAME.part.vtkhdf` one moving point.
Until its `with` block has ended well a file is called `NAME.partial.plate.vtkhdf` or `NAME.partial.part.vtkhdf`. One
that an exception leaves behind opens like any other and holds the steps so far; after a kill, those flushed.

    with plate_file("results", "run1", points, triangles, {"case": case_text}) as plate:
        plate.append(0.0, deflection=deflection)
        plate.add_metadata({"summary": json.dumps(summary)})

Metadata are attributes, and further arrays datasets, of the group `/active_surface`, which VTK ignores.
"""

import math
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any, TypeVar

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

Metadata = Mapping[str, str | float | int]

FLUSH_EVERY = 8  # steps, and so what a kill of the process can lose
Filters = Mapping[str, Any]
GZIP: Filters = {"compression": "gzip", "compression_opts": 4, "shuffle": True}


class _ResultFile:
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
        self._times: list[float] = []
        self._fields: dict[str, h5py.Dataset] = {}
        self._metadata = file.create_group("active_surface")

        self._root = file.create_group("VTKHDF")
        self._root.attrs["Version"] = (2, 0)  # the first with time steps
        self._root.attrs["Type"] = np.bytes_(data_type)
        self._root["NumberOfPoints"] = [self._n_points]

        self._steps = self._root.create_group("Steps")
        self._steps.attrs["NSteps"] = 0
        _growing(self._steps, "Values", np.float64)
        _growing(self._steps, "PointOffsets", np.int64)
        # The same at every step: one piece, read from the start of its topology.
        cells = np.zeros((1, *topologies), np.int64)
        self._constants = {"CellOffsets": cells, "ConnectivityIdOffsets": cells}
        self._constants |= {"NumberOfParts": np.ones(1, np.int64), "PartOffsets": np.zeros(1, np.int64)}
        for name, row in self._constants.items():
            _growing(self._steps, name, np.int64, row.shape[1:])

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
        _write(self._steps["Values"], 0, np.array(self._times))
        self._steps.attrs.modify("NSteps", len(self._times))
        self._file.flush()

    def _append(self, time: float, fields: Mapping[str, ArrayLike], point: NDArray[np.float64] | None = None) -> None:
        """Write a step, with its point (1, 3) if that moves; or nothing, if the time or a field is refused."""
        if not math.isfinite(time) or (self._times and time <= self._times[-1]):
            raise ValueError(f"time {time} s is refused: the times of the steps are finite and increase")
        arrays = {name: self._checked(name, value) for name, value in fields.items()}
        if not self._times:
            self._fields = {name: self._create_field(name, array) for name, array in arrays.items()}
        elif arrays.keys() != self._fields.keys():
            missing, new = sorted(self._fields.keys() - arrays.keys()), sorted(arrays.keys() - self._fields.keys())
            raise ValueError(f"the first step fixed the fields: {missing} missing, {new} new")

        step = len(self._times)
        first_row = step * self._n_points
        for name, array in arrays.items():
            _write(self._fields[name], first_row, array)
            _write(self._steps["PointDataOffsets"][name], step, np.array([first_row]))
        for name, row in self._constants.items():
            _write(self._steps[name], step, row)
        _write(self._steps["PointOffsets"], step, np.array([0 if point is None else step]))
        if point is not None:
            _write(self._root["Points"], step, point)

        self._times.append(float(time))
        if step == 0 or len(self._times) % FLUSH_EVERY == 0:
            self.flush()

    def _checked(self, name: str, value: ArrayLike) -> NDArray[np.generic]:
        """The field as an array (points,) or (points, 3) that its dataset, if there is one, can hold."""
        array = np.asarray(value)
        scalar, vector, dataset = self._shape, (*self._shape, 3), self._fields.get(name)
        if array.dtype.kind not in "biuf":
            raise ValueError(f"field {name!r} is not numeric: its type is {array.dtype}")
        if array.shape not in (scalar, vector):
            raise ValueError(f"field {name!r} has shape {array.shape}; it must have {scalar} or {vector}")
        rows = array.reshape(self._n_points, *array.shape[len(scalar) :])
        if dataset is not None and rows.shape[1:] != dataset.shape[1:]:
            raise ValueError(f"field {name!r} has shape {array.shape}, unlike in the first step")
        if dataset is not None and not np.can_cast(rows.dtype, dataset.dtype, "same_kind"):
            raise ValueError(f"field {name!r} is of type {rows.dtype}; in the first step it was {dataset.dtype}")
        return rows

    def _create_field(self, name: str, array: NDArray[np.generic]) -> h5py.Dataset:
        dtype = array.dtype if array.dtype == np.float32 else np.float64 if array.dtype.kind == "f" else np.int64
        _growing(self._steps, f"PointDataOffsets/{name}", np.int64)
        return _growing(self._root, f"PointData/{name}", dtype, array.shape[1:], self._n_points, self._filters)


class PlateFile(_ResultFile):
    """The open result file of the plate; `plate_file` makes it."""

    def __init__(
        self, file: h5py.File, points: NDArray[np.float64], triangles: NDArray[np.int64], filters: Filters
    ) -> None:
        super().__init__(file, "UnstructuredGrid", shape=(len(points),), topologies=(), filters=filters)
        offsets = np.arange(0, triangles.size + 1, 3)
        types = np.full(len(triangles), 5, np.uint8)  # VTK_TRIANGLE
        mesh = {"Points": points, "Connectivity": triangles.ravel(), "Offsets": offsets, "Types": types}
        for name, data in mesh.items():
            self._root.create_dataset(name, data=data, **filters)
        self._root["NumberOfCells"] = [len(triangles)]
        self._root["NumberOfConnectivityIds"] = [triangles.size]

    def append(self, time: float, *, deflection: ArrayLike, **fields: ArrayLike) -> None:
        """Add the step at `time` [s]: the deflection (n,) [m], and any fields (n,) or (n, 3), in SI units.

        The first step fixes the fields. Integers and truth values are stored as int64, float32 as it is, any other
        number as float64.

        Raises ValueError, and writes nothing, if the time is not finite or not later than the last, or if a field
        has a wrong shape or type, is missing or is new.
        """
        self._append(time, {"deflection": deflection, **fields})


class PartFile(_ResultFile):
    """The open result file of the part; `part_file` makes it."""

    def __init__(self, file: h5py.File, filters: Filters) -> None:
        super().__init__(file, "PolyData", shape=(), topologies=(4,), filters=filters)
        _growing(self._root, "Points", np.float64, (3,))
        for name, n_cells in {"Vertices": 1, "Lines": 0, "Polygons": 0, "Strips": 0}.items():  # VTK wants all four
            cells = self._root.create_group(name)
            cells["NumberOfCells"] = cells["NumberOfConnectivityIds"] = [n_cells]
            cells["Connectivity"] = np.arange(n_cells)
            cells["Offsets"] = np.arange(n_cells + 1)

    def append(self, time: float, position: ArrayLike, **fields: ArrayLike) -> None:
        """Add the step at `time` [s]: the position (3,) [m], z being the surface's height, and any fields () or (3,).

        Fields are in SI units and stored as in `PlateFile.append`.

        Raises ValueError as `PlateFile.append` does, and if the position is not three numbers.
        """
        point = np.asarray(position, np.float64)
        if point.shape != (3,):
            raise ValueError(f"the position has shape {point.shape}; it must have (3,)")
        self._append(time, fields, point[np.newaxis])


def plate_file(
    directory: str | Path,
    name: str,
    points: ArrayLike,
    triangles: ArrayLike,
    metadata: Metadata | None = None,
    compress: bool = True,
) -> AbstractContextManager[PlateFile]:
    """Write `NAME.plate.vtkhdf` in the existing `directory`, replacing it when the `with` block ends well.

    `points` (n, 2) or (n, 3) [m] are at rest, with z = 0 if not given; `triangles` (m, 3) are their numbers from 0.
    compress: whether by gzip, which loses nothing.

    Raises ValueError for points or triangles of another shape or without meaning, and at the end if no step was
    appended; OSError if the file cannot be written.
    """
    corners = np.asarray(points, np.float64)
    if corners.ndim != 2 or corners.shape[1] not in (2, 3) or not np.isfinite(corners).all():
        raise ValueError(f"points of shape {corners.shape} are refused: they must be finite, (n, 2) or (n, 3)")
    corners = np.pad(corners, ((0, 0), (0, 3 - corners.shape[1])))
    cells = np.asarray(triangles)
    if cells.ndim != 2 or cells.shape[1] != 3 or cells.dtype.kind not in "iu" or not len(cells):
        raise ValueError(f"triangles of shape {cells.shape}, {cells.dtype}, are refused: they must be integers (m, 3)")
    if cells.min() < 0 or cells.max() >= len(corners):
        raise ValueError(f"triangles name points {cells.min()} to {cells.max()}; there are {len(corners)} points")
    filters, numbers = GZIP if compress else {}, cells.astype(np.int64)
    return _written(lambda file: PlateFile(file, corners, numbers, filters), directory, name, "plate", metadata)


def part_file(
    directory: str | Path, name: str, metadata: Metadata | None = None, compress: bool = True
) -> AbstractContextManager[PartFile]:
    """Write `NAME.part.vtkhdf` in the existing `directory`, replacing it when the `with` block ends well.

    Raises ValueError at the end if no step was appended; OSError if the file cannot be written.
    """
    filters = GZIP if compress else {}
    return _written(lambda file: PartFile(file, filters), directory, name, "part", metadata)


_File = TypeVar("_File", bound=_ResultFile)


@contextmanager
def _written(
    create: Callable[[h5py.File], _File], directory: str | Path, name: str, kind: str, metadata: Metadata | None
) -> Iterator[_File]:
    """Yield the file that `create` lays out under its partial name; give it the final name if all goes well."""
    partial = Path(directory, f"{name}.partial.{kind}.vtkhdf")
    try:
        opened = h5py.File(partial, "w")
    except BlockingIOError as error:
        raise BlockingIOError(error.errno, "another run is writing it", str(partial)) from error
    with opened as file:
        result = create(file)
        result.add_metadata(metadata or {})
        try:
            yield result
        finally:
            result.flush()
        if not result._times:
            raise ValueError(f"{partial} has no step")
    os.replace(partial, Path(directory, f"{name}.{kind}.vtkhdf"))


def _growing(
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
