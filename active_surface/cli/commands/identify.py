"""The command `identify`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, TypeVar

import click

from active_surface.cli import options
from active_surface.cli.group import DEFAULT_OUTPUT, Spreading, main, read_all, refusing

if TYPE_CHECKING:
    from active_surface.identification import Track
    from coupling.case import Case

STAGES = 3
CASE = ".toml"
Answer = TypeVar("Answer")


def _track(text: str) -> bool:
    return not text.startswith("-") and not text.endswith(CASE)


def _field(text: str) -> bool:
    return _track(text) and not Path(text).exists()


class _Lists(Spreading):
    """A command whose options take all the tracks or fields that follow them."""

    spread: ClassVar = {"--track": _track, "--free": _field, "--own": _field}


@main.command(cls=_Lists)
@click.argument("case", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option(
    "--track",
    type=click.Path(path_type=Path),
    multiple=True,
    required=True,
    metavar="FILE ...",
    help="CSV file of time, x and y, with units: one for each CASE, or several of one.",
)
@click.option("--free", multiple=True, metavar="FIELD ...", help="Fields to find: part.squeeze ...")
@click.option("--own", multiple=True, metavar="FIELD ...", help="Fields that each track has for itself.")
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
    case: tuple[Path, ...],
    track: tuple[Path, ...],
    free: tuple[str, ...],
    own: tuple[str, ...],
    bounds: tuple[str, ...],
    absolute: bool,
    seed: int,
    overwrite: bool,
    threads: int | None,
    output: Path | None,
    quiet: bool,
    as_json: bool,
) -> None:
    """Find the fields of each CASE with which paths are closest to measured tracks.

    Fields are those of [part] and [friction]. Each gets a 95 % interval, and a warning where tracks do not determine
    it. Writes NAME_identified.toml with the fields for each case, and NAME_identified.png.
    """
    parsed = read_all(case)
    from active_surface.identification import identify as find
    from coupling import StageBar, silent
    from coupling.results import check_folder

    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    places, ends = refusing(_inputs, parsed, track, free, own, bounds, folder, overwrite)
    loss = "absolute" if absolute else "squares"
    with nullcontext(silent) if quiet else StageBar(STAGES) as bar:
        found = refusing(find, parsed, places, free, ends, own, loss, seed, threads, bar)
    found = refusing(found.written, folder, True)
    figures = found.figures() | {"files": list(map(str, found.files))}
    options.tell(figures, found.lines(), quiet, as_json, found.warnings(), found.files)


def _inputs(
    cases: Sequence[Case],
    tracks: Sequence[Path],
    free: Sequence[str],
    own: Sequence[str],
    bounds: Sequence[str],
    folder: Path,
    overwrite: bool,
) -> tuple[list[Track], dict[str, list[str]]]:
    """The tracks and the bounds; ValueError with all that is wrong with any input."""
    from active_surface.identification import case_names, check_free, checked, read_track

    wrong: list[str] = []
    places = [_unless(wrong, read_track, track) for track in tracks]
    ends = _unless(wrong, _bounds, bounds)
    _unless(wrong, checked, cases, places, free, own, ends or {})
    _unless(wrong, check_free, folder, case_names(cases, len(tracks), bool(own)), overwrite)
    if ends is None or wrong:
        raise ValueError("\n".join(wrong))
    return [track for track in places if track], ends


def _unless(wrong: list[str], work: Callable[..., Answer], *arguments: object) -> Answer | None:
    """work(*arguments); None where that refuses them, whose reasons are added."""
    try:
        return work(*arguments)
    except ValueError as error:
        wrong.append(str(error))
        return None


def _bounds(texts: Sequence[str]) -> dict[str, list[str]]:
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
