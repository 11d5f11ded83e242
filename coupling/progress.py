"""Progress: stages, or many pieces of one stage, on a terminal once the work has taken two seconds.

Where there is no terminal, as in a log, a line after ten seconds and then twice a minute says what is done and left.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext, suppress
from datetime import timedelta
from typing import Any

ProgressCallback = Callable[[int, int], object]  # gets how many of the stage's pieces are done, and of how many
Progress = Callable[[str], AbstractContextManager[ProgressCallback]]

_open_bars: list[Bar] = []
_now = time.monotonic  # s

PATIENCE = 2.0  # s of silence on a terminal
PERIOD = 30.0  # s between lines elsewhere
FIRST = 10.0  # s before the first of them, at most
COMPILING = "Compiling what this case needs for the first time (only once; it may take a few minutes)"


def no_progress(done: int, of: int) -> None:
    """No count."""


def silent(stage: str) -> AbstractContextManager[ProgressCallback]:
    """No progress."""
    return nullcontext(no_progress)


def doing(text: str, share: float = 0.0) -> None:
    """Show on the open bars what is being done, and how much of it is, at a point that knows none of them."""
    for bar in list(_open_bars):
        bar.show(text, share)


class Bar:
    """A bar on the terminal's error stream after a while of silence; elsewhere a line there now and then.

    stages: how many there are; none: there is one, named by its pieces, whose count it shows with a rate and the time
    left. Pieces of the first count were done before.
    """

    def __init__(self, stages: int | None = None) -> None:
        from rich import progress as rich
        from rich.console import Console

        console = Console(stderr=True)
        self._live = bool(sys.stderr) and sys.stderr.isatty() and not console.is_dumb_terminal
        clock = [rich.TimeElapsedColumn()] if stages else [rich.TimeRemainingColumn(), "left"]
        columns = [rich.SpinnerColumn(), rich.BarColumn(bar_width=20), rich.MofNCompleteColumn(), *clock]
        self._bar: Any = rich.Progress(*columns, "{task.description}", console=console, transient=True)
        self._id = self._bar.add_task("", total=stages)
        self._stages, self._stage = stages, ""
        self._first: tuple[int, float] | None = None  # how many pieces were done before, and when [s] counting began
        self._ending, self._ended = ExitStack(), threading.Event()

    @property
    def task(self) -> Any:
        """What is done, and of how much."""
        return self._bar.tasks[0]

    def show(self, text: str, share: float = 0.0) -> None:
        """Show what is being done, and how much of it is."""
        self._bar.update(self._id, description=f"{text}, {100 * share:.0f} %" if share else text)

    def __enter__(self) -> Progress:
        from particle import compilation_heard

        self._ending.enter_context(compilation_heard(self._announce))
        self._since = _now()
        self._teller = threading.Thread(target=self._show_bar if self._live else self._write_lines, daemon=True)
        self._teller.start()
        _open_bars.append(self)
        return self.stage

    def __exit__(self, *_: object) -> None:
        _open_bars.remove(self)
        self._ending.close()
        self._ended.set()
        self._teller.join()
        if self._live:
            self._bar.stop()

    @contextmanager
    def stage(self, name: str) -> Iterator[ProgressCallback]:
        """A stage, or the only one, by the name of its pieces; gives what counts these."""
        self._stage, self._first = name, None
        if self._stages:
            self.show(name)
        yield self._count
        if self._stages:
            self._bar.advance(self._id)

    def _count(self, done: int, of: int) -> None:
        first, self._first = self._first, self._first or (done, _now())
        if self._stages:
            self.show(f"{self._stage}: {done} of {of}")
            return
        if first is None:
            self._bar.reset(self._id, completed=done, total=of)
        rate = f", {self.task.speed:.0f}/s" if self._live and self.task.speed else ""
        self._bar.update(self._id, completed=done, total=of)
        self.show(f"{self._stage}; writing all" if done == of else self._stage + rate)

    def _line(self) -> str:
        """What is done and what is left."""
        task = self.task
        if self._stages:
            line = f"{task.completed} of {task.total} stages done; {task.description}"
            return line if self._first else line + _path_under_way()
        if self._first is None:
            return f"no {self._stage} yet" + (f"; {task.description}" if task.description else "")
        (before, since), done = self._first, task.completed
        line = f"{done} of {task.total} {task.description}"
        if not (before < done < task.total and _now() > since):
            return line
        rate = (done - before) / (_now() - since)
        return f"{line}, {rate:{'.0f' if rate >= 10 else '.2g'}}/s, about {_clock((task.total - done) / rate)} left"

    def _show_bar(self) -> None:
        if not self._ended.wait(PATIENCE):
            self._bar.start()

    def _write_lines(self) -> None:
        with suppress(OSError, ValueError):  # of a stream that nobody reads any more
            wait = min(FIRST, PERIOD)
            while not self._ended.wait(wait) and sys.stderr:
                wait = PERIOD
                print(f"{_clock(_now() - self._since)}  {self._line()}", file=sys.stderr, flush=True)

    def _announce(self) -> None:
        if self._live:
            self._bar.console.print(COMPILING, highlight=False)
        elif sys.stderr:
            print(COMPILING, file=sys.stderr, flush=True)


def _path_under_way() -> str:
    """How far the integrator is on a path, if it follows one."""
    from common import range_text
    from particle import under_way

    path = under_way()
    return "" if path is None else f"; path at {range_text(*path, 's', word='of')}"


def _clock(seconds: float) -> str:
    return str(timedelta(seconds=round(seconds)))
