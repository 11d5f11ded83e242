"""`python -m steering` is the command `active-surface`."""

from coupling.cli import main
from steering import cli  # noqa: F401  # which adds its commands

main(prog_name="active-surface")
