"""The commands `example`, `schema`, `completion`, `verify` and `reproduce`, which take no file."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Annotated, Literal

import click
from click.shell_completion import get_completion_class

from active_surface.cli.command import Answer, command, option
from active_surface.cli.options import FILE, RESULTS, Output, stages

if TYPE_CHECKING:
    from fem_plate import Check

NAME = "active-surface"
VARIABLE = "_ACTIVE_SURFACE_COMPLETE"  # by which click is asked, when the command is called so
MODELS = {
    "case": "coupling.case:CaseTables",
    "study": "active_surface.studies:StudyTables",
    "aim": "active_surface.steering:AimTables",
}
"""What files hold."""


@command
def example(name: str | None = None) -> Answer:
    """Write the example NAME, with the files that it reads, where you are; without NAME list all.

    No file is replaced.
    """
    from active_surface.examples import command_of, example_names, write_example

    if name is None:
        names = example_names()
        width = max(map(len, names))
        return Answer({"examples": names}, [(f"{one:{width}}", f"  {about}") for one, about in names.items()])
    name = name.removesuffix(".toml")
    files = {path.as_posix(): new for path, new in write_example(name, Path()).items()}
    following = f"{NAME} {command_of(name)}"
    lines = [("wrote" if new else "is there", path) for path, new in files.items()]
    return Answer({"files": files, "next": following}, [*lines, ("next", following)])


@command
def schema(
    kind: Literal["case", "study", "aim"] = "case",
    template: Annotated[
        bool, option("Print a file that has every field, with comments, in place of the schema.")
    ] = False,
) -> str:
    """Print the JSON schema of the files of a KIND: case (which is the default), study or aim.

    Editors that know TOML schemas complete fields by it and show what they mean.
    """
    from coupling.case import json_schema
    from coupling.case import template as template_of

    model = resolve_name(MODELS[kind])
    if template:
        return template_of(model).removesuffix("\n")
    return json.dumps(json_schema(model, f"A {kind} of active-surface"), indent=2, ensure_ascii=False)


@command
def completion(shell: Literal["bash", "zsh", "fish"]) -> str:
    """Print the script by which SHELL completes commands, options and files.

    In ~/.bashrc or ~/.zshrc: eval "$(active-surface completion bash)", or zsh. For fish: active-surface completion fish
    > ~/.config/fish/completions/active-surface.fish
    """
    kind = get_completion_class(shell)
    assert kind
    return kind(click.get_current_context().find_root().command, {}, NAME, VARIABLE).source()


@command
def verify(
    quiet: Annotated[bool, option("Print no summary, show no progress.", "-q")] = False,
    file: Annotated[Path | None, option("Also write every figure to FILE.", "--json", type=FILE)] = None,
) -> None:
    """Check the plate against theory.

    Solves equation (2) and an off-centre layout on three meshes; exits with 1 when an error on the finest mesh or an
    observed order misses its bound.
    """
    from coupling import check_folder, whole_file
    from fem_plate import verification

    if file is not None:
        check_folder(file.parent)
    with stages(1) as bar, bar("Checking the plate"):
        checks = verification.verify()
    if not quiet:
        for check in checks:
            _print(check)
    if file is not None:
        file.parent.mkdir(parents=True, exist_ok=True)
        with whole_file(file) as partial:
            partial.write_text(json.dumps([check.as_dict() for check in checks], indent=2) + "\n")
    sys.exit(0 if all(check.passed for check in checks) else 1)


def _print(check: Check) -> None:
    from fem_plate import verification

    click.echo(f"{check.name}: {'passed' if check.passed else 'FAILED'}")
    unknowns = "".join(f"{n:>11}" for n in check.unknowns)
    click.echo(f"  {'unknowns':<10}{unknowns}{'order':>9}{'bound, order':>16}")
    for k, name in enumerate(verification.QUANTITIES):
        order = check.orders[name]
        text = "rounding" if order is None else f"{order:.2f}"
        bounds = f"{verification.ERROR_BOUNDS[k]:.0e}, {verification.ORDER_BOUNDS[k]:g}"
        click.echo(f"  {name:<10}" + "".join(f"{e:>11.2e}" for e in check.errors[name]) + f"{text:>9}{bounds:>16}")
    for failure in check.failures:
        click.secho(f"  {failure}", fg="red")


@command
def reproduce(
    figure: tuple[str, ...],
    full: Annotated[bool, option("Many more starts, and finer steps: takes long.")] = False,
    output: Output = RESULTS,
) -> Answer:
    """Reproduce figures of the paper, such as fig17, or all.

    Each in three models: the paper's scheme on its closed-form surface, our equations on that surface, and our
    equations on a plate of finite elements. Writes a picture and the data of each; of all a page as well.
    """
    from active_surface.paper import FULL, QUICK, figures_of, rounded
    from active_surface.paper import reproduce as run

    with stages(len(figures_of(figure))) as bar:
        done = run(figure, output, FULL if full else QUICK, progress=bar)
    summary = {"verdicts": [verdict.as_dict() for verdict in done.verdicts], "seconds": done.seconds}
    lines: list[tuple[str, str]] = []
    for verdict in done.verdicts:
        lines += [(f"figure {verdict.figure}: {verdict.verdict}", ""), ("  the paper", f"  {verdict.statement}")]
        lines += [(f"  {model}", f"  {answer.text}") for model, answer in verdict.answers.items()]
        lines.append(("", ""))
    return Answer(rounded(summary), [*lines, ("time", f"{done.seconds:.0f} s")], files=done.files)
