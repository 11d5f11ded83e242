"""A part on a platform that shakes up and down too hard for adhesion: it comes off, flies and lands."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from particle import CoulombAdhesion, Drive, Micropart, State, platform_surface, simulate

MASS = 2e-9  # kg


def draw(quick: bool = False) -> Figure:
    shake = Drive(stroke=20e-6, frequency=300.0, cycle="cosine")
    surface = platform_surface(x=Drive(10e-6, 300.0, "cosine"), z=shake, size=20e-6)
    friction = CoulombAdhesion(coefficient=0.3, adhesion=10e-9)
    path = simulate(surface, Micropart(MASS, (0.0, 0.0)), friction, 5e-3 if quick else 20e-3, after_detachment="fly")

    time = np.linspace(0, path.time[-1], 100 if quick else 1500)
    part = path.at(time)
    figure = Figure(figsize=(8, 4.4), layout="constrained")
    upper, lower = figure.subplots(2, sharex=True)
    upper.plot(time * 1e3, part.height * 1e6, color="#c8371b", label="part")
    upper.plot(time * 1e3, shake.evaluate(time)[0] * 1e6, "--", color="black", linewidth=1, label="platform")
    upper.set_ylabel("height [µm]")
    lower.plot(time * 1e3, part.position[:, 0] * 1e6, color="#c8371b")
    lower.set_ylabel("part along the\nplatform [µm]")
    lower.set_xlabel("time [ms]")
    for axes in (upper, lower):
        flies = part.state == State.FLIGHT
        axes.fill_between(
            time * 1e3, 0, 1, where=flies, transform=axes.get_xaxis_transform(), color="#e8e0d0", label="in flight"
        )
        axes.set_xlim(0, time[-1] * 1e3)
    figure.legend(*upper.get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_suffix(".png"), dpi=80)
