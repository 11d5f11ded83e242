"""Progress: stages with a clock, or a count with its rate, on a terminal once the work has taken two seconds.

Where there is no terminal, as in a log, a line twice a minute says what is done and what is left.
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

_open_bars: list[_Bar] = []
_now = time.monotonic  # s

PATIENCE = 2.0  # s of silence on a terminal
PERIOD = 30.0  # s between lines elsewhere
COMPILING = "Compiling what this case needs for the first time (once, up to some minutes)"


def no_progress(done: int, of: int) -> None:
    """No count."""


def silent(stage: str) -> AbstractContextManager[ProgressCallback]:
    """No progress."""
    return nullcontext(no_progress)


def doing(text: str, share: float = 0.0) -> None:
    """Say on the bars that are open what is being done, and how much of it is, at a point that knows none of them."""
    for bar in list(_open_bars):
        bar.show(text, share)


class _Bar:
    """A bar on the terminal's error stream after a while of silence; elsewhere a line there now and then."""

    def __init__(self, total: int | None = None) -> None:
        from rich import progress as rich
        from rich.console import Console

        console = Console(stderr=True)
        self._live = bool(sys.stderr) and sys.stderr.isatty() and not console.is_dumb_terminal
        clock = [rich.TimeRemainingColumn(), "left"] if total is None else [rich.TimeElapsedColumn()]
        columns = [rich.SpinnerColumn(), rich.BarColumn(bar_width=20), rich.MofNCompleteColumn(), *clock]
        self._bar: Any = rich.Progress(*columns, "{task.description}", console=console, transient=True)
        self._id = self._bar.add_task("", total=total)
        self._announcing, self._ended = ExitStack(), threading.Event()

    @property
    def task(self) -> Any:
        """What is done, and of how much."""
        return self._bar.tasks[0]

    def show(self, text: str, share: float = 0.0) -> None:
        """Show what is being done, and how much of it is."""
        self._bar.update(self._id, description=f"{text}, {100 * share:.0f} %" if share else text)

    def _line(self) -> str:
        """What is done and what is left."""
        raise NotImplementedError

    def _start(self) -> None:
        from particle import compilation_heard

        self._announcing.enter_context(compilation_heard(self._announce))
        self._since = _now()
        self._teller = threading.Thread(target=self._show_bar if self._live else self._write_lines, daemon=True)
        self._teller.start()
        _open_bars.append(self)

    def _show_bar(self) -> None:
        if not self._ended.wait(PATIENCE):
            self._bar.start()

    def _write_lines(self) -> None:
        with suppress(OSError, ValueError):  # of a stream that nobody reads any more
            while not self._ended.wait(PERIOD) and sys.stderr:
                print(f"{_clock(_now() - self._since)}  {self._line()}", file=sys.stderr, flush=True)

    def _announce(self) -> None:
        if self._live:
            self._bar.console.print(COMPILING, highlight=False)
        elif sys.stderr:
            print(COMPILING, file=sys.stderr, flush=True)

    def __exit__(self, *_: object) -> None:
        _open_bars.remove(self)
        self._announcing.close()
        self._ended.set()
        self._teller.join()
        if self._live:
            self._bar.stop()


def _clock(seconds: float) -> str:
    return str(timedelta(seconds=round(seconds)))


class StageBar(_Bar):
    """A bar over known stages."""

    _counts = False  # whether the stage has said how much of it is done

    def __enter__(self) -> Progress:
        self._start()
        return self._stage

    @contextmanager
    def _stage(self, stage: str) -> Iterator[ProgressCallback]:
        self.show(stage)
        self._counts = False

        def tell(done: int, of: int) -> None:
            self._counts = True
            self.show(f"{stage}: {done} of {of}")

        yield tell
        self._bar.advance(self._id)

    def _line(self) -> str:
        from common import unit_for
        from particle import under_way

        path = under_way()
        line = f"{self.task.completed} of {self.task.total} stages done; {self.task.description}"
        if path is None or self._counts:
            return line
        unit = unit_for(path[1], "s")
        return f"{line}; path at {path[0] * unit.per_si:.3g} of {path[1] * unit.per_si:.3g} {unit.name}"


class CountBar(_Bar):
    """A bar over many pieces of one kind, with how many are done a second and the time left.

    Those of the first count were done before.
    """

    def __init__(self, pieces: str) -> None:
        super().__init__()
        self._pieces = pieces
        self._first: tuple[int, float] | None = None  # how many were done before, and when [s] counting began

    def __enter__(self) -> ProgressCallback:
        self._start()
        return self._tell

    def _tell(self, done: int, of: int) -> None:
        if self._first is None:
            self._bar.reset(self._id, completed=done, total=of)
            self._first = done, _now()
        rate = f"{self._pieces}, {self.task.speed:.0f}/s" if self.task.speed else self._pieces
        self._bar.update(self._id, completed=done)
        self.show(f"{self._pieces}; writing all" if done == of else rate)

    def _line(self) -> str:
        task = self.task
        if self._first is None:
            return f"no {self._pieces} yet" + (f"; {task.description}" if task.description else "")
        (before, since), done = self._first, task.completed
        line = f"{done} of {task.total} {task.description}"
        if not before < done < task.total:
            return line
        return f"{line}, about {_clock((task.total - done) * (_now() - since) / (done - before))} left"
