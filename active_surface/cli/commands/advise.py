"""The command `advise`."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import asdict
from pathlib import Path

import click

from active_surface.cli import options
from active_surface.cli.group import DEFAULT_OUTPUT, main, read, refusing


@main.command()
@click.argument("case", type=click.Path(path_type=Path))
@click.option("--overwrite", is_flag=True, help="Replace an earlier result.")
@options.folder
@options.quiet
@options.as_json
def advise(case: Path, overwrite: bool, output: Path | None, quiet: bool, as_json: bool) -> None:
    """Search for drives that move the part of CASE and keep it.

    Runs CASE, then tries other frequencies, strokes, friction and starts until one carries the part far. Writes that
    case to NAME_advised.toml.
    """
    parsed = read(case)
    from coupling import StageBar, advice, report, run_case, silent, stage_count
    from coupling.case import write_edited
    from coupling.results import check_folder

    file = (output or DEFAULT_OUTPUT) / f"{parsed.name}{advice.ADVISED}.toml"
    refusing(check_folder, file.parent)
    if file.exists() and not overwrite:
        refusing(_refuse, file)
    with nullcontext(silent) if quiet else StageBar(stage_count(parsed)) as bar:
        result = refusing(run_case, parsed, None, bar)
        with bar("Trying other drives"):
            found = refusing(advice.advise, result)
    thresholds = result.summary.thresholds
    figures = {"thresholds": thresholds and asdict(thresholds), "trial": found and found.trial and asdict(found.trial)}
    lines = [row for row in report.lines(result.summary) if row[0] in ("outcome", "thresholds")]
    files: tuple[Path, ...] = ()
    if found is None:
        lines.append(("advice", "The part moves already, or no factor scales what drives it."))
    else:
        said = advice.trial_text(result.summary, found)
        lines.append(("advice", said))
        if found.trial is not None and not found.measured:
            moving = advice.advised_case(parsed, found.trial)
            text = f"The advice on {case.name}: {said}"
            files = (refusing(write_edited, moving, parsed, case.absolute().parent, file, text),)
    options.tell(figures | {"files": [str(one) for one in files]}, lines, quiet, as_json, files=files)


def _refuse(file: Path) -> None:
    raise ValueError(f"{file} exists; --overwrite replaces it")
