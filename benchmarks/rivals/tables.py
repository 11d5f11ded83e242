"""Tables and the picture of the rivals for `docs/benchmarks.md`."""

from __future__ import annotations

from collections.abc import Sequence

from report import DOCS, short

from rivals.compare import COMPILED, FIXED, JAX, LOOP, MANY, NUMPY_SCIPY, OURS, SCIPY, TARGETS, Row

PICTURE = DOCS / "benchmark_paths.png"
STYLES = {
    LOOP: ("#c0392b", "s"),
    MANY: ("#e59866", "D"),
    COMPILED: ("#7f8c8d", "v"),
    FIXED: ("#b7950b", "P"),
    JAX: ("#8e44ad", "X"),
    NUMPY_SCIPY: ("#85c1e9", "^"),
    SCIPY: ("#1b4f72", "^"),
}


def ratios_table(rows: Sequence[Row]) -> list[str]:
    """Time over ours: a line for each error and method, a column for each problem."""
    names = list(dict.fromkeys(row.problem for row in rows))
    lines = ["| error | method | " + " | ".join(names) + " |", "|---|---|" + "---:|" * len(names)]
    for target in TARGETS:
        for method in STYLES:
            found = {row.problem: row for row in rows if (row.target, row.method) == (target, method)}
            if found:
                cells = [_ratio(found[name]) if name in found else "-" for name in names]
                lines.append(f"| {target:.0e} | {method} | " + " | ".join(cells) + " |")
    return lines


def _ratio(row: Row) -> str:
    middle, least, most = (short(value) for value in row.ratio)
    mark = " *" if row.extrapolated else ""
    return f"{middle} ({least} - {most}){mark}"


def work_table(rows: Sequence[Row]) -> list[str]:
    """Evaluations of the surface, and steps of fixed length."""
    names = list(dict.fromkeys(row.problem for row in rows))
    lines = ["| error | work | " + " | ".join(names) + " |", "|---|---|" + "---:|" * len(names)]
    for target in TARGETS:
        for method, label in ((OURS, "evaluations, ours"), (SCIPY, "evaluations, scipy"), (COMPILED, "fixed steps")):
            found = {row.problem: row.work for row in rows if (row.target, row.method) == (target, method)}
            if found:
                cells = [_count(found[name]) if name in found else "-" for name in names]
                lines.append(f"| {target:.0e} | {label} | " + " | ".join(cells) + " |")
    return lines


def _count(number: int) -> str:
    return f"{number:,}".replace(",", " ") if number < 1_000_000 else f"{number:.1e}"


def draw(rows: Sequence[Row]) -> None:
    """Time over ours against the number of actuators, constant friction; a panel for each error."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, len(TARGETS), figsize=(12, 5), sharey=True, layout="constrained")
    counts = sorted({row.actuators for row in rows})
    for axis, target in zip(axes, TARGETS, strict=True):
        for method, (colour, marker) in STYLES.items():
            found = {
                row.actuators: row.ratio[0]
                for row in rows
                if (row.target, row.method) == (target, method) and row.problem == str(row.actuators)
            }
            if found:
                axis.loglog(list(found), list(found.values()), color=colour, marker=marker, ms=6, label=method)
        axis.axhline(1, color="#111111", lw=2.2, label=OURS)
        axis.set(title=f"end point to {target:.0e} of the path", xlabel="actuators")
        axis.set_xticks(counts, [str(count) for count in counts])
        axis.minorticks_off()
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("time of one path, over ours")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    figure.savefig(PICTURE, dpi=150)
    plt.close(figure)
