"""Draws docs/tolerance.png: the error of a path's end point over the tolerance. `docs/pictures.py` calls it."""

from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from coupling import surface_motion
from fem_plate import DiscShapes
from particle import ConstantFriction, Drive, Micropart, simulate

RADIUS, MASS = 300e-6, 2e-9
PAIR = [[75e-6, 10e-6], [-75e-6, 10e-6]]
TWO = [Drive(150e-6, 300), Drive(90e-6, 450, delay=0.4e-3)]
# Actuators, drives, start [m], duration [s], gravity [m/s^2], colour and mark.
CASES = {
    "one actuator, up and down at 300 Hz": (
        [[0.0, 0.0]],
        [Drive(150e-6, 300, cycles=1)],
        (100e-6, 0.0),
        8e-3,
        0.0,
        "#1b4f9c",
        "o",
    ),
    "one actuator, up at 450 Hz": (
        [[0.0, 0.0]],
        [Drive(150e-6, 450, cycle="up")],
        (100e-6, 0.0),
        8e-3,
        0.0,
        "#c8371b",
        "s",
    ),
    "two actuators, 3 ms": (PAIR, TWO, (60e-6, -40e-6), 3e-3, 9.80665, "black", "^"),
}
TOLERANCES = 10.0 ** -np.arange(4, 11.01, 0.25)
TRUTH = 1e-13  # within 2e-11 of the paths of tests/reference/motion_oracle.py


def draw_tolerance() -> None:
    figure = Figure(figsize=(7.0, 5.0))
    FigureCanvasAgg(figure)
    figure.set_layout_engine("constrained")
    axes = figure.subplots()
    for name, (actuators, drives, start, duration, gravity, colour, mark) in CASES.items():
        surface, part = surface_motion(DiscShapes(actuators, RADIUS), drives), Micropart(MASS, start)
        paths = [
            simulate(surface, part, ConstantFriction(20.9 * MASS), duration, gravity, tolerance)
            for tolerance in (TRUTH, *TOLERANCES)
        ]
        ends = np.array([path.position[-1] for path in paths])
        errors = np.hypot(*(ends[1:] - ends[0]).T) / RADIUS
        axes.loglog(TOLERANCES, errors, mark, color=colour, markersize=5, label=name)
        ratio = errors / TOLERANCES
        print(f"{name}: at most {ratio.max():.1f} tolerances, below 1e-6 {ratio[TOLERANCES < 9e-7].max():.1f}")
    axes.loglog(TOLERANCES, TOLERANCES, "--", color="grey", linewidth=1, label="error = tolerance")
    axes.axvline(1e-6, color="grey", linewidth=0.8, linestyle=":")
    axes.text(1.25e-6, 3e-13, "Dormand-Prince 5", fontsize=9, color="dimgrey")
    axes.text(0.8e-6, 3e-13, "DOP853", fontsize=9, color="dimgrey", ha="right")
    axes.set_ylim(1e-13, 1e-2)
    axes.set_xlabel("tolerance")
    axes.set_ylabel("error of the end point, over the radius")
    axes.grid(alpha=0.3)
    axes.legend(loc="upper left", fontsize=9)
    figure.savefig(Path(__file__).parent / "tolerance.png", dpi=100)


if __name__ == "__main__":
    draw_tolerance()
