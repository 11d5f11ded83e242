"""The command `app`."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import click

from active_surface.cli.group import main, read, refusing


@main.command()
@click.argument("case", type=click.Path(path_type=Path), required=False)
@click.option("--port", type=click.IntRange(0, 65535), default=0, help="Where the page is served [any that is free].")
@click.option("--no-browser", is_flag=True, help="Print the address, and do not open it.")
def app(case: Path | None, port: int, no_browser: bool) -> None:
    """Open CASE in the browser, where its path follows what is dragged.

    Without CASE the page begins with the examples. Nothing leaves this machine: the page is served on the loopback
    address, to whoever has the token in it. It ends when its last tab is closed, or with Ctrl-C.
    """
    if case is not None:
        read(case)
    refusing(_serve, case, port, no_browser)


def _serve(case: Path | None, port: int, no_browser: bool) -> None:
    try:
        import tornado
    except ImportError:
        raise ValueError('the page needs the package tornado: pip install "active-surface[app]"') from None
    assert tornado
    from threadpoolctl import threadpool_limits

    from active_surface.app import Server, open_case

    server = Server(None if case is None else partial(open_case, case), port)
    click.echo(f"{'page':<12}{server.address}")
    click.echo(f"{'ends':<12}with its last tab, or Ctrl-C")
    # Many small systems: BLAS threads would only wait for each other.
    with threadpool_limits(limits=1, user_api="blas"), TemporaryDirectory(prefix="active-surface-") as folder:
        server.run(lambda: None if no_browser else _open(server.address, Path(folder, "open.html")))


def _open(address: str, page: Path) -> None:
    """Open an address in the browser, by a file that leads there: other users see the words of commands."""
    page.touch(mode=0o600)
    page.write_text(f'<!doctype html><meta http-equiv="refresh" content="0; url={address}">', encoding="utf-8")
    click.launch(page.absolute().as_uri())
