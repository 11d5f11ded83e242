"""The six lowest modes of an elliptic plate, clamped, and held by one actuator in the middle."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse

from coupling.display import display_mesh, onto_plate
from fem_plate import Plate, PlateSection
from meshes import ellipse

SECTION = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=5e-6, density=2330)


def draw(quick: bool = False) -> Figure:
    mesh = ellipse(300e-6, 200e-6, cell_size=60e-6 if quick else 40e-6)
    modes = Plate(mesh, SECTION).modes(6, held=[[0.0, 0.0]])

    points, triangles = display_mesh(mesh.refined(), np.empty((0, 2)))
    shapes = modes.evaluate(onto_plate(mesh.outline, points))[0]
    figure = Figure(figsize=(8, 4.2), layout="constrained")
    levels = np.linspace(-1.05, 1.05, 15)
    for axes, shape, frequency in zip(figure.subplots(2, 3).flat, shapes.T, modes.frequencies, strict=True):
        axes.tricontourf(*(points.T * 1e6), triangles, shape, levels=levels, cmap="RdBu_r")
        axes.add_patch(Ellipse((0, 0), 600, 400, fill=False, linewidth=1.2))
        axes.plot(0, 0, "^", color="white", markeredgecolor="black", markersize=7)
        axes.set_title(f"{frequency / 1e3:.0f} kHz", fontsize=11)
        axes.set_aspect("equal")
        axes.axis("off")
    return figure


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_suffix(".png"), dpi=80)
