"""Draws docs/air.png: how far parts go over the air's pressure, their bow and their size, with a film of air."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from coupling import Case, build_friction, build_part, follow, read_case
from coupling.batch import PathTask
from coupling.run import build_scene

PAGE = Path(__file__).parent
MICRO, ROOM, SIZE = 1e6, 101325.0, 95e-6
PRESSURES = np.concatenate([[1.0], np.geomspace(100, 1000, 4), np.geomspace(1000, ROOM, 13)[1:]])
BOWS = np.concatenate([np.linspace(0, 0.5, 11), np.linspace(0.5, 1, 6)[1:], np.linspace(1, 3, 5)[1:]]) / MICRO
SIZES = np.geomspace(10, 300, 19) / MICRO
GENTLE: dict[str, Any] = {
    "plate": {
        "shape": "disc",
        "radius": "1.2 mm",
        "supports": "clamped",
        "youngs_modulus": "169 GPa",
        "poisson_ratio": 0.3,
        "thickness": "100 um",
        "density": "2330 kg/m^3",
    },
    "actuators": [{"position": ["0 um", "0 um"], "stroke": "3 um", "frequency": "2 kHz", "cycles": 100}],
    "part": {"mass": "2 ug", "size": SIZE, "centre_height": "47.5 um", "position": ["300 um", "200 um"]},
    "friction": {"model": "coulomb", "coefficient": 0.1, "adhesion": "0.45 uN"},
    "run": {"duration": "60 ms", "tolerance": 1e-8},
}


def main_job() -> Case:
    """The main job with a point of the bar's mass, height and area."""
    case = read_case(PAGE.parent / "examples/transport.toml")
    part = {"mass": case.part.mass, "size": SIZE, "centre_height": "47.5 um", "position": case.part.position}
    return case.vary({"part": part, "run.tolerance": 1e-8})


DEVICES = {
    "main job's plate, beyond the film's bounds: its sag is 9 gaps": (main_job, "#c8371b"),
    "quick start's plate, strokes of 3 µm: a sag of 0.27 gaps": (lambda: Case(**GENTLE), "#1b4f9c"),
}


def ways(case: Case, changes: list[dict[str, Any]]) -> list[float]:
    """How far [m] the part goes in the direction that it takes in a vacuum, with each change."""
    surface = build_scene(case).surface
    cases = [case, *(case.vary({"air": {"film": True}}).vary(change) for change in changes)]
    paths = follow([PathTask(surface, build_part(one), build_friction(one), one.run) for one in cases])
    free, *moved = [path.position[-1] - path.position[0] for path in paths]
    return [float(step @ free / np.hypot(*free)) for step in moved]


def draw() -> None:
    figure = Figure(figsize=(15.0, 4.8))
    FigureCanvasAgg(figure)
    figure.set_layout_engine("constrained", w_pad=0.12)
    axes = figure.subplots(1, 3, sharey=True)
    for label, (make, colour) in DEVICES.items():
        case = make()
        adhesion = case.friction.adhesion  # type: ignore[union-attr]
        changes = (
            [{"air.pressure": value} for value in PRESSURES.tolist()],
            [{"air.bow": value} for value in BOWS.tolist()],
            [
                {
                    "part.size": size,
                    "part.mass": case.part.mass * (size / SIZE) ** 2,
                    "friction.adhesion": adhesion * (size / SIZE) ** 2,
                }
                for size in SIZES.tolist()
            ],
        )
        found = ways(case, [change for some in changes for change in some])
        print(label, np.round(np.array(found) * MICRO, 3).tolist())
        for panel, values, scale in zip(axes, (PRESSURES, BOWS, SIZES), (1.0, MICRO, MICRO), strict=True):
            own, found = found[: len(values)], found[len(values) :]
            panel.plot(values * scale, np.array(own) * MICRO, "o-", color=colour, markersize=3, label=label)
    _label(axes[0], "pressure of the air [Pa]", "log")
    _label(axes[1], "bow of the face [µm]", "linear")
    _label(axes[2], "side of the part [µm], its mass and adhesion as its area", "log")
    axes[0].set_ylabel("way along that in a vacuum [µm]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=2, fontsize=10)
    figure.savefig(PAGE / "air.png", dpi=100)


def _label(axes: Axes, text: str, scale: str) -> None:
    axes.set_xscale(scale)
    axes.set_xlabel(text)
    axes.axhline(0.0, color="gray", linewidth=0.9)
    axes.grid(alpha=0.3)


if __name__ == "__main__":
    draw()
