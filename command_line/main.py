"""The command `active-surface`, with all its commands."""

from command_line import aim, feasibility, reproduce, run, sweep, verify
from command_line.group import main

__all__ = ["main", "run", "sweep", "aim", "feasibility", "reproduce", "verify"]
