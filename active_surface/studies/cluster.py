"""Cluster: the chunks of a study, computed by the workers of a dask scheduler.

A worker computes one chunk at a time, on all of its threads, and solves each plate itself.
"""

from __future__ import annotations

import asyncio
import pickle
import threading
from collections.abc import Generator, Iterable, Iterator, Mapping
from concurrent.futures import CancelledError
from contextlib import contextmanager
from functools import lru_cache
from itertools import islice
from typing import TYPE_CHECKING, Final

from active_surface.arrays import IntArray
from active_surface.studies.columns import Records
from active_surface.studies.engine import Engine
from active_surface.studies.study import versions
from particle import interruptible

if TYPE_CHECKING:
    from distributed import Client, Future

PATIENCE: Final = 5  # s to wait for a scheduler's answer
ARRIVAL: Final = 30  # s to wait for the first worker
AHEAD: Final = 2  # chunks handed out for each thread of the workers

_ONE_AT_A_TIME = threading.Lock()


def records_on(
    scheduler: str, engine: Engine, chunks: Iterable[IntArray]
) -> Generator[tuple[IntArray, Records], None, None]:
    """Yield chunks of an engine's study and their records as they come in from the workers of a scheduler.

    scheduler: its address.
    When a worker dies, another one takes over its chunk. Only a few chunks at a time are under way.
    Raises ValueError when there is no scheduler at the address, or when a worker has other versions or files than this
    process; RuntimeError when dask is not installed, no worker comes, or scheduler or workers are lost.
    """
    with _connected(scheduler) as client:
        from distributed import as_completed

        study, left = (pickle.dumps(engine.study), engine.study.key, versions()), iter(chunks)
        numbers: dict[Future, IntArray] = {}
        running = as_completed([], loop=client.loop)

        def hand_out() -> None:
            threads = sum(client.nthreads().values())
            for chunk in islice(left, max(AHEAD * max(threads, 1) - len(numbers), 0)):
                future = client.submit(_records_on_worker, *study, chunk, pure=False)
                numbers[future] = chunk
                running.add(future)

        hand_out()
        for future in running:
            records = future.result()
            chunk = numbers.pop(future)
            hand_out()
            yield chunk, records


@contextmanager
def _connected(scheduler: str) -> Iterator[Client]:
    """A client of a scheduler that has workers; its failures become errors of one line."""
    try:
        from distributed import Client, KilledWorker
    except ImportError:
        how = "pip install 'active-surface[cluster]'"
        raise RuntimeError(f"Input scheduler needs dask, which is not installed; it comes with {how}") from None
    try:  # before there is a client, which would wait for what does not answer
        kind = interruptible(asyncio.run, _kind_of(scheduler))
        wrong = "" if kind == "Scheduler" else f"there is a dask {kind.lower()} at that address"
    except OSError:
        wrong = f"no dask scheduler answered there in {PATIENCE} s"
    except (ValueError, TypeError) as error:
        wrong = str(error)
    if wrong:
        expected = "the address of a running dask scheduler such as tcp://127.0.0.1:8786"
        raise ValueError(f"Input scheduler must be {expected}; got {scheduler!r}: {wrong}")
    with Client(scheduler, timeout=PATIENCE, set_as_default=False) as client:
        try:
            client.wait_for_workers(1, timeout=ARRIVAL)
        except TimeoutError:
            message = f"Input scheduler must have workers; the one at {scheduler} got none in {ARRIVAL} s"
            raise RuntimeError(f"{message}; dask worker {scheduler} starts one") from None
        try:
            yield client
        except KilledWorker as error:
            died = error.allowed_failures + 1
            raise RuntimeError(f"{died} workers died one after the other, each with the same chunk of paths") from None
        except ModuleNotFoundError as error:
            raise RuntimeError(f"a worker lacks active-surface or what it needs: {error}") from None
        except CancelledError:
            raise RuntimeError(f"the scheduler at {scheduler} is gone; the same command goes on with another") from None


async def _kind_of(address: str) -> str:
    """The kind of dask process at an address."""
    from distributed import Security
    from distributed.core import rpc

    arguments = Security().get_connection_args("client")
    async with rpc(address, timeout=PATIENCE, connection_args=arguments) as there:
        return str((await asyncio.wait_for(there.identity(), PATIENCE))["type"])


def _records_on_worker(pickled: bytes, key: str, ours: Mapping[str, str], numbers: IntArray) -> Records:
    """The records of paths of these numbers, computed by the worker that runs this.

    pickled: the study.  key: its key, and ours: the versions, where the command runs.
    """
    from distributed import get_worker

    worker, theirs = get_worker(), versions()
    here = f"the worker at {worker.address} must have"
    if others := [f"{name} {theirs[name]} in place of {ours[name]}" for name in ours if theirs[name] != ours[name]]:
        raise ValueError(f"{here} the same versions as the command; it has {', '.join(others)}")
    with _ONE_AT_A_TIME:
        engine = _engine(pickled, key, worker.state.nthreads)
        if engine is None:
            raise ValueError(f"{here} the same files as the command; those that the case names differ there")
        return engine.records(numbers)


@lru_cache(maxsize=1)
def _engine(pickled: bytes, key: str, threads: int) -> Engine | None:
    """The engine of a study; None: the study has another key here."""
    study = pickle.loads(pickled)
    return Engine(study, threads) if study.key == key else None
