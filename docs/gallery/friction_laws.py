"""The largest friction that each of the four laws bears, over the load that presses the part on."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from particle import ConstantFriction, CoulombAdhesion, FrictionTable, KogutEtsion

LAWS = {
    "constant": (ConstantFriction(30e-9), "black", "-"),
    "Coulomb with adhesion": (CoulombAdhesion(0.01, adhesion=2e-6), "#1b4f9c", "--"),
    'rough contact, preset "paper"': (KogutEtsion.paper(), "#c8371b", "-"),
    "measured": (FrictionTable([-1e-6, 0, 2e-6, 5e-6], [4e-9, 18e-9, 35e-9, 52e-9]), "#5a7d2a", "-."),
}


def draw(quick: bool = False) -> Figure:
    figure = Figure(figsize=(7, 4.4), layout="constrained")
    axes = figure.subplots()
    for name, (law, colour, style) in LAWS.items():
        first, last = max(-law.pull_off, -4e-6), min(law.largest_load, 6e-6)
        load = first + (last - first) * np.linspace(0, 1, 30 if quick else 300) ** 2
        limit = law.friction_limit(load)
        axes.plot(load * 1e6, limit * 1e9, style, color=colour, label=name)
        if law.pull_off < 4e-6:
            axes.plot(load[0] * 1e6, limit[0] * 1e9, "o", color=colour, markersize=5)
    axes.axvline(0, color="gray", linewidth=0.8)
    axes.set_ylim(0, 100)
    axes.set_xlabel("net load [µN]; the part comes off at the dots")
    axes.set_ylabel("friction limit [nN]")
    axes.legend(loc="upper left", fontsize=9)
    return figure


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_suffix(".png"), dpi=80)
