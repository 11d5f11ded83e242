"""The command `animate`."""

from __future__ import annotations

from contextlib import nullcontext
from functools import partial
from pathlib import Path

import click

from active_surface.cli import options
from active_surface.cli.group import main, refusing


@main.command()
@click.argument("result", type=click.Path(path_type=Path))
@click.option("--output", "-o", type=click.Path(path_type=Path), help="File, or folder of PNG frames [NAME.mp4].")
@click.option("--format", "kind", type=click.Choice(["mp4", "gif", "png"]), help="Format [that of --output, or mp4].")
@click.option(
    "--camera", default="iso", show_default=True, help="iso, top, front, side, or AZIMUTH,ELEVATION [degrees]."
)
@click.option(
    "--exaggeration", "-x", type=float, metavar="F", help="How much larger heights are drawn [as they are seen]."
)
@click.option(
    "--slow-motion", type=float, metavar="S", help="Seconds of film for each of the run [it lasts about 8 s]."
)
@click.option("--fps", type=float, help="Frames a second [30, of a GIF 20].")
@click.option("--size", metavar="WxH", help="Pixels [1280x720, of a GIF 800x450].")
@click.option("--renderer", type=click.Choice(["auto", "pyvista", "matplotlib"]), default="auto", show_default=True)
@options.quiet
@options.as_json
def animate(
    result: Path,
    output: Path | None,
    kind: str | None,
    camera: str,
    exaggeration: float | None,
    slow_motion: float | None,
    fps: float | None,
    size: str | None,
    renderer: str,
    quiet: bool,
    as_json: bool,
) -> None:
    """Make a film of RESULT: the plate's heights, the part and its trail.

    RESULT is one of the two files of a run, finished or partial, or FOLDER/NAME. Where pyvista cannot draw,
    matplotlib does, and the command says so.
    """
    from active_surface.views.film import animate as make
    from coupling import CountBar, no_progress

    with nullcontext(no_progress) if quiet else CountBar("frames") as tell:
        made = refusing(
            partial(
                make,
                result,
                output,
                kind=kind,
                camera=camera,
                fps=fps,
                slow_motion=slow_motion,
                exaggeration=exaggeration,
                size=size,
                renderer=renderer,
                tell=tell,
            )
        )
    lasts = f"{made.frames} frames at {made.fps:g} a second, {made.frames / made.fps:.3g} s"
    lines = [
        ("film", f"{lasts}, {made.slow_motion:.6g} s for each second of the run"),
        ("heights", f"drawn {made.exaggeration:.6g} times as large as lengths, by {made.renderer}"),
    ]
    options.tell(made.as_dict(), lines, quiet, as_json, made.warnings, [made.file])
