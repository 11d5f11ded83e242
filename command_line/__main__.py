"""`python -m command_line` is the command `active-surface`."""

from command_line.main import main

main(prog_name="active-surface")
