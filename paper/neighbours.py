"""Figure 16: two actuators at one frequency, at which the part stays with the first one or goes to the other."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from paper.found import MICRO, Found, finish, percent
from paper.models import Bench, Path
from paper.pairs import JUMPS, draw_plane, joined, paths_of
from paper.parameters import Effort, Place
from paper.verdict import FEW, MOST, Answer, Verdict

NAMES = ("fig16",)
START: Final[Place] = (-50e-6, 15e-6)  # m, that of figure 21: figure 16's is not stated
FREQUENCIES: Final = (250.0, 350.0, 450.0, 550.0, 650.0)  # Hz
CYCLES: Final = 10


def find(bench: Bench, effort: Effort) -> Found:
    """Paths at every frequency, from jittered starts."""
    p = bench.parameters
    paths: dict[float, dict[str, list[Path]]] = {}
    for frequency in FREQUENCIES:
        drives = [bench.drive(frequency)] * 2
        paths[frequency] = paths_of(bench, effort, drives, START, CYCLES / frequency)
    drawn = {f: {name: rows[0].drawn(300) for name, rows in both.items()} for f, both in paths.items()}

    def draw(figure: Figure) -> None:
        axes = [figure.add_subplot(2, 3, k + 1) for k in range(len(FREQUENCIES))]
        for one, (frequency, rows) in zip(axes, drawn.items(), strict=True):
            draw_plane(one, rows, p.pitch)
            finish(one, "x [µm]", "y [µm]", f"{frequency:g} Hz", legend=False)
        figure.legend(*axes[0].get_legend_handles_labels(), loc=(0.75, 0.2), frameon=False)

    data: dict[str, Any] = {"frequencies": list(FREQUENCIES), "start": list(START)}
    data |= {f"{f:g} Hz, {name}": rows.tolist() for f, both in drawn.items() for name, rows in both.items()}
    return Found("fig16", "Two actuators at one frequency", (_verdict(paths, p.pitch),), data, draw, (12.5, 6.6),
                 f"Paths from ({MICRO * START[0]:g}, {MICRO * START[1]:g}) um in {CYCLES} cycles; "
                 "crosses: their ends.")  # fmt: skip


def goes_over(path: Path, pitch: float) -> bool:
    """Whether the part is ever nearer to the other actuator."""
    return bool((path.place[:, 0] > pitch / 2).any())


def _verdict(paths: dict[float, dict[str, list[Path]]], pitch: float) -> Verdict:
    answers, numbers = {}, {}
    for name in paths[FREQUENCIES[0]]:
        shares = {f: float(np.mean([goes_over(path, pitch) for path in both[name]])) for f, both in paths.items()}
        low, high = shares[FREQUENCIES[0]], [shares[f] for f in FREQUENCIES[1:]]
        met = [1.0 if low <= FEW else 0.0 if low >= MOST else 0.5]
        met += [1.0 if share >= MOST else 0.0 if share <= FEW else 0.5 for share in high]
        numbers[f"share_that_goes_over, {name}"] = list(shares.values())
        answers[name] = Answer(f"{percent(low)} at 250, {', '.join(map(percent, high))}", float(np.mean(met)))
    numbers["frequencies"] = list(FREQUENCIES)
    return Verdict(
        "16", "At 250 Hz the part stays with the first actuator, crosses it and returns; at higher frequencies "
        "up to 650 Hz it goes to the neighbour.", joined(answers),
        f"Share of starts that ever come nearer to the neighbour, at {', '.join(f'{f:g}' for f in FREQUENCIES)} Hz. "
        f"{JUMPS}The start is not stated; taken as in figure 21.", numbers,
    )  # fmt: skip
