"""Paths over a stretching plate's reduced model, beside the same with a full solution at every time node.

    .venv/bin/python benchmarks/stretched_paths.py          writes a table for docs/large-deflection.md
    .venv/bin/python benchmarks/stretched_paths.py 0 1      only prints these rows of it

The reduced model follows its drives in quintics between time nodes. At each node the full plate is solved as well, with
exact first and second derivatives. What the two differ by is laid in quintics of its own, in shapes that hold it to
1e-9 of w. So one surface, on one set of cells, is the model or the full plate by the drives of these shapes, and ten
parts start on both. Times are over those of one full solution, or of a path of 20 ms over the linear plate.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from statistics import median
from time import process_time

import numpy as np
import report
from numpy.typing import NDArray
from stretched_nodes import Nodes
from threadpoolctl import threadpool_limits

from coupling import surface_motion
from coupling.stretch import Stretch, StretchModel, make_model
from coupling.stretch.store import FOLDER
from fem_plate import Plate, PlateSection, StretchedShapes
from fem_plate.large_deflection import Columns
from meshes import disc
from particle import AnyDrive, CoulombAdhesion, Drive, Micropart, SurfaceMotion, Trajectory, simulate

FloatArray = NDArray[np.float64]

RADIUS, THICKNESS, END = 500e-6, 5e-6, 20e-3  # m, m, s
TWO = RADIUS * np.array([[0.3, 0.1], [-0.25, -0.35]])
LATTICE = RADIUS * np.stack(np.meshgrid(*[np.linspace(-0.5, 0.5, 5)] * 2), axis=-1).reshape(-1, 2)
MASS, CENTRE_HEIGHT, COEFFICIENT = 2e-9, 45e-6, 0.05  # kg, m
STARTS, FARTHEST = 10, 0.6  # of the radius
SURFACE, PATH = 1e-10, 1e-10  # tolerances
SAMPLES, AWAY = 1500, 0.02  # of the radius, from actuators
REPEATS = 20
MOVED = 1e-7  # m: paths shorter than this are not compared


@dataclass(frozen=True, eq=False)
class Layout:
    """Actuators, how high they go and how hard they hold a part."""

    name: str
    points: FloatArray  # (N, 2) m
    drives: list[AnyDrive]
    adhesion: float  # N

    @cached_property
    def plate(self) -> Plate:
        return Plate(disc(RADIUS, RADIUS / 4), PlateSection(169e9, 0.3, THICKNESS))

    @cached_property
    def model(self) -> StretchModel:
        """The reduced model."""
        return make_model(self.plate.large_deflection(self.points), [self.drives], END, lambda done, of: None)


def layouts() -> list[Layout]:
    def two(scale: float, adhesion: float) -> Layout:
        drives: list[AnyDrive] = [Drive(scale * THICKNESS, frequency, "up-down") for frequency in (300.0, 400.0)]
        return Layout(f"two actuators, {scale:g} t", TWO, drives, adhesion)

    wave: list[AnyDrive] = [Drive(THICKNESS, 300.0, "up-down", delay=k % 5 / 5 / 300.0) for k in range(len(LATTICE))]
    return [
        two(1, 2e-8),
        two(3, 1e-7),
        two(10, 5e-7),
        two(30, 3e-6),
        Layout("25 actuators, 1 t", LATTICE, wave, 4e-8),
    ]


def samples(points: FloatArray) -> FloatArray:
    """Points (n, 2) [m] all over the plate, off the actuators."""
    xy = RADIUS * np.random.default_rng(0).uniform(-1, 1, (SAMPLES, 2))
    clear = np.hypot(*(xy[:, None] - points).T).min(axis=0) > AWAY * RADIUS
    return xy[clear & (np.hypot(*xy.T) < 0.999 * RADIUS)]


def starts() -> FloatArray:
    """Places (STARTS, 2) [m], spread evenly."""
    k = np.arange(STARTS)
    radius, angle = FARTHEST * RADIUS * np.sqrt((k + 0.5) / STARTS), k * np.pi * (3 - 5**0.5)
    return radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def surfaces(layout: Layout, nodes: Nodes) -> tuple[SurfaceMotion, SurfaceMotion]:
    """The model's surface and the full plate's, on the same cells."""
    model, corrections = layout.model, nodes.corrections
    plain, reduction = model.shapes, model.reduction
    both = replace(
        reduction,
        corrections=Columns.joined([reduction.corrections, nodes.shapes]),
        motions=np.concatenate([reduction.motions, nodes.motions], axis=1),
    )
    stroke = np.abs(model.heights).max()
    further = 10 * stroke / np.abs(nodes.coefficients[:, ::3]).max(axis=1)
    own = np.abs(nodes.motion_coefficients[:, ::3]).max(axis=1)
    in_plane = plain.in_plane_heights()
    in_plane = np.append(in_plane, (in_plane * model.largest[1]).max() / own)
    shapes = StretchedShapes(both, plain.points, plain.springs, np.append(plain.own_heights(), further), in_plane)
    shapes.truncation_error = 0.0
    drives, planar = nodes.drives(nodes.coefficients), nodes.drives(nodes.motion_coefficients)
    full = surface_motion(
        shapes,
        [*layout.drives, *corrections.drives, *drives],
        SURFACE,
        THICKNESS / 2,
        [*corrections.in_plane, *planar],
    )
    still, still_planar = nodes.drives(0 * nodes.coefficients), nodes.drives(0 * nodes.motion_coefficients)
    return full.driven_by([*layout.drives, *corrections.drives, *still], [*corrections.in_plane, *still_planar]), full


def path(layout: Layout, surface: SurfaceMotion, start: FloatArray) -> Trajectory:
    part = Micropart(MASS, (float(start[0]), float(start[1])), centre_height=CENTRE_HEIGHT)
    return simulate(surface, part, CoulombAdhesion(COEFFICIENT, layout.adhesion), END, tolerance=PATH)


def seconds(work: Callable[[], object], repeats: int = 1) -> float:
    begin = process_time()
    for _ in range(repeats):
        work()
    return (process_time() - begin) / repeats


def row(layout: Layout) -> dict[str, str]:
    """One line of the table, by its heads."""
    offline = seconds(lambda: layout.model)
    model, reduction = layout.model, layout.model.reduction
    corrections = model.corrections(layout.drives, END)
    nodes = Nodes(reduction, layout.drives, corrections, samples(layout.points))
    surfaces_of_both = surfaces(layout, nodes)
    nodes.check(surfaces_of_both[1], layout.name)
    shipped = Stretch(model, layout.drives, corrections, END).surface(1e-8, THICKNESS / 2)
    linear = surface_motion(layout.plate.influence(layout.points), layout.drives, 1e-8, THICKNESS / 2)
    ends, lengths, losses = [], [], 0
    for start in starts():
        paths = [path(layout, surface, start) for surface in (*surfaces_of_both, shipped)]
        ends.append([one.position[-1] for one in paths])
        lengths.append(paths[1].path_length)
        losses += paths[1].time[-1] < END
        path(layout, linear, start)  # makes the cells that are timed below
    off, length = np.array(ends), np.array(lengths)
    moved = length > MOVED
    gaps = [np.linalg.norm(off[:, k] - off[:, 1], axis=1)[moved] / length[moved] for k in (0, 2)]
    full = median(seconds(lambda at=at: nodes.full.solve(nodes.strokes(at)[0])) for at in nodes.edges[1:-1:16])
    unit = seconds(lambda: [path(layout, linear, start) for start in starts()]) / STARTS
    schedule = seconds(lambda: model.corrections(layout.drives, END), REPEATS)
    errors = nodes.errors()
    print(
        f"{layout.name}: {nodes.shapes.v.shape[1]} further shapes, {nodes.motions.shape[1]} motions; "
        f"paths of {1e6 * length[moved].min():.1f} to {1e6 * length.max():.1f} um, {moved.sum()} move, {losses} lost; "
        f"errors of w_tt {errors[2]:.1e} and its gradient {errors[3]:.1e}; time pieces {corrections.error:.1e}, mesh "
        f"{model.mesh_error:.1e}; full solution {full:.2f} s, linear path {1e3 * unit:.1f} ms",
        flush=True,
    )
    return {
        "": layout.name,
        "full solutions": f"{reduction.solutions}",
        "corrections": f"{len(reduction.plate.stiffness)}",
        "$N_r$": f"{len(reduction.plate.membrane)}",
        "$U_m$": f"{reduction.motions.shape[1]}",
        "error, held out": f"{reduction.error:.1e}",
        "nodes": f"{len(nodes.edges) - 1}",
        "w at nodes": f"{errors[0]:.1e}",
        "gradient": f"{errors[1]:.1e}",
        "ends: largest, median": f"{gaps[0].max():.1e}, {np.median(gaps[0]):.1e}",
        "the same, own cells": f"{gaps[1].max():.1e}, {np.median(gaps[1]):.1e}",
        "offline": f"{offline / full:.0f}",
        "online": f"{schedule / unit:.2f}",
        "an equilibrium faster by": f"{full / (schedule / corrections.equilibria):.0f}",
    }


def main() -> None:
    os.environ[FOLDER] = ""  # the model is to be made here
    chosen = [layouts()[int(number)] for number in sys.argv[1:]] or layouts()
    lines: list[str] = []
    with threadpool_limits(1, "blas"):
        for layout in chosen:
            cells = row(layout)
            lines.append(f"| {' | '.join(cells.values())} |")
            print(lines[-1], flush=True)
    if not sys.argv[1:]:
        lines = [f"|{' | '.join(cells)} |", "|---" + "|---:" * (len(cells) - 1) + "|", *lines]
        report.write("stretched paths", lines, report.DOCS / "large-deflection.md")


if __name__ == "__main__":
    main()
