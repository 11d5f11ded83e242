"""Figure 22, and beyond it: how far from the actuator parts come to lie, as a distribution."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from paper.found import MICRO, Found, finish, look, percent
from paper.models import MODELS, Bench, FloatArray
from paper.parameters import Effort, Place
from paper.verdict import Answer, Verdict, of_share

NAMES = ("fig22",)
FREQUENCIES: Final = np.arange(240.0, 321.0, 10.0)  # Hz
STATES: Final[tuple[tuple[Place, Place], ...]] = (
    ((80e-6, 80e-6), (0.0, 0.0)),
    ((100e-6, 100e-6), (0.0, 0.0)),
    ((100e-6, 100e-6), (0.01, 0.01)),
    ((120e-6, 40e-6), (0.0, 0.0)),
    ((60e-6, 100e-6), (0.01, -0.01)),
)
"""Places [m] and velocities [m/s]; the paper names the first and the third."""
BAND, FINE = 5e-6, 1e-6  # m
NAMED: Final = ((0, 250.0), (2, 300.0))  # states and Hz for which it states less than FINE
FEWER_STARTS: Final = 4


def find(bench: Bench, effort: Effort) -> Found:
    """Distances from the actuator, (frequencies, states, starts) in every model; nan: the part is gone."""
    p = bench.parameters
    away: dict[str, FloatArray] = {}
    for model in MODELS:
        count = max(bench.starts_of(model, effort) // FEWER_STARTS, 1)
        rows = np.full((len(FREQUENCIES), len(STATES), count), np.nan)
        starts = np.concatenate([bench.starts(place, count) for place, _ in STATES])
        speeds = np.repeat([velocity for _, velocity in STATES], count, axis=0)
        for i, frequency in enumerate(FREQUENCIES.tolist()):
            paths = bench.paths(model, [bench.drive(frequency)], starts, p.cycles / frequency, speeds)
            ends = [path.away()[-1] if path.attached else np.nan for path in paths]
            rows[i] = np.reshape(ends, (len(STATES), count))
        away[model] = rows

    def draw(figure: Figure) -> None:
        left, right = figure.subplots(1, 2)
        for model, rows in away.items():
            style = look(model)
            for k in range(len(STATES)):
                mark = {"color": style["color"], "marker": ".", "linestyle": "", "markersize": 3 + 3 * (k == 0)}
                spread = FREQUENCIES + 1.5 * (k - 2) + 0.4 * (list(MODELS).index(model) - 1)
                left.plot(np.repeat(spread, rows.shape[2]), MICRO * rows[:, k].ravel(), **mark)
            ends = np.sort(np.where(np.isnan(rows), np.inf, rows).ravel())
            right.plot(MICRO * ends, 100 * np.arange(1, len(ends) + 1) / len(ends), **style)
        left.axhline(MICRO * BAND, color="#8a8a8a", linewidth=0.8)
        left.set_yscale("symlog", linthresh=1.0)
        left.set_ylim(0, 500)
        finish(left, "frequency [Hz]", "distance from the actuator [µm]", "figure 22", legend=False)
        right.axvline(MICRO * BAND, color="#8a8a8a", linewidth=0.8)
        right.set_xlim(0, 15)
        right.set_ylim(0, 100)
        finish(right, "distance from the actuator [µm]", "share of the parts [%]", "the same as a distribution")

    data: dict[str, Any] = {"frequencies": FREQUENCIES.tolist(), "states": [list(map(list, state)) for state in STATES]}
    data |= {model: np.where(np.isnan(rows), -1.0, rows).tolist() for model, rows in away.items()}
    return Found("fig22", "Accuracy of placement", _verdicts(bench, away), data, draw, (11.5, 4.6),
                 "Where parts lie after 30 cycles, 240 to 320 Hz, five states with displaced starts; grey: the "
                 "paper's 5 µm; -1 in the data: the part is gone.")  # fmt: skip


def _verdicts(bench: Bench, away: dict[str, FloatArray]) -> tuple[Verdict, Verdict]:
    bands: dict[str, Answer] = {}
    fines: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, rows in away.items():
        share, fine = float((rows <= BAND).mean()), float((rows <= FINE).mean())
        kept = rows[np.isfinite(rows)]
        median, most = (float(np.percentile(kept, q)) if len(kept) else float("nan") for q in (50, 90))
        named = [float(rows[list(FREQUENCIES).index(f), k, 0]) for k, f in NAMED]
        numbers |= {
            f"share_{model}": share, f"share_within_1_um_{model}": fine, f"median_{model}": median,
            f"percentile_90_{model}": most, f"named_{model}": named, f"parts_{model}": rows.size,
        }  # fmt: skip
        bands[model] = of_share(
            f"{percent(share)} of {rows.size} within 5 um; median {MICRO * median:.1f}, 90 % within "
            f"{MICRO * most:.1f} um",
            share,
        )
        met = float(np.mean([value <= FINE for value in named]))
        fines[model] = Answer(" and ".join(f"{MICRO * value:.1f}" for value in named) + " um", met)
    return (
        Verdict("22", "Parts come to lie within 5 um of the actuator, for 240 to 320 Hz and a set of states.", bands,
                f"The paper names two states; here five, displaced by up to 1 um, {bench.parameters.cycles} cycles. "
                "Parts stop anywhere within the zone around the actuator where friction holds them, whose size "
                "depends on frequency.",
                numbers),
        Verdict("22 (two cases)",
                "Less than 1 um from (80, 80) um at 250 Hz, and from (100, 100) um with (0.01, 0.01) m/s at 300 Hz.",
                fines, "Where in that zone a single part stops is chance to the last micrometre of its start.",
                numbers),
    )  # fmt: skip
