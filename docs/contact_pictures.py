"""Draws docs/contact.png: the forces of the rough contact over separation, and its friction limit over the net load.

And docs/contact_faces.png: parts with that contact as a point and a face, each by the flat law and the local one.
"""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from coupling import Case, build_friction, build_surface, follow_part, read_case
from particle import KogutEtsion, Outcome

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


CUBE = {"footprint": "rectangle", "sides": ["95 um", "95 um"], "thickness": "90 um"}
CHIP = {"footprint": "rectangle", "sides": ["100 um", "100 um"], "thickness": "20 um"}
LOCAL = {"local_contact": True}
CASES = {  # title: the example, its strokes, the part with a face, how long
    "main job's plate, strokes of 10 µm, a cube": ("transport", "10 um", CUBE, "20 ms"),
    "the same, strokes of 5 µm": ("transport", "5 um", CUBE, "20 ms"),
    "outside the theory: the paper's case, a chip": ("two_actuators", "150 um", CHIP, "50 ms"),
}
COLOURS = {
    "a point": "black",
    "a face": "#1b4f9c",
    "a point, local contact": "#c8371b",
    "a face, local contact": "#2a8a4a",
}
ENDS = {Outcome.TIPPED: "tips", Outcome.DETACHED: "comes off"}


def draw_faces() -> None:
    figure = Figure(figsize=(15.0, 4.8))
    FigureCanvasAgg(figure)
    figure.set_layout_engine("constrained", w_pad=0.12)
    for axes, (title, chosen) in zip(figure.subplots(1, 3), CASES.items(), strict=True):
        for label, case in cases(*chosen).items():
            path = follow_part(case, build_surface(case), build_friction(case))
            times = np.linspace(0.0, path.time[-1], 1001)
            way = np.hypot(*(path.at(times).position - path.position[0]).T)
            end = f", {ENDS[path.outcome]} at {path.time[-1] * 1e3:.3g} ms" if path.outcome in ENDS else ""
            line = {"color": COLOURS[label], "linewidth": 1.5, "label": f"{label}: {way[-1] * MICRO:.3g} µm{end}"}
            axes.plot(times * 1e3, way * MICRO, **line)
            if end:
                axes.plot(path.time[-1] * 1e3, way[-1] * MICRO, "x", color=COLOURS[label], markersize=8, clip_on=False)
        axes.set_title(title, fontsize=11)
        axes.set_xlabel("time [ms]")
        axes.grid(alpha=0.3)
        axes.set_ylim(0.0, 1.45 * axes.get_ylim()[1])
        axes.legend(loc="upper left", fontsize=9)
    figure.axes[0].set_ylabel("distance from the start [µm]")
    figure.savefig(PAGE / "contact_faces.png", dpi=100)


def cases(name: str, stroke: str, face: dict[str, object], duration: str) -> dict[str, Case]:
    """An example's plate and start with the rough contact of the preset "paper" and four parts of 2 ug."""
    base = read_case(PAGE.parent / f"examples/{name}.toml")
    drives = [{"position": one.position, "stroke": stroke, "frequency": one.frequency} for one in base.actuators]
    side = float(face["sides"][0].split()[0]) * 1e-6  # type: ignore[index]
    height = float(str(face["thickness"]).split()[0]) * 0.5e-6
    point, flat = {"size": side, "centre_height": height}, {"contact_area": side**2}
    parts = {"a point": (point, flat), "a face": (face, {})}
    parts |= {"a point, local contact": (point | LOCAL, {}), "a face, local contact": (face | LOCAL, {})}
    return {
        label: Case(
            plate=base.plate,
            actuators=drives,
            part={"mass": 2e-9, "position": base.part.position} | part,
            friction={"model": "kogut-etsion", "preset": "paper"} | area,
            run={"duration": duration},
        )
        for label, (part, area) in parts.items()
    }


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
