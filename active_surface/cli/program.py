"""The command `active-surface`, with all its commands."""

from active_surface.cli import commands
from active_surface.cli.group import main

__all__ = ["commands", "main"]
