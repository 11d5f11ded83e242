"""The command `view`."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import click

from active_surface.cli import options
from active_surface.cli.group import DEFAULT_OUTPUT, main, refusing


@main.command()
@click.argument("result", type=click.Path(path_type=Path))
@click.option(
    "--output", "-o", type=click.Path(path_type=Path, dir_okay=False), help="The page [NAME.html beside the result]."
)
@click.option("--paths", type=click.IntRange(min=0), help="Paths of a sweep to have in the page [about a minute's].")
@click.option("--open", "opened", is_flag=True, help="Open the page in the browser.")
@options.quiet
@options.as_json
def view(result: Path, output: Path | None, paths: int | None, opened: bool, quiet: bool, as_json: bool) -> None:
    """Write RESULT as one HTML page that works offline.

    RESULT is one of the two files of a run, finished or partial, or the netCDF file of a sweep. A case or study file
    stands for its results in `results/` or beside it.
    """
    from active_surface.views import result_of
    from coupling.results import check_folder

    if output is not None and output.suffix.lower() != ".html":
        raise click.BadParameter(f"must end in .html; got {output}", param_hint="--output")
    found = refusing(result_of, result, DEFAULT_OUTPUT)
    page = output or found.page
    refusing(check_folder, page.parent)
    warnings: list[str] = []
    if found.is_sweep:
        from active_surface.studies import read_study, read_sweep
        from active_surface.views.pages import write_study_page
        from coupling import CountBar, no_progress

        given = None if found.study is None else refusing(read_study, found.study)
        study, dataset = refusing(read_sweep, found.path, given)
        with dataset, nullcontext(no_progress) if quiet else CountBar("paths") as tell:
            page.parent.mkdir(parents=True, exist_ok=True)
            refusing(write_study_page, study, dataset, page, paths, tell)
    else:
        if paths is not None:
            raise click.UsageError(f"--paths must not be given for a run; got {result}")
        from active_surface.views import is_of
        from active_surface.views.pages import PARTIAL, write_run_page
        from coupling.results import read_run

        run = refusing(read_run, found.path)
        if result.suffix == ".toml" and not refusing(is_of, run, result):
            warnings.append(f"{found.path} is of another case than {result} is now: `active-surface run {result}`")
        if not run.complete:
            warnings.append(PARTIAL)
        page.parent.mkdir(parents=True, exist_ok=True)
        refusing(write_run_page, run, page)
    size = page.stat().st_size
    figures = {"warnings": warnings, "files": [str(page)], "bytes": size}
    options.tell(figures, [("page", f"{size / 1e6:.1f} MB, works offline")], quiet, as_json, warnings, [page])
    if opened:
        click.launch(page.absolute().as_uri())
