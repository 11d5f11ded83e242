"""Draws docs/air.png: how far parts go over the air's pressure, their bow and their size, with a film of air.

And prints the table of the quick start's plate under three views of the gap.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from coupling import Case, PathTask, build_friction, build_part, build_surface, follow, read_case
from particle import Air, Film, KogutEtsion, Micropart, Outcome, simulate

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


def ways(case: Case, changes: list[dict[str, Any]]) -> np.ndarray[Any, np.dtype[np.float64]]:
    """How far [m] the part goes in the direction of its way in a vacuum, and whether to the end; (n, 2)."""
    surface = build_surface(case)
    cases = [case, *(case.vary({"air": {"film": True}}).vary(change) for change in changes)]
    paths = follow([PathTask(surface, build_part(one), build_friction(one), one.run) for one in cases])
    free, *moved = [path.position[-1] - path.position[0] for path in paths]
    kept = [path.outcome in (Outcome.STUCK, Outcome.MOVING) for path in paths[1:]]
    return np.column_stack([np.array(moved) @ free / np.hypot(*free), kept])


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
        print(label, np.round(found[:, 0] * MICRO, 3).tolist())
        for panel, values, scale in zip(axes, (PRESSURES, BOWS, SIZES), (1.0, MICRO, MICRO), strict=True):
            (own, kept), found = found[: len(values)].T, found[len(values) :]
            panel.plot(values * scale, own * MICRO, "o-", color=colour, markersize=3, label=label)
            lost = kept == 0
            panel.plot(values[lost] * scale, own[lost] * MICRO, "x", color=colour, markersize=7)
    _label(axes[0], "pressure of the air [Pa]", "log")
    _label(axes[1], "bow of the face [µm]", "linear")
    _label(axes[2], "side of the part [µm], its mass and adhesion as its area", "log")
    axes[0].set_ylabel("way along that in a vacuum [µm]")
    axes[0].plot([], [], "x", color="gray", label="comes off before the end")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3, fontsize=10)
    figure.savefig(PAGE / "air.png", dpi=100)


class Bent(Film):
    """A film over asperities that follow the bent surface, whatever the part's law."""

    def layer(self, friction: Any) -> Any:
        return super().layer(friction)._replace(bends=True)


class Flat(Film):
    """A film on a plate that does not bend under the part."""

    def layer(self, friction: Any) -> Any:
        layer = super().layer(friction)
        means, products = layer.means.copy(), layer.products.copy()
        means[1:] = products[1:] = 0.0
        return layer._replace(means=means, products=products, places=layer.places * [0, 0, 0, 1])


def quick_start() -> None:
    """Print the ways of a cube on the quick start's plate."""
    drives = [{"position": ["0 um", "0 um"], "stroke": "10 um", "frequency": "2 kHz", "cycles": 40}]
    part = {"mass": "2 ug", "size": SIZE, "centre_height": "45 um", "position": ["300 um", "200 um"]}
    law = {"model": "coulomb", "coefficient": 0.1, "adhesion": "1.5 uN"}
    case = Case(plate=GENTLE["plate"], actuators=drives, part=part, friction=law, run={"duration": "30 ms"})
    surface, point, friction = build_surface(case), build_part(case), build_friction(case)
    assert isinstance(point, Micropart)
    start = np.array(case.part.position)
    drag = Air().drag(SIZE**2, float(KogutEtsion().mean_gap(3.67)))
    parts = {"vacuum": point, "drag": replace(point, drag=drag)}
    airs = [Air(), *(Air(bow=bow / MICRO) for bow in (0.2, 0.5, 1.0)), Air(pressure=1000.0)]
    films = [kind(air, SIZE) for air in airs for kind in (Film, Flat, Bent)]
    parts |= {f"{type(film).__name__}, {film.air}": replace(point, film=film) for film in films}
    for name, one in parts.items():
        path = simulate(surface, one, friction, case.run.duration)
        print(f"{name}: {(path.position[-1] - start) @ start / np.hypot(*start) * MICRO:.1f} um")


def _label(axes: Axes, text: str, scale: str) -> None:
    axes.set_xscale(scale)
    axes.set_xlabel(text)
    axes.axhline(0.0, color="gray", linewidth=0.9)
    axes.grid(alpha=0.3)


if __name__ == "__main__":
    draw()
    quick_start()
