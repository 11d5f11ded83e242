"""Ctrl-C ends a command within seconds, whatever Python or compiled code is doing.

Most commands end by the KeyboardInterrupt that Python raises. Python drops one that arrives in a callback or a
finaliser, and raises none while compiled code runs. So one that is dropped is raised again, and a thread ends the
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
from typing import Any, NoReturn

import click

from coupling import remove_partial_files
from particle import is_held_back

INTERRUPTED = 130  # exit code: 128 and the number of the signal
SOON = 0.05  # s
PATIENCE = 1.5  # s that a command has to end by itself
SHOW_CURSOR = "\033[?25h"  # which a bar hides
_announced = threading.Event()


def watch() -> None:
    """From now on Ctrl-C ends this process within PATIENCE; later only while `unbroken` holds it back."""
    receiver, sender = socket.socketpair()
    sender.setblocking(False)
    signal.set_wakeup_fd(sender.fileno(), warn_on_full_buffer=False)
    threading.Thread(target=_end_soon, args=(receiver, sender), daemon=True).start()
    sys.unraisablehook = _raise_again


def _end_soon(receiver: socket.socket, _: socket.socket) -> None:
    """Wait for the signal itself, not for the main thread; the second socket is only kept open."""
    while signal.SIGINT not in receiver.recv(64):
        pass
    time.sleep(PATIENCE)
    while is_held_back():
        time.sleep(PATIENCE)
    remove_partial_files()
    if not _announced.is_set():
        os.write(2, f"{SHOW_CURSOR if sys.stderr.isatty() else ''}interrupted\n".encode())
    os._exit(INTERRUPTED)


def _raise_again(dropped: Any) -> None:
    if issubclass(dropped.exc_type, KeyboardInterrupt):
        threading.Timer(SOON, _thread.interrupt_main).start()
    else:
        sys.__unraisablehook__(dropped)


def end(message: str = "interrupted") -> NoReturn:
    """End the command that Ctrl-C broke off."""
    click.echo(message, err=True)
    _announced.set()
    remove_partial_files()  # of threads that still write
    sys.exit(INTERRUPTED)
