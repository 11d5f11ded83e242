"""A plate and a part whose fields are their own at each point and step, and what VTK reads of their files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader

N_STEPS = 20  # neither flushed by count at the end nor fewer than one flush
TIMES = [0.1 * k**1.5 for k in range(N_STEPS)]

side = np.linspace(0.0, 0.01, 7)
POINTS = np.array([(x, y) for y in side for x in side])
CORNERS = np.array([7 * row + column for row in range(6) for column in range(6)])
TRIANGLES = np.concatenate([CORNERS[:, None] + [0, 1, 8], CORNERS[:, None] + [0, 8, 7]])


def bump(step: int) -> np.ndarray:
    """A deflection of its own at each point and step."""
    return 1e-6 * (step + 1) * np.exp(-(((POINTS[:, 0] - 5e-4 * step) / 2e-3) ** 2)) + 1e-8 * POINTS[:, 1]


def gradient(step: int) -> np.ndarray:
    return np.stack([bump(step), -2.0 * bump(step), np.full(len(POINTS), float(step))], axis=1)


def position(step: int) -> tuple[float, float, float]:
    return (1e-3 + 2e-4 * step, 2e-3 - 1e-5 * step**2, 1e-6 * step)


def part_fields(step: int) -> dict[str, ArrayLike]:
    return {"velocity": (0.1 * step, -0.2, 0.01 * step**2), "state": step % 3, "normal_force": 1e-6 / (step + 1)}


def times_in_vtk(path: Path) -> list[float]:
    """The time axis a pipeline such as ParaView's is offered."""
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    return list(reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS()) or ())


def step_in_vtk(path: Path, step: int) -> pv.DataSet:
    reader = pv.get_reader(path)
    reader.reader.SetStep(step)
    return reader.read()


def names(directory: Path) -> list[str]:
    return sorted(path.name for path in directory.iterdir())
