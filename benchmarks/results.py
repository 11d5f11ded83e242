"""Result files: bytes and seconds of plate files of 200 steps of 20 000 points, and what VTK reads of them.

    python benchmarks/results.py

Compares VTKHDF with PVD + VTU by meshio and by VTK, and with XDMF. Every step of the VTKHDF files
is read back by VTK and compared bit for bit. Times are those of the processor.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from contextlib import chdir
from pathlib import Path

import meshio
import numpy as np
import pyvista
from numpy.typing import NDArray

from coupling.results.export import Frame, write_pvd, write_xdmf
from coupling.results.vtkhdf import part_file, plate_file

STEPS, SIDE = 200, 142  # 20 164 points
SIZE = 300e-6  # m
FIELDS = ("deflection", "velocity", "curvature", "drive")


def plate() -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A square of points (n, 2) [m] and triangles (m, 3)."""
    across = np.linspace(-SIZE, SIZE, SIDE)
    corner = (np.arange(SIDE - 1)[:, None] * SIDE + np.arange(SIDE - 1)).ravel()
    first, second = ((0, 1, SIDE + 1), (0, SIDE + 1, SIDE))
    triangles = np.concatenate([corner[:, None] + first, corner[:, None] + second])
    return np.stack(np.meshgrid(across, across), axis=-1).reshape(-1, 2), triangles


def fields(points: NDArray[np.float64], step: int) -> dict[str, NDArray[np.float32]]:
    """Two hills, one beside each of two actuators, that go up and down at 400 and 300 Hz; at one of 200 moments."""
    found = dict.fromkeys(FIELDS, np.zeros(len(points)))
    for x, frequency in ((-SIZE / 4, 400.0), (SIZE / 4, 300.0)):
        phase = 2 * np.pi * frequency * 2.5e-4 * step
        square = ((points - [x, 0.0]) ** 2).sum(axis=1) / SIZE**2
        hill = np.exp(-4 * square)
        height, speed = 75e-6 * (1 - np.cos(phase)), 75e-6 * 2 * np.pi * frequency * np.sin(phase)
        found["deflection"] = found["deflection"] + height * hill
        found["velocity"] = found["velocity"] + speed * hill
        found["curvature"] = found["curvature"] + height * hill * (64 * square - 16) / SIZE**2
        found["drive"] = found["drive"] + height * (square == square.min())
    return {name: values.astype(np.float32) for name, values in found.items()}


def write_vtkhdf(folder: Path, frames: list[Frame], triangles: NDArray[np.int64]) -> None:
    with plate_file(folder, "run", frames[0].points, triangles) as file:
        for frame in frames:
            file.append(frame.time, **frame.fields)


def write_vtu_by_vtk(folder: Path, frames: list[Frame], triangles: NDArray[np.int64]) -> None:
    cells = np.pad(triangles, ((0, 0), (1, 0)), constant_values=3).ravel()
    grid = pyvista.UnstructuredGrid(cells, np.full(len(triangles), 5, np.uint8), frames[0].points)
    for k, frame in enumerate(frames):
        for name, values in frame.fields.items():
            grid.point_data[name] = values
        grid.save(folder / f"{k:05}.vtu")


def write_plain_xdmf(folder: Path, frames: list[Frame], triangles: NDArray[np.int64]) -> None:
    """By meshio's own writer, which does not compress."""
    with chdir(folder), meshio.xdmf.TimeSeriesWriter("run.xdmf") as file:
        file.write_points_cells(frames[0].points, [("triangle", triangles)])
        for frame in frames:
            file.write_data(frame.time, point_data=frame.fields)


def read_back(path: Path, frames: list[Frame]) -> float:
    """The seconds that VTK takes to read every step; AssertionError unless each has the bits that were written."""
    start = time.process_time()
    reader = pyvista.get_reader(path)
    for k, frame in enumerate(frames):
        reader.reader.SetStep(k)
        data = reader.read()
        assert np.array_equal(data.points, frame.points)
        assert all(np.array_equal(data[name], values) for name, values in frame.fields.items())
    return time.process_time() - start


def check_part(folder: Path) -> None:
    """Write and read back a part on the same time axis."""
    rng = np.random.default_rng(1)
    places, speeds, forces = rng.normal(size=(STEPS, 3)), rng.normal(size=(STEPS, 3)), rng.normal(size=STEPS)
    with part_file(folder, "run") as file:
        for k in range(STEPS):
            file.append(k * 2.5e-4, places[k], velocity=speeds[k], state=k % 3, normal_force=forces[k])
    reader = pyvista.get_reader(folder / "run.part.vtkhdf")
    for k in range(STEPS):
        reader.reader.SetStep(k)
        data = reader.read()
        assert np.array_equal(data.points, places[k : k + 1]) and np.array_equal(data["velocity"], speeds[k : k + 1])
        assert data["state"].tolist() == [k % 3] and data["normal_force"].tolist() == [forces[k]]


def compare(names: tuple[str, ...]) -> None:
    """Write these fields in every way, and print a table."""
    points, triangles = plate()
    flat = np.pad(points, ((0, 0), (0, 1)))
    every = (fields(points, k) for k in range(STEPS))
    frames = [Frame(k * 2.5e-4, flat, {name: one[name] for name in names}) for k, one in enumerate(every)]
    ways: dict[str, Callable[[Path], object]] = {
        "VTKHDF, gzip": lambda folder: write_vtkhdf(folder, frames, triangles),
        "PVD + VTU, zlib, meshio": lambda folder: write_pvd(folder, "run", "triangle", triangles, iter(frames)),
        "VTU, zlib, VTK": lambda folder: write_vtu_by_vtk(folder, frames, triangles),
        "XDMF, gzip": lambda folder: write_xdmf(folder, "run", "triangle", triangles, iter(frames)),
        "XDMF by meshio": lambda folder: write_plain_xdmf(folder, frames, triangles),
    }
    numbers = len(names) * 4 * STEPS * len(points) / 1e6
    print(f"\n{STEPS} steps of {len(points)} points, {', '.join(names)}: {numbers:.0f} MB of numbers")
    print(f"{'':26}{'MB':>8}{'s':>8}{'files':>8}{'s to read':>12}")
    for name, write in ways.items():
        with tempfile.TemporaryDirectory() as made:
            folder, start = Path(made), time.process_time()
            write(folder)
            seconds = time.process_time() - start
            files = [file for file in folder.rglob("*") if file.is_file()]
            size = sum(file.stat().st_size for file in files) / 1e6
            read = f"{read_back(folder / 'run.plate.vtkhdf', frames):12.2f}" if name.startswith("VTKHDF") else ""
            print(f"{name:26}{size:8.1f}{seconds:8.2f}{len(files):8}{read}", flush=True)


def main() -> None:
    compare(FIELDS[:1])
    compare(FIELDS)
    with tempfile.TemporaryDirectory() as folder:
        check_part(Path(folder))
    print("\nEvery step of plate and part read back by VTK with the bits that were written.")


if __name__ == "__main__":
    main()
