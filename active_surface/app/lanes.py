"""Lanes: the threads that work for the page, so that quick answers never wait for long ones."""

from __future__ import annotations

import asyncio
import ctypes
import gc
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Final, TypeVar

from active_surface.app.quick import QuickPaths
from coupling import SolvedPlates

Answer = TypeVar("Answer")

KEPT_PLATES: Final = 4
FULL: Final = 4  # threads of runs: one may take seconds to hear that nobody waits for it
ARENA_MAX, MMAP_THRESHOLD, LARGE = -8, -3, 1 << 18  # the numbers of settings in malloc.h, and bytes


class Lanes:
    """What all tabs share: threads, plates that were solved, and quick paths over them."""

    def __init__(self) -> None:
        _spare_memory()
        self.plates = SolvedPlates(keep=KEPT_PLATES)
        self.quick_paths = QuickPaths(self.plates)
        self.quick = ThreadPoolExecutor(1, "quick")
        self.full = ThreadPoolExecutor(FULL, "full")
        self.models = ThreadPoolExecutor(1, "models")
        self._closed = False

    async def run(self, lane: ThreadPoolExecutor, work: Callable[..., Answer], *arguments: object) -> Answer:
        """work(*arguments) on a lane; cancelled once that takes no more work."""
        if self._closed:
            raise asyncio.CancelledError
        return await asyncio.get_running_loop().run_in_executor(lane, work, *arguments)

    def close(self) -> None:
        """Take no more work."""
        self._closed = True
        for lane in (self.quick, self.full, self.models):
            lane.shutdown(wait=False, cancel_futures=True)


def tidy() -> None:
    """Give memory of plates and runs that are gone back to the system."""
    gc.collect()
    with suppress(OSError, AttributeError, TypeError):  # elsewhere than with glibc
        ctypes.CDLL(None).malloc_trim(0)


def _spare_memory() -> None:
    """Have glibc, which is made for short-lived programs, keep less: few pools, and large arrays by themselves."""
    with suppress(OSError, AttributeError, TypeError):  # elsewhere than with glibc
        for setting, value in ((ARENA_MAX, 2), (MMAP_THRESHOLD, LARGE)):
            ctypes.CDLL(None).mallopt(setting, value)
