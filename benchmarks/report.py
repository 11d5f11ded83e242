"""Tables of `benchmarks/RESULTS.md`, and its picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

FOLDER = Path(__file__).parent
PAGE, PICTURE = FOLDER / "RESULTS.md", FOLDER / "plate.png"
OURS = "active-surface"
TARGETS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
# Drawn: prefix of the method's name, colour, marker.
STYLES = {
    "active-surface, degree 5": ("#7d6608", "o"),
    "active-surface, to a tolerance": ("#111111", "o"),
    "scikit-fem Argyris": ("#c0392b", "s"),
    "scikit-fem Morley": ("#e59866", "D"),
    "NGSolve, point loads": ("#7f8c8d", "v"),
    "NGSolve degree 4, subtracted": ("#aed6f1", "^"),
    "NGSolve degree 8, subtracted": ("#3498db", "^"),
    "NGSolve degree 12, subtracted": ("#1b4f72", "^"),
}


@dataclass(frozen=True)
class Figures:
    """What one run gave. errors: of w, gradient and Hessian.  time: median, least, most, over the unit's."""

    method: str
    unknowns: int
    errors: list[float]
    time: tuple[float, float, float]


def by_method(figures: Sequence[Figures]) -> dict[str, list[Figures]]:
    return {name: [f for f in figures if f.method == name] for name in dict.fromkeys(f.method for f in figures)}


def short(number: float) -> str:
    """Two digits."""
    return f"{float(f'{number:.2g}'):g}"


def runs_table(figures: Sequence[Figures]) -> list[str]:
    lines = ["| method | unknowns | w | gradient | Hessian | time (range) |", "|---|---:|---:|---:|---:|---:|"]
    for f in figures:
        w, gradient, hessian = (f"{error:.0e}" for error in f.errors)
        middle, least, most = map(short, f.time)
        lines.append(f"| {f.method} | {f.unknowns} | {w} | {gradient} | {hessian} | {middle} ({least} - {most}) |")
    return lines


def time_to(figures: Sequence[Figures], target: float) -> float:
    """Time to a Hessian error, on straight lines through a method's runs in log-log; inf where none reaches it."""
    errors, times = np.array([f.errors[2] for f in figures]), np.array([f.time[0] for f in figures])
    order = np.argsort(-errors)
    errors, times = errors[order], times[order]
    if errors[-1] > target:
        return np.inf
    if errors[0] <= target:
        return float(times[0])  # its cheapest run is already better
    return float(np.exp(np.interp(-np.log(target), -np.log(errors), np.log(times))))


def targets_table(figures: Sequence[Figures]) -> list[str]:
    """Times to several Hessian errors over our best, by method and for NGSolve's best."""
    methods = by_method(figures)
    times = {name: [time_to(runs, target) for target in TARGETS] for name, runs in methods.items()}
    ours = np.min([row for name, row in times.items() if name.startswith(OURS)], axis=0).tolist()
    lines = ["| time over ours to a Hessian error of | " + " | ".join(f"{t:.0e}" for t in TARGETS) + " |"]
    lines.append("|---|" + "---:|" * len(TARGETS))
    if ngsolve := [row for name, row in times.items() if name.startswith("NGSolve")]:
        times["**NGSolve, best of all**"] = np.min(ngsolve, axis=0).tolist()
    for name, row in times.items():
        ratios = [short(t / own) if np.isfinite(t) else "not reached" for t, own in zip(row, ours, strict=True)]
        lines.append(f"| {name} | " + " | ".join(ratios) + " |")
    return lines


def draw(figures: Sequence[Figures], unit: int) -> None:
    """Error of the Hessian against unknowns and against time.

    unit: unknowns of the run that times are given in.
    """
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    _, axes = plt.subplots(1, 2, figsize=(11, 5), sharey=True, layout="constrained")
    for name, runs in by_method(figures).items():
        if name not in STYLES:
            continue
        colour, marker = STYLES[name]
        errors = [f.errors[2] for f in runs]
        width = 2.2 if name.startswith(OURS) else 1.3
        for axis, x in zip(axes, ([f.unknowns for f in runs], [f.time[0] for f in runs]), strict=True):
            axis.loglog(x, errors, color=colour, marker=marker, lw=width, ms=5, label=name)
    axes[0].set(xlabel="unknowns", ylabel="largest error of the Hessian, relative")
    axes[1].set(xlabel=f"time, in runs of {OURS} with {unit} unknowns")
    for axis in axes:
        axis.grid(alpha=0.3)
    handles, labels = axes[0].get_legend_handles_labels()
    axes[0].figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    axes[0].figure.savefig(PICTURE, dpi=150)


def write(block: str, lines: Sequence[str], page: Path = PAGE) -> None:
    """Replaces what stands between a page's markers of a block."""
    begin, end = f"<!-- {block}: generated -->", f"<!-- {block}: end -->"
    before, rest = page.read_text().split(begin)
    _, after = rest.split(end)
    page.write_text(f"{before}{begin}\n\n" + "\n".join(lines) + f"\n\n{end}{after}")
