"""Progress: stages with a clock, shown only once the work has taken two seconds."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import TypeVar

Tell = Callable[[int, int], object]  # gets how many of the stage's pieces are done, and of how many
Progress = Callable[[str], AbstractContextManager[Tell]]

Answer = TypeVar("Answer")

PATIENCE = 2.0  # s of silence


def untold(done: int, of: int) -> None:
    """No count."""


def silent(stage: str) -> AbstractContextManager[Tell]:
    """No progress."""
    return nullcontext(untold)


def interruptible(work: Callable[..., Answer], *arguments: object) -> Answer:
    """work(*arguments) on another thread, so that Ctrl-C ends the wait for it.

    A signal that arrives inside a compiled kernel would otherwise be handled when the kernel returns, if at all.
    """
    done: list[Answer] = []
    failed: list[BaseException] = []

    def run() -> None:
        try:
            done.append(work(*arguments))
        except BaseException as error:  # handed to the caller below
            failed.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    while thread.is_alive():
        thread.join(0.1)
    if failed:
        raise failed[0]
    return done[0]


class StageBar:
    """A bar over known stages on the terminal's error stream; nothing where that is not a terminal."""

    def __init__(self, stages: int) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, SpinnerColumn, TextColumn, TimeElapsedColumn
        from rich.progress import Progress as Bar

        console = Console(stderr=True)
        self._bar = Bar(
            SpinnerColumn(),
            BarColumn(bar_width=20),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TextColumn("{task.description}"),
            console=console,
            transient=True,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task("", total=stages)
        self._timer = threading.Timer(PATIENCE, self._bar.start)
        self._timer.daemon = True

    def __enter__(self) -> StageBar:
        self._timer.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._timer.cancel()
        self._timer.join()
        self._bar.stop()

    @contextmanager
    def __call__(self, stage: str) -> Iterator[Tell]:
        self._bar.update(self._task, description=stage)
        yield lambda done, of: self._bar.update(self._task, description=f"{stage}: {done} of {of}")
        self._bar.advance(self._task)
