"""The command `sweep`."""

from __future__ import annotations

import sys
from contextlib import nullcontext
from pathlib import Path

import click

from active_surface.cli import ctrl_c, options
from active_surface.cli.group import DEFAULT_OUTPUT, check_kind, main, refusing


@main.command()
@click.argument("study", type=click.Path(path_type=Path))
@options.folder
@options.threads
@click.option("--scheduler", "-s", help="Address of a dask scheduler whose workers find the paths, tcp://HOST:PORT.")
@click.option("--overwrite", is_flag=True, help="Replace the results of another study of this name.")
@options.quiet
@options.as_json
def sweep(
    study: Path,
    output: Path | None,
    threads: int | None,
    scheduler: str | None,
    overwrite: bool,
    quiet: bool,
    as_json: bool,
) -> None:
    """Find the paths at all points of STUDY and write them to one file.

    A sweep that was interrupted goes on where it stopped when it is started again, and a study that has grown keeps the
    paths that its results have. Exits with 1 when every point was refused.
    """
    if scheduler is not None and threads is not None:
        raise click.UsageError("--threads must not be given with --scheduler: each worker uses all of its own threads")
    from active_surface.studies import REFUSED, figures, lines, read_study, run_study
    from coupling import CountBar, no_progress
    from coupling.results import check_folder

    check_kind(study, "study")
    read = refusing(read_study, study)
    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    try:
        with nullcontext(no_progress) if quiet else CountBar("paths") as tell:
            result = refusing(run_study, read, folder, threads, tell, scheduler, overwrite)
    except KeyboardInterrupt:
        ctrl_c.end("interrupted; the same command goes on where this one stopped")
    options.tell(figures(result), lines(result), quiet, as_json, result.warnings)
    if set(result.outcomes) == {REFUSED}:
        sys.exit(1)
