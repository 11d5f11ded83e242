"""The command `completion`."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

from active_surface.cli.group import main

NAME = "active-surface"
VARIABLE = "_ACTIVE_SURFACE_COMPLETE"  # by which click is asked, when the command is called so


@main.command()
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
def completion(shell: str) -> None:
    """Print the script by which SHELL completes commands, options and files.

    In ~/.bashrc or ~/.zshrc: eval "$(active-surface completion bash)", or zsh. For fish: active-surface completion fish
    > ~/.config/fish/completions/active-surface.fish
    """
    kind = get_completion_class(shell)
    assert kind
    click.echo(kind(main, {}, NAME, VARIABLE).source())
