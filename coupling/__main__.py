"""`python -m coupling` is the command `active-surface`."""

from coupling.cli import main

main(prog_name="active-surface")
