"""The command `active-surface`, with all its commands."""

from command_line import aim, run, sweep, verify, view
from command_line.group import main

__all__ = ["main", "run", "sweep", "view", "aim", "verify"]
