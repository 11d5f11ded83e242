"""A part on a platform that is shaken harder and harder: it follows, slips, and comes to rest elsewhere."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from coupling import read_case, run_case
from particle import EventKind

CASE = Path(__file__).parents[2] / "examples/shaker.toml"


def draw(quick: bool = False) -> Figure:
    result = run_case(read_case(CASE))
    time = np.linspace(0, result.trajectory.time[-1], 50 if quick else 800)
    offset = result.trajectory.at(time).position[:, 0]  # m, of the part from where it began on the platform
    platform = time * np.sin(3.2 * time)

    figure = Figure(figsize=(8, 4.6), layout="constrained")
    upper, lower = figure.subplots(2, sharex=True)
    upper.plot(time, platform, color="black", label="platform")
    upper.plot(time, platform + offset, "--", color="#c8371b", label="part")
    upper.set_ylabel("position [m]")
    upper.legend(loc="lower left", fontsize=9)
    lower.plot(time, offset, color="#c8371b")
    lower.set_ylabel("part over\nplatform [m]")
    lower.set_xlabel("time [s]")
    names = {EventKind.SLIPS: "slips", EventKind.STOPS: "stops"}
    for event in result.trajectory.events:
        for axes in (upper, lower):
            axes.axvline(event.time, color="gray", linewidth=0.8)
        if event.kind in names:
            lower.text(event.time + 0.02, -1.7, names[event.kind], fontsize=9)
    return figure


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_suffix(".png"), dpi=80)
