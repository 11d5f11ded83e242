"""Eighty parts on the same moving plate, each from another start: where they come to rest."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from coupling import surface_motion
from fem_plate import Plate, PlateSection
from meshes import disc
from particle import CoulombAdhesion, Drive, Micropart, Outcome, simulate_many

RADIUS = 1e-3  # m
ACTUATORS = [(-300e-6, 0.0), (300e-6, 0.0)]  # m
SECTION = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=100e-6)


def draw(quick: bool = False) -> Figure:
    shapes = Plate(disc(RADIUS, 200e-6), SECTION).influence(ACTUATORS)
    surface = surface_motion(
        shapes, [Drive(5e-6, 3000.0, cycles=270), Drive(5e-6, 2600.0, cycles=234)], half_thickness=SECTION.thickness / 2
    )
    count = 5 if quick else 80
    angle, radius = (
        np.pi * (3 - np.sqrt(5)) * np.arange(count),
        0.6 * RADIUS * np.sqrt((np.arange(count) + 0.5) / count),
    )
    starts = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    parts = [Micropart(2e-9, (x, y), centre_height=45e-6) for x, y in starts]
    paths = simulate_many(
        surface, parts, CoulombAdhesion(0.04, adhesion=2.5e-6), 2e-3 if quick else 120e-3, tolerance=1e-6
    )

    figure = Figure(figsize=(6, 5.6), layout="constrained")
    axes = figure.subplots()
    axes.add_patch(Circle((0, 0), RADIUS * 1e6, fill=False, linewidth=1.5))
    for path in paths:
        axes.plot(*(path.position.T * 1e6), color="#8aa0bd", linewidth=0.7)
    ends = np.array([path.position[-1] for path in paths if path.outcome is not Outcome.LEFT_PLATE]).reshape(-1, 2)
    axes.plot(*(starts.T * 1e6), ".", color="#8aa0bd", markersize=4, label="start")
    axes.plot(*(ends.T * 1e6), ".", color="#c8371b", markersize=6, label="after the run")
    axes.plot(
        *(np.transpose(ACTUATORS) * 1e6), "^", color="white", markeredgecolor="black", markersize=9, label="actuator"
    )
    axes.set_aspect("equal")
    axes.set_xlabel("x [µm]")
    axes.set_ylabel("y [µm]")
    figure.legend(loc="outside lower center", ncols=3, frameon=False)
    return figure


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_suffix(".png"), dpi=80)
