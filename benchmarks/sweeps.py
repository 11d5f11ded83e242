"""Sweeps on one thread, on two, and on two workers of a dask cluster: the tables of docs/sweeps.md.

.venv/bin/python benchmarks/sweeps.py                     10 000 paths of 20 ms over two actuators, each way in turn
.venv/bin/python benchmarks/sweeps.py --memory 1000000    the memory of a sweep of so many short paths, as it goes on

Every way must give the same bits as the first before its time counts.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from distributed import LocalCluster

from active_surface.studies import Study, read_study, run_study
from coupling import read_case

CASE = Path(__file__).parents[1] / "examples/two_actuators.toml"
STUDY = """\
[study]
case = "two_actuators.toml"
sampling = "random"
points = {points}

[[axes]]
field = "actuators.0.stroke"
range = ["40 um", "60 um"]

[[axes]]
field = "actuators.1.stroke"
range = ["40 um", "60 um"]

[[axes]]
field = "actuators.*.frequency"
range = ["300 Hz", "600 Hz"]
"""
LONG, SHORT = 20e-3, 0.1e-3  # s, of the paths
COUNT, FEW, REPEATS = 10_000, 40, 5
TOLD = 20  # times that memory is told
WORKERS = 2


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=COUNT, help=f"paths [{COUNT}]")
    parser.add_argument("--repeats", type=int, default=REPEATS, help=f"of each way [{REPEATS}]")
    parser.add_argument("--memory", type=int, metavar="PATHS", help="the memory of one sweep instead")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if asked.memory:
            memory(study_of(Path(folder), asked.memory, SHORT), Path(folder))
        else:
            ways(Path(folder), asked.count, asked.repeats)


def study_of(folder: Path, points: int, duration: float) -> Study:
    """So many paths of a duration [s] over two actuators, with random strokes and frequency."""
    folder.mkdir(exist_ok=True)
    path = folder / "study.toml"
    path.write_text(STUDY.format(points=points))
    case = read_case(CASE)
    return read_study(path, case.model_copy(update={"run": case.run.model_copy(update={"duration": duration})}))


def ways(folder: Path, count: int, repeats: int) -> None:
    """Prints how long each way took, one after the other in every round, and the ratios within rounds.

    A few paths are found each time as well: what these take is the plate, which workers keep from round to round.
    """
    few, many = (study_of(folder / name, points, LONG) for name, points in (("few", FEW), ("many", count)))
    with LocalCluster(n_workers=WORKERS, threads_per_worker=1, dashboard_address=":0") as cluster:
        found: dict[str, dict[str, Any]] = {
            "one thread": {"threads": 1},
            "two threads": {"threads": WORKERS},
            "two workers of one thread": {"scheduler": cluster.scheduler_address},
        }
        whole: dict[str, list[float]] = {name: [] for name in found}
        paths: dict[str, list[float]] = {name: [] for name in found}
        first: bytes | None = None
        for turn in range(repeats + 1):  # the first compiles
            for name, way in found.items():
                begin, _ = time.perf_counter(), bits(few, way)
                middle, same = time.perf_counter(), bits(many, way)
                end = time.perf_counter()
                first = first or same
                assert same == first, f"{name}: other bits"
                if turn:
                    whole[name].append(end - middle)
                    paths[name].append((end - middle) - (middle - begin))
    print(f"\n| {count} paths | all of it, s | paths a second | of the paths alone | over one thread |")
    print("|---|---|---|---|---|")
    for name in found:
        rates, alone = np.divide(count, whole[name]), np.divide(count - FEW, paths[name])
        print(f"| {name} | {shown(whole[name])} | {shown(rates)} | {shown(alone)} ", end="")
        print(f"| {shown(np.divide(paths['one thread'], paths[name]))} |")
    efficiency = np.divide(paths["two threads"], paths["two workers of one thread"])
    print(f"\npaths alone: time on two threads over that on two workers: {shown(efficiency)}; all bits are the same")


def shown(values: Any) -> str:
    return f"{np.median(values):.3g} ({np.min(values):.3g} - {np.max(values):.3g})"


def bits(study: Study, way: dict[str, Any]) -> bytes:
    dataset = run_study(study, **way).dataset
    return b"".join(dataset[name].values.tobytes() for name in sorted(map(str, dataset.variables)))


def memory(study: Study, folder: Path) -> None:
    """Prints how much memory a sweep takes as it goes on, and at most."""
    count, told = len(study.points), [0]

    def tell(done: int, of: int) -> None:
        if done * TOLD >= told[0] * of:
            told[0] = done * TOLD // of + 1
            print(f"{done:>9} paths  {current():6.0f} MB", flush=True)

    begin = time.perf_counter()
    run_study(study, folder / "out", tell=tell)
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{count} paths in {time.perf_counter() - begin:.0f} s; at most {most:.0f} MB")


def current() -> float:
    """The memory [MB] that this process has now."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 2**20


if __name__ == "__main__":
    main()
