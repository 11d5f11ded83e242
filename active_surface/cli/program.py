"""The command `active-surface`, with all its commands."""

from active_surface.cli import (
    aim,
    animate,
    check,
    completion,
    export,
    feasibility,
    plot,
    reproduce,
    rerun,
    response,
    run,
    schema,
    sweep,
    verify,
    view,
)
from active_surface.cli.group import main

__all__ = [
    "main",
    "aim",
    "animate",
    "check",
    "completion",
    "export",
    "feasibility",
    "plot",
    "reproduce",
    "rerun",
    "response",
    "run",
    "schema",
    "sweep",
    "verify",
    "view",
]
