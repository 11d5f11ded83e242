"""`python -m studies` is the command `active-surface`."""

from coupling.cli import main
from studies import cli  # noqa: F401  # which adds its command

main(prog_name="active-surface")
