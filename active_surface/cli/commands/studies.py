"""The commands `sweep`, `feasibility`, `drift` and `response`: many runs, or all frequencies of a plate."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from active_surface.cli.command import Answer, command, option
from active_surface.cli.options import (
    POSITIVE,
    RESULTS,
    Output,
    Threads,
    amount_of,
    counted,
    place_of,
    point_of,
    stages,
)
from active_surface.cli.refusal import check_kind, read

STAGES = 3  # of the feasibility of a plate that only bends, without areas
PICKING = 4  # more of a pick and its run
RESPONDING = 2  # of a response


@command
def sweep(
    study: Path,
    output: Output = RESULTS,
    threads: Threads = None,
    scheduler: Annotated[
        str | None, option("Address of a dask scheduler whose workers find the paths, tcp://HOST:PORT.", "-s")
    ] = None,
    overwrite: Annotated[bool, option("Replace the results of another study of this name.")] = False,
) -> Answer:
    """Find the paths at all points of STUDY and write them to one file.

    A sweep that was interrupted goes on where it stopped when it is started again, and a study that has grown keeps the
    paths that its results have. Exits with 1 when every point was refused.
    """
    if scheduler is not None and threads is not None:
        raise ValueError("--threads must not be given with --scheduler: each worker uses all of its own threads")
    from active_surface.studies import REFUSED, figures, lines, read_study, run_study

    check_kind(study, "study")
    points = read_study(study)
    try:
        with counted("paths") as tell:
            result = run_study(points, output, threads, tell, scheduler, overwrite)
    except KeyboardInterrupt:
        raise KeyboardInterrupt("interrupted; the same command goes on where this one stopped") from None
    code = int(set(result.outcomes) == {REFUSED})
    return Answer(figures(result), lines(result), result.warnings, code=code)


@command
def feasibility(
    case: Path,
    lowest: Annotated[str | None, option('Lowest frequency of the fastest drive, such as "100 Hz".', "F")] = None,
    highest: Annotated[str | None, option("Highest frequency of the fastest drive.", "F")] = None,
    smallest: Annotated[
        str | None, option('Smallest stroke of the largest drive, such as "2 um"; of forces in N.', "S")
    ] = None,
    largest: Annotated[str | None, option("Largest stroke of the largest drive.", "S")] = None,
    areas: Annotated[bool, option("Also find where on the plate the part slips, over frequency.", "--areas")] = False,
    across: Annotated[int | None, option("Places along the plate's longer side, of --areas [100].")] = None,
    pick: Annotated[
        str | None, option('Write a case that moves: at "2.4 kHz, 12 um", or at the "best" point.', "F,S")
    ] = None,
    overwrite: Annotated[bool, option("Replace a case that was picked before.")] = False,
    threads: Threads = None,
    output: Output = RESULTS,
) -> Answer:
    """Show at which frequencies and strokes, and where, the array of CASE moves its part without losing it.

    Writes a map over frequency and stroke of runs from the case's start; --areas adds a map of the plate, and the area
    where slip starts while the part stays attached, over the drives' frequency. All drives keep their ratios. --pick
    also writes NAME_picked.toml, a case whose run moves the part.
    """
    if across is not None and not areas:
        raise ValueError("--across must not be given without --areas, whose places it counts")
    parsed = read(case)
    from active_surface.studies.feasibility import ACROSS, lines, warnings
    from active_surface.studies.feasibility import feasibility as find
    from active_surface.studies.feasibility import pick as pick_case
    from coupling import answers_drives, check_free
    from coupling.case import largest_stroke, write_edited

    unit = largest_stroke(parsed)[1]
    ends = amount_of(lowest, "Hz", "--lowest"), amount_of(highest, "Hz", "--highest")
    strokes = amount_of(smallest, unit, "--smallest"), amount_of(largest, unit, "--largest")
    point = None if pick is None else point_of(pick, unit, "--pick")
    target = output / f"{parsed.name}_picked.toml"
    if pick is not None:
        check_free([target], overwrite)
    answers = answers_drives(parsed)
    count = STAGES + areas + answers + (PICKING + (point == ()) + answers if pick is not None else 0)
    with stages(count) as bar:
        result = find(parsed, *ends, ACROSS if across is None else across, bar, *strokes, threads, areas)
        files = result.write(output, point or None)
        picked = None
        if point is not None:
            frequency, stroke = point or (None, None)
            picked = pick_case(result, frequency, stroke, threads, bar)
            if not point:  # the best one was not known
                files = result.write(output, (picked.frequency, picked.stroke))
            files = (*files, write_edited(picked.case, parsed, case.absolute().parent, target, picked.text))
    figures = result.figures() | {"picked": None if picked is None else picked.figures()}
    rows = lines(figures) + ([] if picked is None else [("picked", picked.text)])
    return Answer(figures, rows, warnings(figures), files)


@command
def drift(
    case: Path,
    groups: Annotated[
        str, option("Actuators that run at a time: all, or each of the columns, rows, or actuators (each).", "--groups")
    ] = "all",
    across: Annotated[int | None, option("Places along the plate's longer side [32].", type=POSITIVE)] = None,
    threads: Threads = None,
    output: Output = RESULTS,
) -> Answer:
    """Show where the drives of CASE carry its part from everywhere on the plate, and where it ends.

    Follows the part from rest at each place over one period of the drives, and from there on by the map of these; says
    how far runs end from that. Writes NAME.drift.nc, NAME.drift.png and the page NAME.drift.html.
    """
    parsed = read(case)
    from active_surface.studies.drifts import ACROSS, STAGES, running_groups
    from active_surface.studies.drifts import drift as find
    from active_surface.views import write_drift_page

    with stages(STAGES * len(running_groups(parsed, groups))) as bar:
        found = find(parsed, groups, ACROSS if across is None else across, threads, bar)
        files = *found.write(output), write_drift_page(found, output / f"{found.case.name}.drift.html")
    return Answer(found.figures(), found.lines(), found.warnings(), files)


@command
def response(
    case: Path,
    points: Annotated[
        tuple[str, ...],
        option('Point of the plate, such as "100 um, 50 um"; again for more [the part\'s start].', "--point", "X,Y"),
    ] = (),
    lowest: Annotated[
        str | None, option('Lowest frequency, such as "1 kHz" [1/20 of the first resonance].', "F")
    ] = None,
    highest: Annotated[str | None, option("Highest frequency [five times the first resonance].", "F")] = None,
    output: Output = RESULTS,
) -> Answer:
    """Show how far points of the plate of CASE follow its actuators, over frequency.

    Writes amplitude and phase of each point for each actuator, with resonances marked, as NAME.response.nc and
    NAME.response.png.
    """
    parsed = read(case, True)
    from active_surface.studies.response import response as find

    ends = amount_of(lowest, "Hz", "--lowest"), amount_of(highest, "Hz", "--highest")
    places = [place_of(text, "--point") for text in points] or None
    with stages(RESPONDING) as bar:
        found = find(parsed, places, None, *ends, bar)
        files = found.write(output)
    return Answer(found.figures(), found.lines(), files=files)
