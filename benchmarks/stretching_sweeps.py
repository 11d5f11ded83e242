"""A sweep of 1 000 points over a plate that stretches, and the same over a linear one.

    .venv/bin/python benchmarks/stretching_sweeps.py               writes a table for benchmarks/RESULTS.md
    .venv/bin/python benchmarks/stretching_sweeps.py --count 200   another number of points; writes nothing
    .venv/bin/python benchmarks/stretching_sweeps.py --whole       also whole sweeps, from study to results

Random strokes, frequencies, delays and starts around examples/transport.toml, so that no two points share drives. The
part is a point that adheres by 1.3 uN with a coefficient of friction of 0.05: none comes off a linear plate. The
reduced model is made, or read from disk, before the clock runs. First the linear paths must be those of single runs to
the bit, and the others those of single runs, each with a model of its own, to `AGREEMENT` of their length. Then blocks
of both sweeps take turns.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path
from typing import Literal

import numpy as np
import report
from numpy.typing import NDArray

from active_surface.studies import Engine, Study, read_study, run_study
from coupling import read_case, run_case

FloatArray = NDArray[np.float64]

CASE = Path(__file__).parents[1] / "examples/transport.toml"
STUDY = """\
[study]
case = "transport.toml"
sampling = "random"
points = {points}

[[axes]]
field = "actuators.*.stroke"
range = ["8 um", "10 um"]

[[axes]]
field = "actuators.0.frequency"
range = ["1100 Hz", "1400 Hz"]

[[axes]]
field = "actuators.1.delay"
range = ["0 us", "400 us"]

[[axes]]
field = "part.position.0"
range = ["-160 um", "-80 um"]
"""
DURATION, COUNT, BLOCK = 20e-3, 1000, 50  # s, paths
POINT = {"mass": "2e-9 kg", "centre_height": "45 um", "size": "95 um", "position": ["-120 um", "-80 um"]}
FRICTION = {"coefficient": 0.05, "adhesion": 1.3e-6}  # -, N
THEORIES: tuple[Literal["linear", "von-karman"], ...] = ("linear", "von-karman")
CHECKED, AGREEMENT = 3, 1e-4


def study_of(folder: Path, theory: Literal["linear", "von-karman"], points: int) -> Study:
    """The study with a plate of a theory."""
    path = folder / f"{theory}.toml"
    path.write_text(STUDY.format(points=points))
    case = read_case(CASE).vary({"part": POINT, "run.tolerance": 1e-9})
    plate = case.plate.model_copy(update={"theory": theory})
    run = case.run.model_copy(update={"duration": DURATION})
    friction = case.friction.model_copy(update=FRICTION)
    return read_study(path, case.model_copy(update={"plate": plate, "run": run, "friction": friction}))


def check(engine: Engine, exact: bool) -> float:
    """The largest distance of a few ends from those of single runs, over the path's length."""
    records, off = engine.records(range(CHECKED)), 0.0
    for k, values in enumerate(engine.study.points.values(range(CHECKED))):
        path = run_case(engine.variants.at(values)[0]).trajectory
        end = np.array([records["end_x"][k], records["end_y"][k]])
        off = max(off, float(np.linalg.norm(end - path.position[-1]) / path.path_length))
    assert off == 0.0 if exact else off < AGREEMENT, f"paths are off by {off:.1e} of their length"
    return off


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=COUNT, help=f"points [{COUNT}]")
    parser.add_argument("--threads", type=int, help="paths at a time [one on each processor]")
    parser.add_argument("--whole", action="store_true", help="also whole sweeps")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        studies = [study_of(Path(folder), theory, asked.count) for theory in THEORIES]
        engines = [Engine(study, asked.threads) for study in studies]
        off = [check(engine, theory == "linear") for theory, engine in zip(THEORIES, engines, strict=True)]
        print(f"ends beside those of single runs: {off[0]:.0e} (linear) and {off[1]:.0e} (von Karman) of their paths")
        times, evaluations = blocks(engines)
        if asked.whole:
            whole = [whole_sweep(study, asked.threads) for study in studies]
            print(f"whole sweeps, with surface, check of the model and files: {whole[1] / whole[0]:.2f} times as long")
    rates = BLOCK / times
    ratio = rates[1] / rates[0]
    print(f"ratio in each block: median {np.median(ratio):.2f}, {ratio.min():.2f} to {ratio.max():.2f}")
    lines = [
        "| theory | evaluations of a path | time of a path, over linear | paths a second, over linear |",
        "|---|---:|---:|---:|",
    ]
    for k, theory in enumerate(("linear", "von Karman")):
        over, rate = float(np.median(times[k] / times[0])), float(np.median(rates[k] / rates[0]))
        lines.append(f"| {theory} | {evaluations[k]:.0f} | {over:.2f} | {rate:.2f} |")
    print("\n".join(lines))
    if asked.count == COUNT:
        report.write("stretching sweeps", lines)


def blocks(engines: list[Engine]) -> tuple[FloatArray, list[float]]:
    """The times (2, blocks) [s] of the blocks of both sweeps in turns, and the mean evaluations of a path."""
    count = engines[0].paths // BLOCK
    times, evaluations, lost = np.zeros((2, count)), [0.0, 0.0], [0, 0]
    for block in range(count):
        for k, engine in enumerate(engines):
            begin = time.perf_counter()
            records = engine.records(range(block * BLOCK, (block + 1) * BLOCK))
            times[k, block] = time.perf_counter() - begin
            assert not records["mistakes"].any()
            lost[k] += int((records["end_time"] < DURATION * (1 - 1e-9)).sum())
            evaluations[k] += float(records["evaluations"].mean()) / count
    print(f"paths that end early: {lost[0]} and {lost[1]}")
    return times, evaluations


def whole_sweep(study: Study, threads: int | None) -> float:
    """Seconds for the sweep from study to results, with surface, check of the model and files."""
    begin = time.perf_counter()
    run_study(study, threads=threads)
    return time.perf_counter() - begin


if __name__ == "__main__":
    main()
