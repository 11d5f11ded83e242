"""The influence shape of one actuator on an L-shaped plate with a hole, from a mesh of gmsh."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from coupling.display import display_mesh, onto_plate
from fem_plate import Plate, PlateSection
from meshes import read

MESH = Path(__file__).parents[2] / "examples/meshes/l_with_hole.msh"
ACTUATORS = 1e-6 * np.array([[150, 220], [140, 310], [70, 290], [220, 150], [310, 140], [290, 70]])  # m


def draw(quick: bool = False) -> Figure:
    section = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=5e-6)
    plate = Plate(read(MESH, unit=1e-6), section, {"outer": "clamped", "hole": "free"})
    shapes = plate.influence(ACTUATORS)

    mesh = plate.mesh if quick else plate.mesh.refined()
    points, triangles = display_mesh(mesh, ACTUATORS)
    height = shapes.values(onto_plate(mesh.outline, points))[:, 0]
    figure = Figure(figsize=(6.4, 5), layout="constrained")
    axes = figure.subplots()
    levels = np.arange(-0.1, height.max() + 0.05, 0.05)
    filled = axes.tricontourf(*(points.T * 1e6), triangles, height, levels=levels, cmap="RdBu_r", vmin=-1.1, vmax=1.1)
    figure.colorbar(filled, label="deflection over the stroke")
    axes.plot(*(ACTUATORS.T * 1e6), "^", color="white", markeredgecolor="black", markersize=8)
    axes.annotate("raised by 1", ACTUATORS[0] * 1e6, (210, 235), arrowprops={"arrowstyle": "-"}, fontsize=9)
    axes.set_aspect("equal")
    axes.set_xlabel("x [µm]")
    axes.set_ylabel("y [µm]")
    return figure


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_suffix(".png"), dpi=80)
