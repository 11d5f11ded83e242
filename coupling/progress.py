"""Progress: stages with a clock, or a count with its rate, on a terminal once the work has taken two seconds.

Where there is no terminal only the compilation of kernels is announced, on one line.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext
from typing import Any

ProgressCallback = Callable[[int, int], object]  # gets how many of the stage's pieces are done, and of how many
Progress = Callable[[str], AbstractContextManager[ProgressCallback]]

_open_bars: list[_Bar] = []

PATIENCE = 2.0  # s of silence
PARTS = 100  # of what is done before pieces are counted
COMPILING = "Compiling what this case needs for the first time (once, up to some minutes)"


def no_progress(done: int, of: int) -> None:
    """No count."""


def silent(stage: str) -> AbstractContextManager[ProgressCallback]:
    """No progress."""
    return nullcontext(no_progress)


def doing(text: str, share: float) -> None:
    """Say on the bars that are open what is being done, and how much of it is, at a point that knows none of them."""
    for bar in list(_open_bars):
        bar.show(text, share)


class _Bar:
    """A bar on the terminal's error stream after a while of silence; none elsewhere."""

    def __init__(self, total: int | None = None) -> None:
        self._bar = _bar(self._columns()) if sys.stderr and sys.stderr.isatty() else None
        self._task = self._bar.add_task("", total=total) if self._bar else None
        self._announcing = ExitStack()

    def _columns(self) -> list[Any]:
        raise NotImplementedError

    def _start(self) -> None:
        from particle import compilation_heard

        self._announcing.enter_context(compilation_heard(self._announce))
        if self._bar:
            self._timer = threading.Timer(PATIENCE, self._bar.start)
            self._timer.daemon = True
            self._timer.start()
        _open_bars.append(self)

    def show(self, text: str, share: float) -> None:
        """Show what is being done."""
        if self._bar:
            self._bar.update(self._task, description=text)

    def _announce(self) -> None:
        if self._bar:
            self._bar.console.print(COMPILING, highlight=False)
        elif sys.stderr:
            print(COMPILING, file=sys.stderr, flush=True)

    def __exit__(self, *_: object) -> None:
        _open_bars.remove(self)
        self._announcing.close()
        if self._bar:
            self._timer.cancel()
            self._timer.join()
            self._bar.stop()


def _bar(columns: list[Any]) -> Any:
    """A bar of rich, which is slow to load; None where the terminal is too dumb for one."""
    from rich.console import Console
    from rich.progress import Progress as Bar

    console = Console(stderr=True)
    return None if console.is_dumb_terminal else Bar(*columns, console=console, transient=True)


class StageBar(_Bar):
    """A bar over known stages."""

    def __init__(self, stages: int) -> None:
        super().__init__(stages)

    def _columns(self) -> list[Any]:
        from rich.progress import BarColumn, MofNCompleteColumn, SpinnerColumn, TextColumn, TimeElapsedColumn

        columns = [BarColumn(bar_width=20), MofNCompleteColumn(), TimeElapsedColumn()]
        return [SpinnerColumn(), *columns, TextColumn("{task.description}")]

    def __enter__(self) -> Progress:
        self._start()
        return self._stage

    @contextmanager
    def _stage(self, stage: str) -> Iterator[ProgressCallback]:
        if not self._bar:
            yield no_progress
            return
        bar, task = self._bar, self._task
        bar.update(task, description=stage)
        yield lambda done, of: bar.update(task, description=f"{stage}: {done} of {of}")
        bar.advance(task)


class CountBar(_Bar):
    """A bar over many pieces of one kind, with how many are done a second and the time left.

    Those of the first count were done before.
    """

    def __init__(self, pieces: str) -> None:
        self._pieces, self._begun = pieces, False
        super().__init__()

    def _columns(self) -> list[Any]:
        from rich.progress import BarColumn, MofNCompleteColumn, SpinnerColumn, TextColumn, TimeRemainingColumn

        columns = [BarColumn(bar_width=30), MofNCompleteColumn(), TextColumn("{task.description}")]
        return [SpinnerColumn(), *columns, TimeRemainingColumn(), TextColumn("left")]

    def __enter__(self) -> ProgressCallback:
        self._start()
        return self._tell if self._bar else no_progress

    def show(self, text: str, share: float) -> None:
        """Show what is being done; before the first count also how much of it."""
        if self._bar:
            done = {} if self._begun else {"completed": round(PARTS * share), "total": PARTS}
            self._bar.update(self._task, description=text, **done)

    def _tell(self, done: int, of: int) -> None:
        assert self._bar
        if not self._begun:
            self._bar.reset(self._task, completed=done, total=of)
            self._begun = True
        speed = self._bar.tasks[0].speed
        rate = f"{self._pieces}, {speed:.0f}/s" if speed else self._pieces
        text = f"{self._pieces}; writing all" if done == of else rate
        self._bar.update(self._task, completed=done, description=text)
