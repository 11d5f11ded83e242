"""Result files of a run: the plate and the part over time, in transient VTKHDF for ParaView and VTK.

`NAME.plate.vtkhdf` holds a mesh of triangles at rest, with fields that change; `NAME.part.vtkhdf` one moving point.
Until its `with` block has ended well a file is called `NAME.partial.plate.vtkhdf` or `NAME.partial.part.vtkhdf`. One
that an exception leaves behind opens like any other and holds the steps so far; after a kill, those flushed.

    with plate_file("results", "run1", points, triangles, {"case": case_text}) as plate:
        plate.append(times, deflection=deflections)  # many steps at once: each write takes as long as that of one step
        plate.add_metadata({"summary": json.dumps(summary)})

Metadata are attributes, and further arrays datasets, of the group `/active_surface`, which VTK ignores.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import TypeVar

import h5py  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import ArrayLike, NDArray

from coupling.files import whole_file
from coupling.new_file import NewFile
from coupling.results.steps_file import GZIP, Filters, Metadata, StepsFile, growing


class PlateFile(StepsFile):
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

    def append(self, times: ArrayLike, *, deflection: ArrayLike, **fields: ArrayLike) -> None:
        """Add the step at a time () [s]: the deflection (n,) [m], and any fields (n,) or (n, 3), in SI units.

        Or k steps at times (k,), all with a first axis of k: much faster. The first step fixes the fields. Integers and
        truth values are stored as int64, float32 as it is, any other number as float64.

        Raises ValueError, and writes nothing, if a time is not finite or not later than the last, or if a field
        has a wrong shape or type, is missing or is new.
        """
        self._append(times, {"deflection": deflection, **fields})


class PartFile(StepsFile):
    """The open result file of the part; `part_file` makes it."""

    def __init__(self, file: h5py.File, filters: Filters) -> None:
        super().__init__(file, "PolyData", shape=(), topologies=(4,), filters=filters)
        growing(self._root, "Points", np.float64, (3,))
        for name, n_cells in {"Vertices": 1, "Lines": 0, "Polygons": 0, "Strips": 0}.items():  # VTK wants all four
            cells = self._root.create_group(name)
            cells["NumberOfCells"] = cells["NumberOfConnectivityIds"] = [n_cells]
            cells["Connectivity"] = np.arange(n_cells)
            cells["Offsets"] = np.arange(n_cells + 1)

    def append(self, times: ArrayLike, position: ArrayLike, **fields: ArrayLike) -> None:
        """Add a step, or k: the position (3,) [m], z being the surface's height, and any fields () or (3,).

        Times and fields are as in `PlateFile.append`, which has the errors, too; ValueError also if the position is not
        three numbers.
        """
        points, shape = np.asarray(position, np.float64), (*np.shape(times), 3)
        if points.shape != shape:
            raise ValueError(f"the position has shape {points.shape}; it must have {shape}")
        self._append(times, fields, points)


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


AnyFile = TypeVar("AnyFile", bound=StepsFile)


@contextmanager
def _written(
    create: Callable[[h5py.File], AnyFile], directory: str | Path, name: str, kind: str, metadata: Metadata | None
) -> Iterator[AnyFile]:
    """Yield the file that `create` lays out under its partial name; give it the final name if all goes well."""
    partial = Path(directory, f"{name}.partial.{kind}.vtkhdf")
    with whole_file(Path(directory, f"{name}.{kind}.vtkhdf"), partial, keep=True):
        try:
            opened = NewFile(partial)
        except BlockingIOError as error:
            raise BlockingIOError(error.errno, "another run is writing it", str(partial)) from error
        with opened as file:
            result = create(file)
            result.add_metadata(metadata or {})
            try:
                yield result
            finally:
                result.flush()
            if not result.count:
                raise ValueError(f"{partial} has no step")
