"""Ctrl-C ends a command within seconds, whatever Python or compiled code is doing.

Most commands end by the KeyboardInterrupt that Python raises. Python drops one that arrives in a callback or finaliser,
and raises none while compiled code runs. So `heard_again` raises a dropped one once more, and `ends_soon` ends the
process if all that has not ended it in time.
"""

from __future__ import annotations

import _thread
import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NoReturn

import click

from coupling import remove_partial_files
from particle import is_held_back

INTERRUPTED = 130  # exit code: 128 and the number of the signal
SOON = 0.05  # s
PATIENCE = 1.5  # s that a command has to end by itself
EXIT = 0.5  # s that Python has to exit, which waits for threads that compile
SHOW_CURSOR = "\033[?25h"  # which a bar hides
_announced = threading.Event()


def end(message: str | None = "interrupted") -> NoReturn:
    """End the command that Ctrl-C broke off; None: what it kept is announcement enough."""
    if message is not None:
        click.echo(message, err=True)
    _announced.set()
    remove_partial_files()  # of threads that still write
    sys.exit(INTERRUPTED)


def ends_soon() -> None:
    """From now on Ctrl-C ends this process within PATIENCE; later only while `unbroken` holds it back.

    Partial files are removed. The thread that sees to it is woken by the signal itself, not by the main thread.
    """
    if threading.current_thread() is not threading.main_thread():
        return
    receiver, sender = socket.socketpair()
    sender.setblocking(False)
    signal.set_wakeup_fd(sender.fileno(), warn_on_full_buffer=False)
    threading.Thread(target=_end_soon, args=(receiver, sender), daemon=True).start()


def _end_soon(receiver: socket.socket, _: socket.socket) -> None:
    """The second socket is only kept open."""
    while signal.SIGINT not in receiver.recv(64):
        pass
    while not _announced.wait(PATIENCE) and is_held_back():
        pass
    if _announced.is_set():
        time.sleep(EXIT)
    remove_partial_files()
    if not _announced.is_set():
        text = f"{SHOW_CURSOR if sys.stderr.isatty() else ''}interrupted\n"
        os.write(2, text.encode())
    os._exit(INTERRUPTED)


@contextmanager
def heard_again() -> Iterator[None]:
    """Raises KeyboardInterrupt in its block, or at its end, though one was dropped or became a SystemError.

    A dropped exception is known to `sys.unraisablehook` only. Where compiled code goes on after one, Python raises a
    SystemError in its place.
    """
    before = sys.unraisablehook
    coming: list[threading.Timer] = []

    def hook(dropped: Any) -> None:
        if not issubclass(dropped.exc_type, KeyboardInterrupt):
            before(dropped)
            return
        coming.append(threading.Timer(SOON, _thread.interrupt_main))
        coming[-1].daemon = True
        coming[-1].start()

    sys.unraisablehook = hook
    try:
        yield
    except SystemError as error:
        if isinstance(error.__cause__, KeyboardInterrupt):
            raise error.__cause__ from None
        raise
    finally:
        sys.unraisablehook = before
        still = [timer for timer in coming if timer.is_alive()]
        for timer in still:
            timer.cancel()
        if still:
            raise KeyboardInterrupt
