"""The command `schema`."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

from active_surface.cli.group import main

if TYPE_CHECKING:
    from coupling.case import Table

CASE, STUDY, AIM = "case", "study", "aim"


@main.command()
@click.argument("kind", type=click.Choice([CASE, STUDY, AIM]), default=CASE)
@click.option(
    "--template", is_flag=True, help="Print a file that has every field, with comments, in place of the schema."
)
def schema(kind: str, template: bool) -> None:
    """Print the JSON schema of the files of a KIND: case (which is the default), study or aim.

    Editors that know TOML schemas complete fields by it and show what they mean.
    """
    from coupling.case import json_schema
    from coupling.case import template as template_of

    model = _model(kind)
    if template:
        click.echo(template_of(model), nl=False)
    else:
        click.echo(json.dumps(json_schema(model, f"A {kind} of active-surface"), indent=2, ensure_ascii=False))


def _model(kind: str) -> type[Table]:
    """What files of a kind hold."""
    if kind == STUDY:
        from active_surface.studies import StudyTables

        return StudyTables
    if kind == AIM:
        from active_surface.steering import AimTables

        return AimTables
    from coupling.case import CaseTables

    return CaseTables
