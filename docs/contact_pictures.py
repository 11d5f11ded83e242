"""Draws docs/contact.png: the forces of the rough contact over separation, and its friction limit over the net load.

And docs/contact_faces.png: a cube on the main job's plate with that contact, as a point, a face, and a point with a
local contact.
"""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from coupling import Case, build_friction, build_surface, follow_part, read_case
from particle import KogutEtsion

PAGE = Path(__file__).parent
MICRO = 1e6
CONTACTS = {
    "defaults": (KogutEtsion(), "-"),
    'preset "paper"': (KogutEtsion.paper(), "--"),
}
FORCES = {"load P": "black", "adhesion $F_s$": "#1b4f9c", "friction limit Q": "#c8371b"}
LAWS = {
    'defaults, "unrounded"': (KogutEtsion(coefficients="unrounded"), "#e59866", "-"),
    "defaults": (KogutEtsion(), "#c8371b", "-"),
    'preset "paper"': (KogutEtsion.paper(), "#c8371b", "--"),
}


def draw_contact() -> None:
    figure = Figure(figsize=(12.0, 5.2))
    FigureCanvasAgg(figure)
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.08)
    left, right = figure.subplots(1, 2)
    _draw_forces(left)
    _draw_limits(right)
    figure.savefig(PAGE / "contact.png", dpi=100)


STROKES = ("10 um", "5 um")
FLAT = {"size": "95 um"}
PARTS = {  # of a cube; colours
    "a point": (FLAT, "black"),
    "a face of 95 µm": ({"footprint": "rectangle", "sides": ["95 um", "95 um"], "thickness": "90 um"}, "#1b4f9c"),
    "a point, contact local under 95 µm": ({"size": "95 um", "local_contact": True}, "#c8371b"),
}


def draw_faces() -> None:
    figure = Figure(figsize=(12.0, 4.6))
    FigureCanvasAgg(figure)
    figure.set_layout_engine("constrained", w_pad=0.12)
    for axes, stroke in zip(figure.subplots(1, 2, sharey=True), STROKES, strict=True):
        for label, (part, colour) in PARTS.items():
            case = main_job(part, stroke)
            path = follow_part(case, build_surface(case), build_friction(case))
            times = np.linspace(0.0, path.time[-1], 1001)
            way = np.hypot(*(path.at(times).position - path.position[0]).T)
            axes.plot(times * 1e3, way * MICRO, color=colour, linewidth=1.5, label=f"{label}: {way[-1] * MICRO:.3g} µm")
        axes.set_title(f"strokes of {stroke.replace('um', 'µm')}", fontsize=11)
        axes.set_xlabel("time [ms]")
        axes.grid(alpha=0.3)
        axes.legend(loc="upper left", fontsize=9)
    figure.axes[0].set_ylabel("distance from the start [µm]")
    figure.savefig(PAGE / "contact_faces.png", dpi=100)


def main_job(part: dict[str, object], stroke: str) -> Case:
    """The main job's plate with the rough contact of the preset "paper" and a cube of 2 ug."""
    base = read_case(PAGE.parent / "examples/transport.toml")
    drives = [{"position": one.position, "stroke": stroke, "frequency": one.frequency} for one in base.actuators]
    cube = {"mass": 2e-9, "position": base.part.position, "centre_height": 45e-6}
    return Case(
        plate=base.plate,
        actuators=drives,
        part=cube | part,
        friction={"model": "kogut-etsion", "preset": "paper"} | ({"contact_area": 95e-6**2} if part == FLAT else {}),
        run={"duration": "20 ms"},
    )


def _draw_forces(axes: Axes) -> None:
    d = np.linspace(0.0, 6.0, 601)
    for contact, style in CONTACTS.values():
        for force, colour in zip(contact.forces(d), FORCES.values(), strict=True):
            axes.semilogy(d, np.where(force > 0, force, np.nan) * MICRO, style, color=colour, linewidth=1.5)
        off = contact.branch[1]
        axes.axvline(off, color="gray", linestyle=style, linewidth=0.9)
    axes.set_xlim(d[0], d[-1])
    axes.set_ylim(1e-5, 1e7)
    axes.set_xlabel("separation over roughness, $d/\\sigma$")
    axes.set_ylabel("force [µN]")
    axes.grid(alpha=0.3)
    keys = [Line2D([], [], color=colour, label=name) for name, colour in FORCES.items()]
    keys += [Line2D([], [], color="black", linestyle=style, label=name) for name, (_, style) in CONTACTS.items()]
    keys.append(Line2D([], [], color="gray", linewidth=0.9, label="pull-off"))
    axes.legend(handles=keys, loc="upper right", ncols=2, fontsize=9)
    axes.set_title("Load, adhesion and friction limit over separation", fontsize=11)


def _draw_limits(axes: Axes) -> None:
    for name, (contact, colour, style) in LAWS.items():
        net = contact.pull_off * (np.linspace(0, np.sqrt(1 + 8e-6 / contact.pull_off), 400) ** 2 - 1)
        limit = contact.friction_limit(net)
        axes.semilogy(net * MICRO, limit * MICRO, style, color=colour, linewidth=1.5, label=name)
        axes.plot(net[0] * MICRO, limit[0] * MICRO, "o", color=colour, markersize=6)
    axes.plot([], [], "o", color="gray", label="pull-off: contact ends")
    axes.axvline(0, color="gray", linewidth=0.9)
    axes.set_xlim(-4.5, 8.2)
    axes.set_xlabel("net load $N = P - F_s$ [µN]")
    axes.set_ylabel("friction limit Q [µN]")
    axes.grid(alpha=0.3)
    axes.legend(loc="center right", fontsize=9)
    axes.set_title("Friction limit over the net load, as runs use it", fontsize=11)


if __name__ == "__main__":
    draw_contact()
