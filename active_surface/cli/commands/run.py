"""The command `run`."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import click

from active_surface.cli import options
from active_surface.cli.group import DEFAULT_OUTPUT, main, read, refusing

STAGES = 5  # of a plate that only bends


@main.command()
@click.argument("case", type=click.Path(path_type=Path))
@options.folder
@options.quiet
@options.as_json
@click.option("--csv", is_flag=True, help="Also write the trajectory to NAME.csv.")
@click.option("--forces", is_flag=True, help="Also write the parts of the contact's force to the part's file and CSV.")
@click.option("--verbose", "-v", is_flag=True, help="Also print how the run was computed.")
@click.option("--advised", metavar="FILE", type=click.Path(path_type=Path), help="Write the advised case to FILE.")
@click.option("--save-surface", is_flag=True, help="Also write the moving surface to NAME.surface.h5.")
def run(
    case: Path,
    output: Path | None,
    quiet: bool,
    as_json: bool,
    csv: bool,
    forces: bool,
    verbose: bool,
    advised: Path | None,
    save_surface: bool,
) -> None:
    """Run CASE and write its results."""
    parsed = read(case)
    from coupling import StageBar, answers_drives, limit_warnings, report, run_case, silent
    from coupling.case import write_edited
    from coupling.results import check_folder

    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    if advised is not None:
        refusing(_check_free, advised)
    with nullcontext(silent) if quiet else StageBar(STAGES + answers_drives(parsed)) as bar:
        result = refusing(run_case, parsed, folder, bar, csv, save_surface, forces)
    files, warnings = result.files, report.warnings(result.summary) + limit_warnings(parsed, result.shapes)
    lines = report.lines(result.summary, verbose)
    if advised is not None and result.moves:
        lines.append(("advised", f"The part of this case moves already; nothing was written to {advised}."))
    elif advised is not None and (moving := result.advised) is None:
        warnings.append(f"The run advises no case, so there is none to write to {advised}.")
    elif advised is not None:
        said = f"The advice on {case.name}: {report.trial_text(result.summary)}"
        files += (refusing(write_edited, moving, parsed, case.absolute().parent, advised, said),)
    figures = result.summary.as_dict() | {"warnings": warnings, "files": [str(file) for file in files]}
    options.tell(figures, lines, quiet, as_json, warnings, files)


def _check_free(file: Path) -> None:
    if file.exists():
        raise ValueError(f"--advised must be a new file; got {file}, which exists")
