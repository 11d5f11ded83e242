"""The command `active-surface`, with all its commands."""

from command_line import (
    aim,
    animate,
    check,
    completion,
    export,
    feasibility,
    plot,
    reproduce,
    rerun,
    run,
    schema,
    sweep,
    verify,
    view,
)
from command_line.group import main

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
    "run",
    "schema",
    "sweep",
    "verify",
    "view",
]
