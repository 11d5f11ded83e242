"""The command `active-surface`, with all its commands."""

from command_line import aim, animate, export, rerun, run, sweep, verify
from command_line.group import main

__all__ = ["main", "run", "rerun", "export", "animate", "sweep", "aim", "verify"]
