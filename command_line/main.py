"""The command `active-surface`, with all its commands."""

from command_line import aim, check, completion, run, schema, sweep, verify
from command_line.group import main

__all__ = ["main", "run", "check", "sweep", "aim", "verify", "schema", "completion"]
