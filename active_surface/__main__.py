"""`python -m active_surface` is the command `active-surface`."""

from active_surface.cli import main

main(prog_name="active-surface")
