"""Draws docs/motion_error.png: what each scheme's end point costs. `docs/pictures.py` calls it."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from coupling import surface_motion
from fem_plate import DiscShapes
from particle import ConstantFriction, Drive, Micropart, simulate

RADIUS, MASS = 300e-6, 2e-9
PAIR = [[75e-6, 10e-6], [-75e-6, 10e-6]]
# Actuators, drives, start [m], duration [s], gravity [m/s^2].
CASES = {
    "One actuator, over which the part slides: 300 Hz, 8 ms": (
        [[0.0, 0.0]],
        [Drive(150e-6, 300, cycles=1)],
        (100e-6, 0.0),
        8e-3,
        0.0,
    ),
    "Two actuators at 300 and 450 Hz, 3 ms": (
        PAIR,
        [Drive(150e-6, 300), Drive(90e-6, 450, delay=0.4e-3)],
        (60e-6, -40e-6),
        3e-3,
        9.80665,
    ),
}
STEPS = 4e-6 / 2.0 ** np.arange(0, 11, 2)  # s
TOLERANCES = 10.0 ** -np.arange(4, 11)
COLOURS = {"fixed": "#1b4f9c", "paper": "#c8371b"}


def draw_motion_error() -> None:
    figure = Figure(figsize=(12.0, 4.6))
    FigureCanvasAgg(figure)
    figure.set_layout_engine("constrained", w_pad=0.12)
    for axes, (title, case) in zip(figure.subplots(1, 2, sharey=True), CASES.items(), strict=True):
        _draw(axes, case)
        axes.set_title(title, fontsize=11)
        axes.set_xlabel("evaluations of the surface")
    figure.axes[0].set_ylabel("error of the end point, over the radius")
    figure.axes[0].legend(loc="lower right", fontsize=9)
    figure.savefig(Path(__file__).parent / "motion_error.png", dpi=100)


def _draw(axes: Axes, case: tuple) -> None:
    actuators, drives, start, duration, gravity = case
    surface, part = surface_motion(DiscShapes(actuators, RADIUS), drives), Micropart(MASS, start)

    def run(**how):
        return simulate(surface, part, ConstantFriction(20.9 * MASS), duration, gravity, **how)

    truth = run(tolerance=1e-12).position[-1]

    def line(runs, label, colour):
        errors = [np.hypot(*(found.position[-1] - truth)) / RADIUS for found in runs]
        axes.loglog([found.evaluations for found in runs], errors, "o-", color=colour, markersize=4, label=label)

    line([run(tolerance=t) for t in TOLERANCES], '"events", tolerances of 1e-4 to 1e-10', "black")
    for scheme, colour in COLOURS.items():
        line([run(scheme=scheme, time_step=h) for h in STEPS], f'"{scheme}", steps of 4 µs to 3.9 ns', colour)
    axes.grid(alpha=0.3)


if __name__ == "__main__":
    draw_motion_error()
