"""Options that several commands have, and how those tell what they found."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import click

from coupling import printable

WIDTH = 12  # of labels
Command = TypeVar("Command", bound=Callable[..., Any])

quiet = click.option("--quiet", "-q", is_flag=True, help="Print no summary, show no progress.")
as_json = click.option("--json", "as_json", is_flag=True, help="Print the summary, or what is wrong, as JSON.")
threads = click.option("--threads", "-t", type=click.IntRange(min=1), help="Paths found at a time [one a processor].")


def output_folder(usual: str, what: str = "results", default: Path | None = None) -> Callable[[Command], Command]:
    """The option of a folder for what a command makes."""
    kind = click.Path(path_type=Path, file_okay=False)
    return click.option("--output", "-o", type=kind, default=default, help=f"Folder for the {what} [{usual}].")


folder = output_folder("results")
of_libraries: list[str] = []  # the warnings that Python's `warnings` gave so far, printed already


def tell(
    figures: Mapping[str, Any],
    lines: Iterable[tuple[str, str]],
    quiet: bool,
    as_json: bool,
    warnings: Iterable[str] = (),
    files: Iterable[Path] = (),
) -> None:
    """Prints what a command found, as figures or in words."""
    if as_json:
        click.echo(json_text({**figures, "warnings": [*of_libraries, *warnings]} if of_libraries else figures))
    elif not quiet:
        for label, text in lines:
            click.echo(printable(f"{label:<{WIDTH}}{text}"))
        warn(warnings)
        for file in files:
            click.echo(printable(f"{'wrote':<{WIDTH}}{file}"))


def json_text(figures: Mapping[str, Any]) -> str:
    """Figures as JSON, which has no nan and no infinity: they become null."""
    return json.dumps(_finite(dict(figures)), indent=2, allow_nan=False)


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def warn(warnings: Iterable[str]) -> None:
    """Prints warnings in yellow."""
    for warning in warnings:
        click.secho(printable(f"{'warning':<{WIDTH}}{warning}"), fg="yellow")
