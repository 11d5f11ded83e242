"""A wave over twenty-five actuators at four moments of a cycle, and the way that it carries a part."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from coupling import surface_motion
from fem_plate import Plate, PlateSection
from meshes import rectangle
from particle import CoulombAdhesion, Drive, Micropart, simulate

PITCH, FREQUENCY, START = 150e-6, 1600.0, (-30e-6, -40e-6)  # m, Hz, m
SECTION = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=100e-6)


def draw(quick: bool = False) -> Figure:
    row, column = np.divmod(np.arange(25), 5)
    actuators = PITCH * np.stack([column - 2, row - 2], axis=1)
    shapes = Plate(rectangle(7 * PITCH, 7 * PITCH, PITCH if quick else PITCH / 2), SECTION).influence(actuators)
    drives = [Drive(0.6e-6, FREQUENCY, delay=(k % 6) / 6 / FREQUENCY) for k in row + column]
    surface = surface_motion(shapes, drives, surface_tolerance=1e-5, half_thickness=SECTION.thickness / 2)
    duration = 1.5e-3 if quick else 80e-3
    part, friction = Micropart(2e-9, START, centre_height=45e-6), CoulombAdhesion(0.1, adhesion=100e-9)
    path = simulate(surface, part, friction, duration, tolerance=1e-7)

    side = 2.9 * PITCH * np.linspace(-1, 1, 20 if quick else 80)
    points = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    figure = Figure(figsize=(8, 7), layout="constrained")
    panels = figure.subplots(2, 2, sharex=True, sharey=True)
    for axes, time in zip(panels.flat, duration - np.arange(4)[::-1] / 4 / FREQUENCY, strict=True):
        height = surface.evaluate(points, time).w.reshape(len(side), -1)
        filled = axes.contourf(side * 1e6, side * 1e6, height * 1e9, levels=np.arange(-100, 800, 50), cmap="Blues")
        axes.plot(*(actuators.T * 1e6), "^", color="white", markeredgecolor="black", markersize=5)
        axes.plot(*(path.position.T * 1e6), color="#c8371b", linewidth=2)
        axes.plot(*(path.at([time]).position[0] * 1e6), "o", color="#c8371b", markeredgecolor="black", markersize=7)
        axes.set_title(f"{time * 1e3:.2f} ms", fontsize=11)
        axes.set_aspect("equal")
    figure.colorbar(filled, ax=panels, label="height [nm]", shrink=0.7)
    figure.supxlabel("x [µm]", fontsize=10)
    figure.supylabel("y [µm]", fontsize=10)
    return figure


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_suffix(".png"), dpi=80)
