"""Interrupt: Ctrl-C, heard for sure or held back, and work on one thread that another breaks off."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any, Final, TypeVar

if TYPE_CHECKING:  # every command loads this module, and not all of them numpy
    from numpy.typing import NDArray

Answer = TypeVar("Answer")

AWAKE: Final = 0.1  # s between looks
_held_back: list[object] = []  # a note of each `unbroken` block that is running


class Stopped(Exception):
    """Another thread has broken off what a block of `stoppable` does."""


class _Flag(threading.local):
    """What another thread may set to 1, so that the kernels of this one end within a step."""

    value: NDArray[Any] | None = None


_flag = _Flag()


@contextmanager
def stoppable(flag: NDArray[Any]) -> Iterator[None]:
    """Has `simulate` raise Stopped in its block, on this thread, once another one sets `flag` (1,) to 1."""
    before, _flag.value = _flag.value, flag
    try:
        yield
    finally:
        _flag.value = before


def stop_flag() -> NDArray[Any] | None:
    """The flag of this thread; None: nobody may stop it."""
    return _flag.value


def wait(ended: Callable[[float], bool]) -> None:
    """Wait until `ended`, which itself waits for so many seconds, is true; KeyboardInterrupt upon Ctrl-C.

    An exception that a signal raises is lost where Python cannot pass it on, as in a finaliser that happens to run
    then. So Ctrl-C only leaves a note here, and the loop looks for it. Where somebody else handles the signal, or this
    is not the main thread, it is left to them.
    """
    noted = threading.Event()
    with _handled(lambda *_: noted.set(), signal.default_int_handler):
        while not noted.is_set() and not ended(AWAKE):
            pass
    if noted.is_set():
        raise KeyboardInterrupt


def interruptible(work: Callable[..., Answer], *arguments: object) -> Answer:
    """work(*arguments) on another thread, so that Ctrl-C ends the wait for it."""
    return side_by_side(partial(work, *arguments))[0]


def side_by_side(*tasks: Callable[[], Answer]) -> list[Answer]:
    """What the tasks give, in their order, each found on a thread of its own; Ctrl-C ends the wait.

    Once all have ended, raises the error of the first in that order which failed. A signal that arrives inside a
    compiled kernel, or while one is compiled, would otherwise be handled late or never. A thread that gets no signals
    does the work itself, task by task.
    """
    if threading.current_thread() is not threading.main_thread():
        return [task() for task in tasks]
    from concurrent import futures  # here, because it loads logging

    import numpy as np

    found: list[futures.Future[Answer]] = [futures.Future() for _ in tasks]
    stop = np.zeros(1, dtype=np.int64)

    def run(task: Callable[[], Answer], future: futures.Future[Answer]) -> None:
        try:
            with stoppable(stop):
                future.set_result(task())
        except BaseException as error:  # raised in the caller below
            future.set_exception(error)

    try:
        for pair in zip(tasks, found, strict=True):
            threading.Thread(target=run, args=pair, daemon=True).start()
        wait(lambda seconds: not futures.wait(found, seconds).not_done)
    except KeyboardInterrupt:
        stop[0] = 1  # or paths would go on where the process does, as in a notebook
        raise
    return [future.result() for future in found]


@contextmanager
def unbroken() -> Iterator[None]:
    """Holds Ctrl-C back during its block, so that results are not lost; it is raised after the block.

    Does nothing on a thread that gets none, and where none is heard anyway.
    """
    noted = threading.Event()
    _held_back.append(noted)
    try:
        # A handler, not SIG_IGN: Ctrl-C that is sent again because it was dropped does nothing while that is set.
        with _handled(lambda *_: noted.set()):
            yield
    finally:
        _held_back.remove(noted)
    if noted.is_set():
        signal.raise_signal(signal.SIGINT)


def is_held_back() -> bool:
    """Whether a block of `unbroken` is running."""
    return bool(_held_back)


@contextmanager
def _handled(handler: Callable[..., object], instead_of: object = None) -> Iterator[None]:
    """Has Ctrl-C handled so, on the main thread, in place of a given handler, or of any that Python can put back."""
    before = signal.getsignal(signal.SIGINT)
    ours = before is instead_of if instead_of else before not in (None, signal.SIG_IGN)
    if threading.current_thread() is not threading.main_thread() or not ours:
        yield
        return
    signal.signal(signal.SIGINT, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
