"""One sweep, from study to results: this file reads as the pipeline.

study -> paths kept of an earlier sweep -> chunks of the others -> their records -> chunks on disk -> check of the model
-> one file of all -> picture
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Iterator
from contextlib import closing
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from active_surface.arrays import IntArray
from active_surface.studies.chunk_store import ChunkStore
from active_surface.studies.cluster import records_on
from active_surface.studies.dataset import read_dataset, renew_labels, write_dataset
from active_surface.studies.engine import Engine
from active_surface.studies.growth import Kept, kept_paths
from active_surface.studies.lock import alone_in
from active_surface.studies.pictures import draw_sweep
from active_surface.studies.record import KIND, OUTCOMES, Records
from active_surface.studies.stored import differences, key_of
from active_surface.studies.study import Study
from active_surface.studies.validity import model_warnings
from coupling import ProgressCallback, no_progress

if TYPE_CHECKING:
    import xarray

ENDING = ".nc"
AT_ONCE = 65536  # paths whose records are written together


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

    Chunks of finished paths are kept in NAME.sweep of the output folder until all are done; an interrupted sweep
    resumes from them. If NAME.nc holds the same numbers, no path is computed again; other labels rewrite the file. If
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
            file, _ = _results_file(study, Path(folder), threads, tell, scheduler, False)
            with read_dataset(file) as dataset:
                return Sweep(study, dataset.load())
    file, kept = _results_file(study, Path(output), threads, tell, scheduler, overwrite)
    dataset = read_dataset(file)
    picture = draw_sweep(study, dataset, file.with_suffix(".sweep.png"))
    return Sweep(study, dataset, (file, picture), kept)


def _kept(study: Study, file: Path, overwrite: bool) -> Kept:
    """The paths of a study that its file has; raises ValueError when its results would replace something else."""
    known = key_of(file)
    if file.exists() and known is None:
        free = "free of files of other kinds"
        raise ValueError(f"Input output must be {free}; got {file.parent}, whose {file.name} is no sweep")
    kept = kept_paths(study, file)
    if known is None or overwrite or (kept.whole and not kept.lost):
        return kept
    others = " and ".join(differences(study, file))
    what = "replaces it"
    if len(kept.numbers):
        others += f", {kept.lost} of which are not in this study"
        what = f"drops these and keeps the other {len(kept.numbers)} paths"
    wrong = f"whose {file.name} is of other {others}: --overwrite {what}"
    raise ValueError(f"Input output must be free of other results; got {file.parent}, {wrong}")


def _files(study: Study, folder: Path) -> tuple[Path, Path]:
    """The file of all results in a folder, and the folder of chunks."""
    return folder / f"{study.name}{ENDING}", folder / f"{study.name}.sweep"


def _results_file(
    study: Study, folder: Path, threads: int | None, tell: ProgressCallback, scheduler: str | None, overwrite: bool
) -> tuple[Path, int]:
    """Compute what is missing in a folder; returns the file of all results there, and how many paths it had before."""
    (file, chunks), key = _files(study, folder), study.key
    if chunks.exists() and not chunks.is_dir():
        free = "free of files of other kinds"
        raise ValueError(f"Input output must be {free}; got {folder}, whose {chunks.name} is no folder")
    store = ChunkStore(chunks / key[:16], key)
    with alone_in(chunks):
        if key_of(file) == key:
            renew_labels(study, file)
            kept = len(study.points)
        else:
            found = _kept(study, file, overwrite)
            kept = len(found.numbers)
            engine = Engine(study, threads)
            _compute(engine, found, store, tell, scheduler)
            pieces = chain(found.records(file), store.load())
            write_dataset(study, _in_order(len(study.points), pieces, store), file, model_warnings(engine))
        store.clear()
    return file, kept


def _compute(engine: Engine, kept: Kept, store: ChunkStore, tell: ProgressCallback, scheduler: str | None) -> None:
    """Compute the paths that are neither kept nor in the store."""
    missing = np.ones(engine.paths, dtype=bool)
    missing[kept.numbers] = False
    for numbers, _ in store.load():
        missing[numbers] = False
    chunks = engine.chunks(np.flatnonzero(missing))
    done = engine.paths - sum(map(len, chunks))
    if done:
        tell(done, engine.paths)
    finished = engine.records_of(chunks) if scheduler is None else records_on(scheduler, engine, chunks)
    with closing(finished):
        for numbers, records in finished:
            store.save(numbers, records)
            done += len(records)
            tell(done, engine.paths)


def _in_order(
    paths: int, pieces: Iterable[tuple[IntArray, Records]], store: ChunkStore
) -> Iterator[tuple[int, Records]]:
    """Yield lots of records in the order of their paths: the number of the first path of each lot, and its records.

    They are put in order in a file, so that memory does not grow with them.
    """
    store.folder.mkdir(parents=True, exist_ok=True)
    missing = np.ones(paths, dtype=bool)
    with tempfile.TemporaryFile(dir=store.folder) as scratch:
        for numbers, records in pieces:
            missing[numbers] = False
            cuts = np.flatnonzero(np.diff(numbers) != 1) + 1
            for first, run in zip(np.append(numbers[:1], numbers[cuts]).tolist(), np.split(records, cuts), strict=True):
                scratch.seek(first * KIND.itemsize)
                scratch.write(run.tobytes())
        if missing.any():
            gone = f"{missing.sum()} paths from {missing.argmax()} on are gone"
            raise OSError(f"{store.folder}: {gone}; the same command computes them again")
        scratch.seek(0)
        for first in range(0, paths, AT_ONCE):
            content = scratch.read(min(AT_ONCE, paths - first) * KIND.itemsize)
            yield first, np.frombuffer(content, KIND)
