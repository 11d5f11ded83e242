"""Three cycles of one actuator: where the part goes, and when it sticks and slips."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from coupling import surface_motion
from fem_plate import Plate, PlateSection
from meshes import disc
from particle import CoulombAdhesion, Drive, Micropart, State, simulate

RADIUS, START, FREQUENCY = 1e-3, (300e-6, 200e-6), 3000.0  # m, m, Hz
SECTION = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=100e-6)
FRICTION = CoulombAdhesion(coefficient=0.08, adhesion=2.5e-6)


def draw(quick: bool = False) -> Figure:
    shapes = Plate(disc(RADIUS, 200e-6), SECTION).influence([(0.0, 0.0)])
    surface = surface_motion(shapes, [Drive(7e-6, FREQUENCY)], half_thickness=SECTION.thickness / 2)
    part = Micropart(2e-9, START, centre_height=45e-6)
    path = simulate(surface, part, FRICTION, (1 if quick else 3) / FREQUENCY)

    time = np.linspace(0, path.time[-1], 600)
    states = path.at(time)
    figure = Figure(figsize=(8, 5), layout="constrained")
    upper, lower = figure.subplots(2, sharex=True)
    upper.plot(time * 1e3, np.hypot(*states.position.T) * 1e6, color="black")
    upper.set_ylabel("distance from\nthe actuator [µm]")
    lower.plot(time * 1e3, FRICTION.friction_limit(states.normal_force) * 1e9, color="black", label="its limit")
    lower.plot(time * 1e3, states.friction_force * 1e9, "--", color="#c8371b", label="friction force")
    lower.set_ylabel("force [nN]")
    lower.set_xlabel("time [ms]")
    for axes in (upper, lower):
        stuck = states.state == State.STICK
        axes.fill_between(
            time * 1e3, 0, 1, where=stuck, transform=axes.get_xaxis_transform(), color="#d4deee", label="stuck"
        )
        axes.set_xlim(0, time[-1] * 1e3)
    figure.legend(*lower.get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_suffix(".png"), dpi=80)
