"""The commands `run`, `check`, `advise` and `app`, which take a case."""

from __future__ import annotations

from dataclasses import asdict
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated, Any

import click

from active_surface.cli.command import Answer, command, option
from active_surface.cli.options import RESULTS, Output, Overwrite, stages
from active_surface.cli.refusal import kind_of, read, read_all

if TYPE_CHECKING:
    from coupling import Result
    from coupling.case import Case


@command
def run(
    case: Path,
    output: Output = RESULTS,
    csv: Annotated[bool, option("Also write the trajectory to NAME.csv.")] = False,
    forces: Annotated[bool, option("Also write the parts of the contact's force to the part's file and CSV.")] = False,
    verbose: Annotated[bool, option("Also print how the run was computed.", "-v")] = False,
    save_surface: Annotated[bool, option("Also write the moving surface to NAME.surface.h5.")] = False,
) -> Answer:
    """Run CASE and write its results."""
    first, *others = parsed = read_all(case)
    from coupling import report, run_case, run_parts, stage_count

    with stages(stage_count(first)) as bar:
        if others:
            found = run_parts(parsed, case.stem, output, bar, csv, save_surface, forces)
        else:
            result = run_case(first, output, bar, csv, save_surface, forces)
    if not others:
        return Answer(
            result.summary.as_dict(), report.lines(result.summary, verbose), _warnings_of(result), result.files
        )
    rows = report.lines_of_parts({name: result.summary for name, result in found.results.items()}, verbose)
    warnings = report.warnings_of_parts({name: _warnings_of(result) for name, result in found.results.items()})
    return Answer(found.as_dict(), rows, [overlap.sentence for overlap in found.overlaps] + warnings, found.files)


def _warnings_of(result: Result) -> list[str]:
    from coupling import case_warnings, limit_warnings, report

    case = result.case
    return report.warnings(result.summary) + case_warnings(case) + limit_warnings(case, result.shapes)


@command
def check(file: Path) -> Answer:
    """Report every mistake in FILE: a case, a study or an aim."""
    from common import count

    kind = kind_of(file)
    figures: dict[str, Any]
    warnings: list[str] = []
    if kind == "study":
        from active_surface.studies import read_study

        paths = len(read_study(file).points)
        figures, text = {"paths": paths}, f"a study of {count(paths, 'path')}"
    elif kind == "aim":
        from active_surface.steering import read_settings

        case, _, targets, heading = read_settings(file, True)
        actuators = len(case.actuators)
        figures = {"actuators": actuators, "target": targets[0] if targets else None, "heading": heading}
        text = f"an aim of {case.name}, {count(actuators, 'actuator')}"
    else:
        cases = read_all(file)
        case, actuators = cases[0], len(cases[0].actuators)
        warnings = _warnings(case)
        if len(cases) > 1:
            from coupling import report  # loads numerics

            warnings = report.warnings_of_parts({one.name: _warnings(one) for one in cases})
        figures = {"actuators": actuators, "duration": case.run.duration, "parts": len(cases)}
        text = f"{count(actuators, 'actuator') if actuators else 'a platform'}, {case.run.duration * 1e3:g} ms"
        text += f", {count(len(cases), 'part')}" * (len(cases) > 1)
    figures = {"file": str(file), "mistakes": [], **figures}
    return Answer(figures, [(f"{file}: fine; {text}", "")], warnings)


def _warnings(case: Case) -> list[str]:
    """What a case warns of before it runs; ValueError where its plate or its friction cannot be built."""
    from coupling import case_warnings, frequency_warnings
    from coupling.case import PlateCase, has_known_law

    if not has_known_law(case.friction):
        from coupling import build_friction  # takes a second to load

        _ = build_friction(case).law  # ValueError where its numbers have none
    warnings = case_warnings(case) + frequency_warnings(case)
    if isinstance(case.plate, PlateCase) and min(case.plate.foundation, case.plate.tension) < 0:
        from coupling.scene import build_plate  # solves the plate

        build_plate(case.plate)  # which may buckle
    if any(actuator.max_force is not None and actuator.force is None for actuator in case.actuators):
        from coupling import limit_warnings  # solves the plate

        warnings += limit_warnings(case)
    return warnings


@command
def advise(case: Path, overwrite: Overwrite = False, output: Output = RESULTS) -> Answer:
    """Search for drives that move the part of CASE and keep it.

    Runs CASE, then tries rows, columns and single actuators alone, waves, other frequencies, strokes and starts, and
    less friction only where none of these carries the part. Writes the best case to NAME_advised.toml.
    """
    parsed = read(case)
    if parsed.air is not None and parsed.air.film:
        raise ValueError("Input case must have air.film = false: advice is for parts without a film")
    from coupling import advice, check_free, report, run_case, stage_count
    from coupling.case import write_edited

    file = output / f"{parsed.name}{advice.ADVISED}.toml"
    check_free([file], overwrite)
    with stages(stage_count(parsed)) as bar:
        result = run_case(parsed, None, bar)
        with bar("Trying other drives"):
            ranked = advice.advise(result)
    trial = ranked[0] if ranked else None
    thresholds, text = result.summary.thresholds, advice.advice_text(result, trial)
    figures = {"thresholds": thresholds and asdict(thresholds), "trials": [asdict(one) for one in ranked]}
    lines = [row for row in report.lines(result.summary) if row[0] in ("outcome", "thresholds")]
    files = []
    if trial is not None and not result.scene.fits:
        moving, comment = advice.advised_case(parsed, trial), f"The advice on {case.name}: {text}"
        files = [write_edited(moving, parsed, case.absolute().parent, file, comment)]
    others = [("or" if k == 0 else "", advice.advice_text(result, one)) for k, one in enumerate(ranked[1:])]
    return Answer(figures, [*lines, ("advice", text), *others], files=files)


@command
def app(
    case: Path | None = None,
    port: Annotated[int, option("Where the page is served [any that is free].", type=click.IntRange(0, 65535))] = 0,
    no_browser: Annotated[bool, option("Print the address, and do not open it.")] = False,
) -> None:
    """Open CASE in the browser, where its path follows what is dragged.

    Without CASE the page begins with the examples. Nothing leaves this machine: the page is served on the loopback
    address, to whoever has the token in it. It ends when its last tab is closed, or with Ctrl-C.
    """
    if case is not None:
        read(case)
    try:
        import tornado
    except ImportError:
        raise ValueError('the page needs the package tornado: pip install "active-surface[app]"') from None
    assert tornado
    from active_surface.app import Server, open_case
    from coupling import one_blas_thread

    server = Server(None if case is None else partial(open_case, case), port)
    click.echo(f"{'page':<12}{server.address}")
    click.echo(f"{'ends':<12}with its last tab, or Ctrl-C")
    with one_blas_thread(), TemporaryDirectory(prefix="active-surface-") as folder:
        server.run(lambda: None if no_browser else _open(server.address, Path(folder, "open.html")))


def _open(address: str, page: Path) -> None:
    """Open an address in the browser, by a file that leads there: other users see the words of commands."""
    page.touch(mode=0o600)
    page.write_text(f'<!doctype html><meta http-equiv="refresh" content="0; url={address}">', encoding="utf-8")
    click.launch(page.absolute().as_uri())
