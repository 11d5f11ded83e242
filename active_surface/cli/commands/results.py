"""The commands `animate`, `compare`, `export`, `plot`, `rerun` and `view`, which take a result."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import click

from active_surface.cli.command import Answer, argument, command, option
from active_surface.cli.options import FILE, FOLDER, NOT_NEGATIVE, RESULTS, Output, counted, stages
from active_surface.cli.refusal import read

PARTIAL = "The files were not written to the end: the surface is drawn from the steps that they have."


@command
def animate(
    result: Path,
    output: Annotated[Path | None, option("File, or folder of PNG frames [NAME.mp4].", "-o")] = None,
    kind: Annotated[
        Literal["mp4", "gif", "png"] | None, option("Format [that of --output, or mp4].", "--format")
    ] = None,
    camera: Annotated[str, option("iso, top, front, side, or AZIMUTH,ELEVATION [degrees].", show_default=True)] = "iso",
    exaggeration: Annotated[
        float | None, option("How much larger heights are drawn [as they are seen].", "-x", "F")
    ] = None,
    slow_motion: Annotated[
        float | None, option("Seconds of film for each of the run [it lasts about 8 s].", "S")
    ] = None,
    fps: Annotated[float | None, option("Frames a second [30, of a GIF 20].")] = None,
    size: Annotated[str | None, option("Pixels [1280x720, of a GIF 800x450].", "WxH")] = None,
) -> Answer:
    """Make a film of RESULT: the plate's heights, the part and its trail.

    RESULT is a file of a run, finished or partial, or FOLDER/NAME.
    """
    from active_surface.views.film import animate as make

    with counted("frames") as tell:
        made = make(
            result,
            output,
            kind=kind,
            camera=camera,
            fps=fps,
            slow_motion=slow_motion,
            exaggeration=exaggeration,
            size=size,
            tell=tell,
        )
    lasts = f"{made.frames} frames at {made.fps:g} a second, {made.frames / made.fps:.3g} s"
    lines = [
        ("film", f"{lasts}, {made.slow_motion:.6g} s for each second of the run"),
        ("heights", f"drawn {made.exaggeration:.6g} times as large as lengths"),
    ]
    return Answer(made.as_dict(), lines, made.warnings, [made.file])


@command
def compare(a: Path, b: Path, output: Output = RESULTS) -> Answer:
    """Show A and B side by side: what differs in them, where the parts end, and where their paths part.

    Each is a case file, which is run and not written, or a result: a file of a run, or FOLDER/NAME. Draws both into
    NAME_and_NAME.png.
    """
    from coupling import Case, read_run, run_case, stage_count
    from coupling import compare as compared
    from coupling.pictures import draw_run

    found: list[Any] = []
    for name, path in (("a", a), ("b", b)):
        if path.suffix == ".toml":
            found.append(read(path))
            continue
        try:
            found.append(read_run(path))
        except ValueError as error:
            said = str(error).replace("Input path must be", f"Input {name} must be a case file or", 1)
            raise ValueError(said) from None
    cases = [one for one in found if isinstance(one, Case)]
    with stages(sum(stage_count(case) - 1 for case in cases) + 1) as bar:  # no results are written
        comparison = compared(*(run_case(one, None, bar) if isinstance(one, Case) else one for one in found))
        with bar("Drawing"):
            output.mkdir(parents=True, exist_ok=True)
            one, other = (name.partition(",")[0] for name in comparison.names)
            picture = draw_run(comparison, output / f"{one}_and_{other}.png")
    return Answer(comparison.as_dict(), comparison.lines, comparison.warnings, [picture])


@command
def export(
    result: Path,
    form: Annotated[
        Literal["pvd", "xdmf", "vtkhdf", "csv"],
        option(
            "pvd: with a VTU file a step; xdmf: with one HDF5 file; vtkhdf: anew, under their final names; csv: "
            "the path.",
            "--format",
        ),
    ],
    output: Annotated[Path, option("Folder for the files [export].", "-o", type=FOLDER)] = Path("export"),
) -> Answer:
    """Write RESULT in another format, for other programs.

    RESULT is either file of a run, or FOLDER/NAME.
    """
    from coupling.results import export_run, read_run

    saved = read_run(result)
    with stages(1) as bar, bar("Writing the files") as tell:
        files = export_run(saved, output, form, tell)
    whole = saved.complete or form == "csv"
    has = "the path is whole" if whole else f"these are its first {len(saved.time)} steps"
    lines = [] if saved.complete else [("partial", f"The run stopped while it was written: {has}.")]
    return Answer({"complete": whole, "steps": len(saved.time)}, lines, files=files)


@command
def plot(
    result: Annotated[Path, argument(metavar="RESULT|SWEEP")],
    output: Annotated[Path | None, option("Folder for the pictures [the result's].", "-o", type=FOLDER)] = None,
    formats: Annotated[
        tuple[Literal["pdf", "svg", "png"], ...],
        option("Kind of the files; may be given several times [pdf].", "--format"),
    ] = ("pdf",),
    width: Annotated[float, option("Width of each picture in mm [85].", "MM")] = 85.0,
    x: Annotated[
        str | None, option("Of a sweep: the axis that is drawn along x [one of the two longest].", "AXIS")
    ] = None,
    y: Annotated[str | None, option("Of a sweep: the axis that is drawn along y.", "AXIS")] = None,
    value: Annotated[
        str | None, option("Of a sweep: the only column that is drawn [distance and outcome].", "COLUMN")
    ] = None,
) -> Answer:
    """Draw a run or a sweep for print.

    RESULT is either file of a run, or FOLDER/NAME; SWEEP is the netCDF file of a sweep. Each picture has a file of its
    own, as wide as is asked for, with text as text; the captions are printed.
    """
    from active_surface.views.prints import plot as draw

    plotted = draw(result, output, formats, width, x, y, value)
    complete = all(one.complete for one in plotted)
    pictures = [{"files": list(map(str, one.files)), "caption": one.caption} for one in plotted]
    lines = [] if complete else [("partial", PARTIAL)]
    for one in plotted:
        lines += [("wrote", ", ".join(map(str, one.files))), ("", one.caption)]
    return Answer({"complete": complete, "pictures": pictures}, lines)


@command
def rerun(
    result: Path,
    output: Annotated[Path, option("Folder for the new results [rerun].", "-o", type=FOLDER)] = Path("rerun"),
) -> Answer:
    """Run the case that RESULT keeps again, and compare.

    RESULT is either file of a run, or FOLDER/NAME. Exits with 1 when the part ends elsewhere.
    """
    from coupling import rerun, stage_count
    from coupling.results import read_run

    saved = read_run(result)
    with stages(stage_count(saved.case)) as bar:
        done = rerun(saved, output, bar)
    x, y = (1e6 * place for place in done.result.summary.end_position)
    same = "the same, bit for bit" if done.same_end else f"{done.moved * 1e6:.3g} um from that of the result"
    changed = [f"{name} {now} in place of {then}" for name, (then, now) in done.changed.items()]
    partial = ("partial", "The files lack the last steps; the case and the end point are complete.")
    lines = [
        *([] if saved.complete else [partial]),
        ("end", f"({x:.4f}, {y:.4f}) um at {done.result.summary.end_time * 1e3:.4f} ms: {same}"),
        ("versions", "; ".join(changed) or "the same"),
    ]
    figures = {"same_end": done.same_end, "moved": done.moved, "versions": done.changed, "complete": saved.complete}
    return Answer(figures, lines, files=done.result.files, code=0 if done.same_end else 1)


@command
def view(
    result: Path,
    output: Annotated[Path | None, option("The page [NAME.html beside the result].", "-o", type=FILE)] = None,
    paths: Annotated[
        int | None, option("Paths of a sweep to have in the page [about a minute's].", type=NOT_NEGATIVE)
    ] = None,
    opened: Annotated[bool, option("Open the page in the browser.", "--open")] = False,
) -> Answer:
    """Write RESULT as one HTML page that works offline.

    RESULT is a file of a run, finished or partial, FOLDER/NAME, or the netCDF file of a sweep. A case or study file
    stands for its results in `results/` or beside it.
    """
    from active_surface.views import result_of
    from coupling import check_folder

    if output is not None and output.suffix.lower() != ".html":
        raise ValueError(f"Input output must end in .html; got {output}")
    found = result_of(result, RESULTS)
    page = output or found.page
    check_folder(page.parent)
    warnings: list[str] = []
    if found.is_sweep:
        from active_surface.studies import read_study, read_sweep
        from active_surface.views.pages import write_study_page

        study, dataset = read_sweep(found.path, None if found.study is None else read_study(found.study))
        with dataset, counted("paths") as tell:
            page.parent.mkdir(parents=True, exist_ok=True)
            write_study_page(study, dataset, page, paths, tell)
    elif paths is not None:
        raise ValueError(f"Input paths must not be given for a run; got {result}")
    else:
        from active_surface.views import is_of
        from active_surface.views.pages import PARTIAL, write_run_page
        from coupling.results import read_runs

        runs = read_runs(found.path)
        if result.suffix == ".toml" and not all(is_of(run, result) for run in runs):
            warnings.append(f"{found.path} is of another case than {result} is now: `active-surface run {result}`")
        if not all(run.complete for run in runs):
            warnings.append(PARTIAL)
        page.parent.mkdir(parents=True, exist_ok=True)
        write_run_page(runs[0], page, runs[1:])
    if opened:
        click.launch(page.absolute().as_uri())
    size = page.stat().st_size
    return Answer({"bytes": size}, [("page", f"{size / 1e6:.1f} MB, works offline")], warnings, [page])
