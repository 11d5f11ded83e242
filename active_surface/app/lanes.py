"""Lanes: the threads that work for the page, so that quick answers never wait for long ones."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Final, TypeVar

from active_surface.app.quick import QuickPaths
from coupling import SolvedPlates

Answer = TypeVar("Answer")

KEPT_PLATES: Final = 12


class Lanes:
    """What all tabs share: threads, plates that were solved, and quick paths over them."""

    def __init__(self) -> None:
        self.plates = SolvedPlates(keep=KEPT_PLATES)
        self.quick_paths = QuickPaths(self.plates)
        self.quick = ThreadPoolExecutor(1, "quick")
        self.full = ThreadPoolExecutor(2, "full")
        self.models = ThreadPoolExecutor(1, "models")

    async def run(self, lane: ThreadPoolExecutor, work: Callable[..., Answer], *arguments: object) -> Answer:
        """work(*arguments) on a lane."""
        return await asyncio.get_running_loop().run_in_executor(lane, work, *arguments)

    def close(self) -> None:
        """Take no more work."""
        for lane in (self.quick, self.full, self.models):
            lane.shutdown(wait=False, cancel_futures=True)
