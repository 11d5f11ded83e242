"""The command `run`."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import click

from active_surface.cli import options
from active_surface.cli.group import DEFAULT_OUTPUT, main, read, refusing


@main.command()
@click.argument("case", type=click.Path(path_type=Path))
@options.folder
@options.quiet
@options.as_json
@click.option("--csv", is_flag=True, help="Also write the trajectory to NAME.csv.")
@click.option("--forces", is_flag=True, help="Also write the parts of the contact's force to the part's file and CSV.")
@click.option("--verbose", "-v", is_flag=True, help="Also print how the run was computed.")
@click.option("--save-surface", is_flag=True, help="Also write the moving surface to NAME.surface.h5.")
def run(
    case: Path,
    output: Path | None,
    quiet: bool,
    as_json: bool,
    csv: bool,
    forces: bool,
    verbose: bool,
    save_surface: bool,
) -> None:
    """Run CASE and write its results."""
    parsed = read(case)
    from coupling import StageBar, case_warnings, limit_warnings, report, run_case, silent, stage_count
    from coupling.results import check_folder

    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    with nullcontext(silent) if quiet else StageBar(stage_count(parsed)) as bar:
        result = refusing(run_case, parsed, folder, bar, csv, save_surface, forces)
    files, summary = result.files, result.summary
    warnings = report.warnings(summary) + case_warnings(parsed) + limit_warnings(parsed, result.shapes)
    lines = report.lines(summary, verbose)
    figures = summary.as_dict() | {"warnings": warnings, "files": [str(file) for file in files]}
    options.tell(figures, lines, quiet, as_json, warnings, files)
