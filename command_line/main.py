"""The command `active-surface`, with all its commands."""

from command_line import aim, export, rerun, run, sweep, verify, view
from command_line.group import main

__all__ = ["main", "run", "rerun", "export", "sweep", "view", "aim", "verify"]
