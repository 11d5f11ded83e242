"""Progress: stages with a clock, or a count with its rate, shown only once the work has taken two seconds."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any

Tell = Callable[[int, int], object]  # gets how many of the stage's pieces are done, and of how many
Progress = Callable[[str], AbstractContextManager[Tell]]

PATIENCE = 2.0  # s of silence


def untold(done: int, of: int) -> None:
    """No count."""


def silent(stage: str) -> AbstractContextManager[Tell]:
    """No progress."""
    return nullcontext(untold)


class _Bar:
    """A bar on the terminal's error stream after a while of silence; nothing where that cannot show one."""

    def __init__(self, *columns: Any, total: int | None = None) -> None:
        from rich.console import Console
        from rich.progress import Progress as Bar

        console = Console(stderr=True)
        self._bar = Bar(
            *columns, console=console, transient=True, disable=not console.is_terminal or console.is_dumb_terminal
        )
        self._task = self._bar.add_task("", total=total)
        self._timer = threading.Timer(PATIENCE, self._bar.start)
        self._timer.daemon = True

    def _start(self) -> None:
        self._timer.start()

    def __exit__(self, *_: object) -> None:
        self._timer.cancel()
        self._timer.join()
        self._bar.stop()


class StageBar(_Bar):
    """A bar over known stages."""

    def __init__(self, stages: int) -> None:
        from rich.progress import BarColumn, MofNCompleteColumn, SpinnerColumn, TextColumn, TimeElapsedColumn

        columns = (BarColumn(bar_width=20), MofNCompleteColumn(), TimeElapsedColumn())
        super().__init__(SpinnerColumn(), *columns, TextColumn("{task.description}"), total=stages)

    def __enter__(self) -> StageBar:
        self._start()
        return self

    @contextmanager
    def __call__(self, stage: str) -> Iterator[Tell]:
        self._bar.update(self._task, description=stage)
        yield lambda done, of: self._bar.update(self._task, description=f"{stage}: {done} of {of}")
        self._bar.advance(self._task)


class CountBar(_Bar):
    """A bar over many pieces of one kind, with how many are done a second and the time left.

    Those of the first count were done before.
    """

    def __init__(self, pieces: str) -> None:
        from rich.progress import BarColumn, MofNCompleteColumn, SpinnerColumn, TextColumn, TimeRemainingColumn

        self._pieces, self._begun = pieces, False
        columns = (BarColumn(bar_width=30), MofNCompleteColumn(), TextColumn("{task.description}"))
        super().__init__(SpinnerColumn(), *columns, TimeRemainingColumn(), TextColumn("left"))

    def __enter__(self) -> Tell:
        self._start()
        return self._tell

    def _tell(self, done: int, of: int) -> None:
        if not self._begun:
            self._bar.reset(self._task, completed=done, total=of)
            self._begun = True
        speed = self._bar.tasks[0].speed
        rate = f"{self._pieces}, {speed:.0f}/s" if speed else self._pieces
        said = f"{self._pieces}; writing all" if done == of else rate
        self._bar.update(self._task, completed=done, description=said)
