"""One sweep, from study to results: this file reads as the pipeline.

study -> paths kept of an earlier sweep -> chunks of the others -> their records -> table on disk -> check of the model
-> one file of all -> picture
"""

from __future__ import annotations

import math
import tempfile
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from active_surface.studies.axes import counted
from active_surface.studies.cluster import records_on
from active_surface.studies.columns import OUTCOMES
from active_surface.studies.engine import Engine
from active_surface.studies.pictures import draw_sweep
from active_surface.studies.study import Study
from active_surface.studies.sweep_file import (
    differences,
    finished_paths,
    key_of,
    keys_of,
    read_dataset,
    renew_labels,
    slabs,
    write_sweep,
)
from active_surface.studies.sweep_table import SweepTable, sweep_table
from active_surface.studies.validity import model_warnings
from coupling import ProgressCallback, no_progress
from coupling.case import quoted
from particle import Outcome

if TYPE_CHECKING:
    import xarray

ENDING = ".nc"
AT_END = dict.fromkeys((Outcome.STUCK.value, Outcome.MOVING.value), " at the end")  # it may have been otherwise before


@dataclass(frozen=True, eq=False)
class Sweep:
    """The results of a sweep; `files` are those it wrote.

    With files, `dataset` reads from the first of them on demand, until `dataset.close()`.
    """

    study: Study
    dataset: xarray.Dataset = field(repr=False)
    files: tuple[Path, ...] = ()
    kept: int = 0  # paths that the file had before, those of a smaller study among them

    @property
    def outcomes(self) -> dict[str, int]:
        """How many paths ended how."""
        counts = np.bincount(self.dataset["outcome"].values.ravel(), minlength=len(OUTCOMES))
        return {name: int(count) for name, count in zip(OUTCOMES, counts, strict=True) if count}

    @property
    def warnings(self) -> list[str]:
        """Where the model stops holding: at the base case and a few corners of the axes."""
        return str(self.dataset.attrs["warnings"]).splitlines()

    @property
    def refused(self) -> list[int]:
        """The numbers of the paths that were refused."""
        return np.flatnonzero(self.dataset["mistakes"].values.ravel()).tolist()

    @property
    def first_refused(self) -> list[str]:
        """What is wrong with the first refused point; empty: there is none."""
        refused = self.refused
        return Engine(self.study).faults(refused[0]) if refused else []


def run_study(
    study: Study,
    output: str | Path | None = None,
    threads: int | None = None,
    tell: ProgressCallback = no_progress,
    scheduler: str | None = None,
    overwrite: bool = False,
) -> Sweep:
    """Follow all paths of a study.

    Finished paths are kept in the file NAME.sweep of the output folder until all are done; an interrupted sweep resumes
    from them. If NAME.nc holds the same numbers, no path is computed again; other labels rewrite the file. If
    it holds some of the study's paths and no others, as after values, points, repeats or an axis were added, these are
    kept and the rest is computed: the results have the bits of a sweep made at once.

    Parameters
    ----------
    study : Study
        The study.
    output : path, optional
        Folder for NAME.nc and NAME.sweep.png.
    threads : int, optional
        Number of paths at a time, by default one on each processor.
    tell : callable
        Called with the number of finished paths, and of all.
    scheduler : str, optional
        Address of a dask scheduler whose workers compute the paths, each with all of its own threads.
    overwrite : bool
        Replace the results of another study, or of other versions, in NAME.nc; paths that both have are kept.

    Returns
    -------
    sweep : Sweep
        The labelled results.

    Raises
    ------
    ValueError
        NAME.nc or NAME.sweep is something else or damaged, or the study is none.
    RuntimeError
        Another process sweeps in the folder by that name.
    OSError
        The disk is full.
    KeyboardInterrupt
        Ctrl-C.
    """
    if not isinstance(study, Study):
        raise ValueError(f"Input study of run_study must be a Study, as read_study makes it; got {quoted(study)}")
    if output is None:
        with tempfile.TemporaryDirectory() as folder:
            file, _ = _results_file(study, Path(folder), threads, tell, scheduler, False)
            with read_dataset(file) as dataset:
                return Sweep(study, dataset.load())
    file, kept = _results_file(study, Path(output), threads, tell, scheduler, overwrite)
    dataset = read_dataset(file)
    picture = draw_sweep(study, dataset, file.with_suffix(".sweep.png"))
    return Sweep(study, dataset, (file, picture), kept)


def _results_file(
    study: Study, folder: Path, threads: int | None, tell: ProgressCallback, scheduler: str | None, overwrite: bool
) -> tuple[Path, int]:
    """Compute what is missing in a folder; returns the file of all results there, and how many paths it had before."""
    file = folder / f"{study.name}{ENDING}"
    with sweep_table(folder / f"{study.name}.sweep") as table:
        table.ask(keys_of(study))
        if key_of(file) == study.key:
            renew_labels(study, file)
            kept = len(study.points)
        else:
            kept = _keep(study, file, table, overwrite)
            engine = Engine(study, threads)
            _compute(engine, table, tell, scheduler)
            counts = (math.prod(piece.stop - piece.start for piece in slab) for slab in slabs(study.points.shape))
            write_sweep(study, table.records(counts), file, model_warnings(engine))
        table.clear()
    return file, kept


def _keep(study: Study, file: Path, table: SweepTable, overwrite: bool) -> int:
    """Keep the paths of a study that its file has, and return how many these are.

    Raises ValueError when the study's results would replace something else.
    """
    if key_of(file) is None:
        if file.exists():
            free = "free of files of other kinds"
            raise ValueError(f"Input output must be {free}; got {file.parent}, whose {file.name} is no sweep")
        return 0
    kept, lost = table.keep(finished_paths(study, file))
    if not overwrite and (lost or not kept):
        others, what = " and ".join(differences(study, file)), "replaces it"
        if kept:
            others += f", {lost} of which are not in this study"
            what = f"drops these and keeps the other {kept} paths"
        wrong = f"whose {file.name} is of other {others}: --overwrite {what}"
        raise ValueError(f"Input output must be free of other results; got {file.parent}, {wrong}")
    return kept


def _compute(engine: Engine, table: SweepTable, tell: ProgressCallback, scheduler: str | None) -> None:
    """Compute the paths that the table lacks."""
    table.commit()
    chunks = engine.chunks(table.missing())
    done = engine.paths - sum(map(len, chunks))
    if done:
        tell(done, engine.paths)
    finished = engine.records_of(chunks) if scheduler is None else records_on(scheduler, engine, chunks)
    with closing(finished):
        for numbers, records in finished:
            table.add(numbers, records)
            done += len(records)
            tell(done, engine.paths)


def figures(sweep: Sweep) -> dict[str, Any]:
    """The figures of a sweep by name."""
    return {
        "paths": len(sweep.study.points),
        "kept": sweep.kept,
        "dimensions": sweep.study.points.dimensions,
        "outcomes": sweep.outcomes,
        "first_refused": sweep.first_refused,
        "warnings": sweep.warnings,
        "largest_distance": _largest(sweep),
        "files": [str(file) for file in sweep.files],
    }


def lines(sweep: Sweep) -> list[tuple[str, str]]:
    """Rows (label, text) to print."""
    sizes = sweep.study.points.dimensions
    plural = {"point": "points", "repeat": "repeats"}
    shape = " x ".join(f"{count} {plural.get(name, name)}" for name, count in sizes.items())
    rows = [
        ("paths", f"{len(sweep.study.points)}: {shape}"),
        *([("kept", _kept(sweep))] if sweep.kept else []),
        ("outcomes", ", ".join(f"{count} {name}{AT_END.get(name, '')}" for name, count in sweep.outcomes.items())),
    ]
    if (largest := _largest(sweep)) is not None:
        rows.append(("distance", f"{largest * 1e6:.4f} um at most"))
    if wrong := sweep.first_refused:
        rows.append(("refused", f"{_refused(sweep)}: {'; '.join(wrong)}"))
    return rows + [("wrote", str(file)) for file in sweep.files]


def _refused(sweep: Sweep) -> str:
    """How many paths were refused, and which is the first."""
    points, refused = sweep.study.points, sweep.refused
    (values,) = points.values(refused[:1])
    texts = [
        f"{value:.6g}" if axis.kind is np.float64 else str(value)
        for axis, value in zip(points.axes, values, strict=True)
    ]
    at = [f"{axis.name} = {counted(text, axis.field.unit)}" for axis, text in zip(points.axes, texts, strict=True)]
    first = "at" if len(refused) == 1 else "the first at"
    return f"{len(refused)} of {len(points)} paths, {first} {', '.join(at)}"


def _kept(sweep: Sweep) -> str:
    """How many paths an earlier sweep left, and how many are new."""
    new = len(sweep.study.points) - sweep.kept
    return f"{sweep.kept} of these paths from an earlier sweep; {new or 'none'} {'is' if new == 1 else 'are'} new"


def _largest(sweep: Sweep) -> float | None:
    """The largest distance [m] that a part went; None: there was no path."""
    distances = sweep.dataset["distance"].values
    return None if np.isnan(distances).all() else float(np.nanmax(distances))
