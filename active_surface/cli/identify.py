"""The command `identify`."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import click

from active_surface.cli import options
from active_surface.cli.group import DEFAULT_OUTPUT, Command, main, read, refusing

if TYPE_CHECKING:
    from active_surface.identification import Track
    from coupling.case import Case

STAGES = 3
Answer = TypeVar("Answer")


class _Free(Command):
    """A command whose option --free takes all the fields that follow it."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        spread, free = [], False
        for text in args:
            field = not text.startswith("-") and not Path(text).exists()
            if free and field:
                spread.append(f"--free={text}")
            elif text != "--free":
                spread.append(text)
            free = text.startswith("--free") or (free and field)
        return super().parse_args(ctx, spread)


@main.command(cls=_Free)
@click.argument("case", type=click.Path(path_type=Path))
@click.option("--track", type=click.Path(path_type=Path), required=True, help="CSV file of time, x and y, with units.")
@click.option("--free", multiple=True, required=True, metavar="FIELD ...", help="Fields to find: part.squeeze ...")
@click.option(
    "--bounds", multiple=True, metavar="FIELD=LOW,HIGH", help="Of a field [a tenth and ten times the case's]."
)
@click.option("--absolute", is_flag=True, help="Make distances small, not their squares: for tracks with outliers.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of the search's starts.")
@click.option("--overwrite", is_flag=True, help="Replace an earlier result.")
@options.threads
@options.folder
@options.quiet
@options.as_json
def identify(
    case: Path,
    track: Path,
    free: tuple[str, ...],
    bounds: tuple[str, ...],
    absolute: bool,
    seed: int,
    overwrite: bool,
    threads: int | None,
    output: Path | None,
    quiet: bool,
    as_json: bool,
) -> None:
    """Find the fields of CASE with which its path is closest to a measured track.

    Fields are those of [part] and [friction]. Each gets a 95 % interval, and a warning where the track does not
    determine it. Writes NAME_identified.toml with the fields, and NAME_identified.png.
    """
    parsed = read(case)
    from active_surface.identification import identify as find
    from coupling import StageBar, silent
    from coupling.results import check_folder

    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    places, ends = refusing(_inputs, parsed, track, free, bounds, folder, overwrite)
    loss = "absolute" if absolute else "squares"
    with nullcontext(silent) if quiet else StageBar(STAGES) as bar:
        found = refusing(find, parsed, places, free, ends, loss, seed, threads, bar)
    found = refusing(found.written, folder, True)
    figures = found.figures() | {"files": list(map(str, found.files))}
    options.tell(figures, found.lines(), quiet, as_json, found.warnings(), found.files)


def _inputs(
    case: Case, track: Path, free: tuple[str, ...], bounds: tuple[str, ...], folder: Path, overwrite: bool
) -> tuple[Track, dict[str, list[str]]]:
    """The track and the bounds; ValueError with all that is wrong with any input."""
    from active_surface.identification import check_free, free_parameters, read_track

    wrong: list[str] = []
    places = _unless(wrong, read_track, track)
    ends = _unless(wrong, _bounds, bounds)
    _unless(wrong, free_parameters, case, free, ends or {})
    _unless(wrong, check_free, folder, f"{case.name}_identified", overwrite)
    if places is None or ends is None or wrong:
        raise ValueError("\n".join(wrong))
    return places, ends


def _unless(wrong: list[str], work: Callable[..., Answer], *arguments: object) -> Answer | None:
    """work(*arguments); None where that refuses them, whose reasons are added."""
    try:
        return work(*arguments)
    except ValueError as error:
        wrong.append(str(error))
        return None


def _bounds(texts: tuple[str, ...]) -> dict[str, list[str]]:
    """The bounds in texts such as part.squeeze=1 nN,10 nN."""
    bounds, wrong = {}, []
    for text in texts:
        field, equals, ends = text.partition("=")
        values = [end.strip() for end in ends.split(",")]
        if not equals or len(values) != 2:
            wrong.append(f'Input bounds of identify must be like "part.squeeze=1 nN,10 nN"; got "{text}"')
        bounds[field.strip()] = values
    if wrong:
        raise ValueError("\n".join(wrong))
    return bounds
