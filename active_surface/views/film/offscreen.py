"""Off screen: whether pyvista can draw on this machine, found out where a crash does no harm."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping

WINDOW = "VTK_DEFAULT_OPENGL_WINDOW"
EGL = "vtkEGLRenderWindow"  # draws without a display
PATIENCE = 120.0  # s
LONGEST = 200  # letters of a reason
TRY = """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=[64, 64])
plotter.set_background("white")
plotter.add_mesh(pyvista.Sphere(), color="black", lighting=False)
image = plotter.screenshot(None, return_img=True)
assert image[32, 32].max() < 64 and image[0, 0].min() > 192, "the picture is blank"
"""


def prepare() -> str | None:
    """Sets this process up for pyvista; None where it can draw, otherwise why it cannot.

    A render window that VTK cannot make ends the interpreter, so another one tries it. Without a display, or where
    that cannot be drawn to, the window is one of EGL's, unless the environment asks for another.
    """
    reasons = []
    for setting in _settings(os.environ):
        reason = _tried({**os.environ, **setting})
        if reason is None:
            os.environ.update(setting)
            return None
        reasons.append(reason)
    return reasons[-1]


def _settings(environment: Mapping[str, str]) -> list[dict[str, str]]:
    """What is added to the environment, in the order in which it is tried."""
    if WINDOW in environment or not sys.platform.startswith("linux"):
        return [{}]
    return [{}, {WINDOW: EGL}] if environment.get("DISPLAY") else [{WINDOW: EGL}]


def _tried(environment: Mapping[str, str]) -> str | None:
    """Why a fresh interpreter with an environment cannot draw; None: it can."""
    command = [sys.executable, "-c", TRY]
    try:
        run = subprocess.run(
            command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=PATIENCE
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return str(error)[:LONGEST]
    if run.returncode == 0:
        return None
    last = next((line.strip() for line in reversed(run.stderr.splitlines()) if line.strip()), "")[:LONGEST]
    if run.returncode < 0:
        return f"VTK ends the interpreter (signal {-run.returncode})"
    return last or f"VTK ends the interpreter (exit code {run.returncode})"
