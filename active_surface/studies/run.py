"""One sweep, from study to results: this file reads as the pipeline.

study -> chunks of points -> records of their paths -> chunks on disk -> check of the model -> one file of all
-> picture
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from active_surface.studies.chunk_store import ChunkStore
from active_surface.studies.cluster import records_on
from active_surface.studies.dataset import differences, key_of, read_dataset, renew_labels, write_dataset
from active_surface.studies.engine import Engine
from active_surface.studies.lock import alone_in
from active_surface.studies.pictures import draw_sweep
from active_surface.studies.record import OUTCOMES, Records
from active_surface.studies.study import Study
from active_surface.studies.validity import model_warnings
from coupling import ProgressCallback, no_progress

if TYPE_CHECKING:
    import xarray

ENDING = ".nc"
AT_ONCE = 65536  # paths whose records are written together, at least


@dataclass(frozen=True, eq=False)
class Sweep:
    """The results of a sweep; `files` are those it wrote.

    With files, `dataset` reads from the first of them on demand, until `dataset.close()`.
    """

    study: Study
    dataset: xarray.Dataset = field(repr=False)
    files: tuple[Path, ...] = ()

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
    def first_refused(self) -> list[str]:
        """What is wrong with the first refused point; empty: there is none."""
        refused = np.flatnonzero(self.dataset["mistakes"].values.ravel())
        return Engine(self.study).faults(int(refused[0])) if len(refused) else []


def run_study(
    study: Study,
    output: str | Path | None = None,
    threads: int | None = None,
    tell: ProgressCallback = no_progress,
    scheduler: str | None = None,
    overwrite: bool = False,
) -> Sweep:
    """Follow all paths of a study.

    Chunks of finished paths are kept in NAME.sweep of the output folder until all are done; an interrupted sweep
    resumes from them. If NAME.nc holds the same numbers, no path is computed again; other labels rewrite the file.

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
        Replace the results of another study, or of other versions, in NAME.nc.

    Returns
    -------
    sweep : Sweep
        The labelled results.

    Raises
    ------
    ValueError
        NAME.nc or NAME.sweep holds something else.
    RuntimeError
        Another process sweeps in the folder by that name.
    OSError
        The disk is full.
    KeyboardInterrupt
        Ctrl-C.
    """
    if output is None:
        with tempfile.TemporaryDirectory() as folder:
            file = _results_file(study, Path(folder), threads, tell, scheduler)
            with read_dataset(file) as dataset:
                return Sweep(study, dataset.load())
    _check_output(study, Path(output), overwrite)
    file = _results_file(study, Path(output), threads, tell, scheduler)
    dataset = read_dataset(file)
    picture = draw_sweep(study, dataset, file.with_suffix(".sweep.png"))
    return Sweep(study, dataset, (file, picture))


def _check_output(study: Study, folder: Path, overwrite: bool) -> None:
    """Raises ValueError when the results would replace something else."""
    file, chunks = _files(study, folder)
    known = key_of(file)
    if file.exists() and known is None:
        wrong = f"free of files of other kinds; got {folder}, whose {file.name} is no sweep"
    elif known is not None and known != study.key and not overwrite:
        others = " and ".join(differences(study, file))
        wrong = f"free of other results; got {folder}, whose {file.name} is of other {others}: --overwrite replaces it"
    elif chunks.exists() and not chunks.is_dir():
        wrong = f"free of files of other kinds; got {folder}, whose {chunks.name} is no folder"
    else:
        return
    raise ValueError(f"Input output must be {wrong}")


def _files(study: Study, folder: Path) -> tuple[Path, Path]:
    """The file of all results in a folder, and the folder of chunks."""
    return folder / f"{study.name}{ENDING}", folder / f"{study.name}.sweep"


def _results_file(
    study: Study, folder: Path, threads: int | None, tell: ProgressCallback, scheduler: str | None
) -> Path:
    """Compute what is missing in a folder; returns the file of all results there."""
    (file, chunks), key = _files(study, folder), study.key
    store = ChunkStore(chunks / key[:16], key)
    with alone_in(chunks):
        if key_of(file) != key:
            engine = Engine(study, threads)
            _compute(engine, store, tell, scheduler)
            write_dataset(study, _chunks(engine, store), file, model_warnings(study))
        else:
            renew_labels(study, file)
        store.clear()
    return file


def _compute(engine: Engine, store: ChunkStore, tell: ProgressCallback, scheduler: str | None) -> None:
    """Compute the chunks that the store does not have yet."""
    missing = [chunk for chunk in range(engine.chunks) if store.load(*engine.span(chunk)) is None]
    done = engine.paths - sum(stop - start for start, stop in map(engine.span, missing))
    if done:
        tell(done, engine.paths)
    finished = engine.records_of(missing) if scheduler is None else records_on(scheduler, engine, missing)
    with closing(finished):
        for chunk, records in finished:
            store.save(engine.span(chunk)[0], records)
            done += len(records)
            tell(done, engine.paths)


def _chunks(engine: Engine, store: ChunkStore) -> Iterator[tuple[int, Records]]:
    """Yield lots of chunks: the number of the first path of each lot, and its records."""
    first, lot = 0, []
    for chunk in range(engine.chunks):
        start, stop = engine.span(chunk)
        records = store.load(start, stop)
        if records is None:
            raise OSError(f"{store.folder}: paths {start} to {stop - 1} are gone; the same command computes them again")
        lot.append(records)
        if stop - first >= AT_ONCE or stop == engine.paths:
            yield first, np.concatenate(lot)
            first, lot = stop, []
