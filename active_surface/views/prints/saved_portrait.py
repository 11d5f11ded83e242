"""The portrait of a run that is read from its files."""

from __future__ import annotations

import numpy as np
from matplotlib.tri import CubicTriInterpolator, Triangulation
from scipy.interpolate import CubicHermiteSpline

from active_surface.arrays import FloatArray
from coupling import silent, summary_of
from coupling.case import PlateCase
from coupling.display import most_deflected
from coupling.pictures import Piece, Portrait, Relief, chosen_drives, cut_out, cycles_of, decisive_moment, refined
from coupling.results import SavedRun
from coupling.scene import lifts_of, platform_scene
from meshes import rim_curves
from particle import Samples

BATCH = 64  # steps whose deflections are read together
JUMP = ("vertical_velocity", "normal_force", "friction_force")  # with velocities, where the state changes
BETWEEN = 4  # pieces of a line from one moment to the next


def portrait_of_saved(run: SavedRun) -> Portrait:
    """The portrait of a saved run, with its plate as at the step at which it is deflected the most."""
    plate = run.case.plate
    step = most_deflected(_mean_squares(run))
    platform = None if isinstance(plate, PlateCase) else platform_scene(plate, silent)
    lifts, base = (lifts_of(run.case), ()) if platform is None else (platform.lifts, platform.base)
    measured = platform is not None and bool(platform.fits)
    margins = summary_of(run.summary).margins
    return Portrait(
        run.name,
        run.summary["sentence"],
        run.summary["origin"],
        run.rows,
        samples_of(run),
        run.events,
        np.stack([run.points.min(axis=0), run.points.max(axis=0)]),
        _relief(run, plate, step) if isinstance(plate, PlateCase) else None,
        float(run.time[step]),
        base,
        chosen_drives(run.case, lifts, margins),
        run.margins,
        margins.by_pull_off,
        decisive_moment(run.events, margins),
        () if measured else cycles_of([*lifts, *base]),
        run.complete,
    )


def samples_of(run: SavedRun) -> Samples:
    """All that the files know of the part, with cubics for the places in between."""
    steps = Samples(
        run.time,
        run.position[:, :2],
        run.velocity[:, :2],
        run.velocity[:, 2],
        run.position[:, 2],
        run.normal_force,
        run.friction_force,
        run.state,
    )
    _, chosen = np.unique(np.concatenate([run.rows.time, steps.time]), return_index=True)
    known = Samples(*(np.concatenate(pair)[chosen] for pair in zip(run.rows, steps, strict=True)))
    places = np.arange((len(known.time) - 1) * BETWEEN + 1) / BETWEEN
    before = places.astype(np.int64)
    time = np.interp(places, np.arange(len(known.time)), known.time)
    line = CubicHermiteSpline(known.time, known.position, known.velocity) if len(known.time) > 1 else None
    changes = np.append(known.state[1:] != known.state[:-1], False)[before]
    last = changes & (places % 1 == (BETWEEN - 1) / BETWEEN)
    time[last] = np.nextafter(known.time[before[last] + 1], -np.inf)  # what jumps does so at once

    def between(values: FloatArray) -> FloatArray:
        """Values (k,) at the times in between; before the state changes they are held."""
        column = np.interp(time, known.time, values)
        return np.where(changes, values[before], column)

    columns = {
        "velocity": np.stack([between(values) for values in known.velocity.T], axis=1),
        "height": np.interp(time, known.time, known.height),
        **{name: between(getattr(known, name)) for name in JUMP},
    }
    return Samples(time, line(time) if line else known.position, state=known.state[before], **columns)


def _mean_squares(run: SavedRun) -> FloatArray:
    """The mean square deflection (k,) [m^2] at each step."""
    mean_squares = []
    for start in range(0, len(run.time), BATCH):
        w = run.plate_field("deflection", slice(start, start + BATCH)).astype(float)
        mean_squares.append(np.square(w).mean(axis=1))
    return np.concatenate(mean_squares)


def _relief(run: SavedRun, plate: PlateCase, step: int) -> Relief:
    deflection = run.plate_field("deflection", step).astype(float)

    def within(frame: FloatArray) -> Piece:
        points, triangles, used = cut_out(run.points, run.triangles, frame)
        fine = refined(points, triangles)
        if fine is None:
            return points, triangles, deflection[used]
        between = CubicTriInterpolator(Triangulation(*points.T, triangles), deflection[used], kind="geom")
        w = between(fine.x, fine.y).filled(0.0)
        return np.stack([fine.x, fine.y], axis=1), fine.triangles.astype(np.int64), w

    outline = plate.coarse_mesh.outline
    box = np.stack([run.points.min(axis=0), run.points.max(axis=0)])
    return Relief(box, run.actuators, deflection, within, lambda spacing: rim_curves(outline, spacing))
