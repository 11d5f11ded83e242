"""The command `check`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from active_surface.cli import options
from active_surface.cli.group import kind_of, main, parse_file, read, refusing
from coupling import printable


@main.command()
@click.argument("file", type=click.Path(path_type=Path))
@options.quiet
@options.as_json
def check(file: Path, quiet: bool, as_json: bool) -> None:
    """Report every mistake in FILE: a case, a study or an aim."""
    from coupling.case import PlateCase, has_known_law

    kind = kind_of(refusing(parse_file, file))
    figures: dict[str, Any]
    warnings: list[str] = []
    if kind == "study":
        from active_surface.studies import read_study

        study = refusing(read_study, file)
        figures = {"paths": len(study.points)}
        summary = f"a study of {_counted(len(study.points), 'path')}"
    elif kind == "aim":
        from active_surface.steering import read_settings

        case, _, target = refusing(read_settings, file, True)
        figures = {"actuators": len(case.actuators), "target": target}
        summary = f"an aim of {case.name}, {_counted(len(case.actuators), 'actuator')}"
    else:
        case = read(file)
        if not has_known_law(case.friction):
            from coupling import build_friction  # takes a second to load

            refusing(lambda: build_friction(case).law)
        from coupling import case_warnings, frequency_warnings

        warnings = case_warnings(case) + frequency_warnings(case)
        limited = any(actuator.max_force is not None and actuator.force is None for actuator in case.actuators)
        if limited or (isinstance(case.plate, PlateCase) and min(case.plate.foundation, case.plate.tension) < 0):
            from coupling import limit_warnings  # these solve the plate
            from coupling.scene import build_plate

            refusing(build_plate, case.plate)  # which may buckle
            warnings += refusing(limit_warnings, case)
        count = len(case.actuators)
        figures = {"actuators": count, "duration": case.run.duration}
        summary = f"{_counted(count, 'actuator') if count else 'a platform'}, {case.run.duration * 1e3:g} ms"
    if as_json:
        click.echo(
            options.json_text(
                {"file": str(file), "mistakes": [], "warnings": [*options.of_libraries, *warnings], **figures}
            )
        )
    elif not quiet:
        click.echo(printable(f"{file}: fine; {summary}"))
        options.warn(warnings)


def _counted(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"
