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
from full_solutions import FullSolutions, Node
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from coupling import surface_motion
from coupling.stretch import Corrections, Stretch, StretchModel, make_model
from coupling.stretch.store import FOLDER
from fem_plate import Plate, PlateSection, StretchedShapes
from fem_plate.large_deflection import Columns
from fem_plate.large_deflection.snapshots import bending_products
from meshes import disc
from particle import AnyDrive, CoulombAdhesion, Drive, Micropart, SurfaceMotion, Trajectory, simulate
from particle.drives import QuinticDrive, quintic_drives

FloatArray = NDArray[np.float64]

RADIUS, THICKNESS, END = 500e-6, 5e-6, 20e-3  # m, m, s
TWO = RADIUS * np.array([[0.3, 0.1], [-0.25, -0.35]])
LATTICE = RADIUS * np.stack(np.meshgrid(*[np.linspace(-0.5, 0.5, 5)] * 2), axis=-1).reshape(-1, 2)
MASS, CENTRE_HEIGHT, COEFFICIENT = 2e-9, 45e-6, 0.05  # kg, m
STARTS, FARTHEST = 10, 0.6  # of the radius
SURFACE, PATH = 1e-10, 1e-10  # tolerances
EXACT = 1e-9  # of w: differences of less are left out
SAMPLES, AWAY = 1500, 0.02  # of the radius, from actuators
STEP, AGREEMENT = 2e-3, 1e-4  # of a stroke's time, of differences that the derivatives must agree with
CELLS = 3e-3  # what cells may smooth of a gradient: it is as exact as that on the mesh at 30 t
REPEATS = 20
AT_REST = 1e-12  # of the thickness
MOVED = 1e-7  # m: paths shorter than this are not compared
HEADS = (
    " full solutions ",
    " corrections ",
    " $N_r$ ",
    " $U_m$ ",
    " error, held out ",
    " nodes ",
    " w at nodes ",
    " gradient ",
    " ends: largest, median ",
    " the same, own cells ",
    " offline ",
    " online ",
    " an equilibrium faster by ",
)


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


class Nodes:
    """The full plate at the time nodes of a model's corrections, and what it differs from the model by."""

    def __init__(self, layout: Layout, corrections: Corrections) -> None:
        self.layout, self.reduction, self.corrections = layout, layout.model.reduction, corrections
        self.full = FullSolutions(self.reduction.discrete)
        pieces = corrections.drives[0].segments()
        assert corrections.period is not None and pieces.tail == 0
        self.edges = np.append(pieces.start, pieces.start[-1] + pieces.scale[-1]) - pieces.start[0]
        self.pace, self.loop = corrections.drives[0].stroke_time, pieces.lead
        nodes = [self.node(self.edges[k], self.modelled(k)[0]) for k in range(len(pieces.start))]
        self.nodes = [*nodes, nodes[self.loop]]
        self._solve_for_differences()

    def strokes(self, time: float) -> FloatArray:
        """The strokes (3, N) over the thickness, and their derivatives in times of the pace."""
        rows = np.array([drive.evaluate(time) for drive in self.layout.drives])
        return rows.T * self.pace ** np.arange(3)[:, None] / THICKNESS

    def modelled(self, k: int) -> tuple[FloatArray, FloatArray]:
        """The model's corrections (n, 3) and in-plane motions (M, 3) at a node, dimensionless likewise."""
        k = k if k + 1 < len(self.edges) else self.loop
        unit = self.pace / (self.edges[k + 1] - self.edges[k])
        factors = np.array([1.0, unit, 2 * unit**2])
        sets = self.corrections.drives, self.corrections.in_plane
        c, g = (np.array([drive.segments().coefficients[k, :3] for drive in drives]) * factors for drives in sets)
        return c / THICKNESS, g / self.reduction.discrete.motion_unit

    def node(self, time: float, c: FloatArray) -> Node:
        """The full plate at a time, from the model's corrections (n, 3)."""
        strokes = self.strokes(time)
        if np.abs(strokes[0]).max() < AT_REST:  # what Newton's method changes is relative to w
            return self.full.node(strokes * [[0], [1], [1]], None)
        near = self._model_columns(strokes, c)
        start = self.full.equilibrium.at(near.v[:, 0], near.extra[:, 0], 0.0)
        return self.full.node(strokes, start)

    def _model_columns(self, strokes: FloatArray, c: FloatArray) -> Columns:
        linear, own = self.reduction.linear.weighted(strokes.T), self.reduction.corrections.weighted(c)
        return Columns(linear.v + own.v, linear.extra + own.extra)

    def _solve_for_differences(self) -> None:
        """Shapes of what the full plate and its model differ by, and their quintics."""
        discrete, w, u = self.reduction.discrete, [], []
        for k, node in enumerate(self.nodes):
            c, g = self.modelled(k)
            model = self._model_columns(self.strokes(self.edges[k]), c)
            w.append(Columns(node.w.v - model.v, node.w.extra - model.extra))
            u.append(node.u - self.reduction.motions @ g)
        self.differences, motions = Columns.joined(w), np.concatenate(u, axis=1)
        stiffness = discrete.plane_stress.membrane.stiffness
        full = np.concatenate([node.u for node in self.nodes], axis=1)
        everything = Columns.joined([node.w for node in self.nodes])
        largest = np.sqrt(np.diag(bending_products(discrete, everything)).max())
        weights, coefficients = _leading(bending_products(discrete, self.differences), EXACT * largest)
        self.shapes = self.differences.weighted(weights)
        self.coefficients = coefficients * THICKNESS
        largest = np.sqrt(np.einsum("ij,ij->j", full, stiffness @ full).max())
        weights, coefficients = _leading(motions.T @ (stiffness @ motions), EXACT * largest)
        self.motions = motions @ weights
        self.motion_coefficients = coefficients * discrete.motion_unit

    def drives(self, coefficients: FloatArray) -> list[QuinticDrive]:
        """Quintics (m) through coefficients (m, 3 nodes) with their derivatives."""
        length = np.diff(self.edges)[None] / self.pace
        x, x_t, x_tt = coefficients.reshape(len(coefficients), -1, 3).transpose(2, 0, 1)
        rise, v = np.diff(x, axis=1), (x_t[:, :-1] * length, x_t[:, 1:] * length)
        a = x_tt[:, :-1] * length**2, x_tt[:, 1:] * length**2
        rows = [
            x[:, :-1],
            v[0],
            a[0] / 2,
            10 * rise - 6 * v[0] - 4 * v[1] - 1.5 * a[0] + 0.5 * a[1],
            -15 * rise + 8 * v[0] + 7 * v[1] + 1.5 * a[0] - a[1],
            6 * rise - 3 * v[0] - 3 * v[1] - 0.5 * a[0] + 0.5 * a[1],
        ]
        like = self.corrections.drives[0]
        return quintic_drives(
            self.edges, np.stack(rows, axis=2), self.loop, like.stroke_time, like.frequency, np.zeros(len(x))
        )

    def errors(self) -> FloatArray:
        """The model's largest errors of w, of its gradient, of w_tt and of grad w_tt, each over the largest."""
        trial, x = self.reduction.discrete.trial, samples(self.layout.points) / RADIUS
        found = []
        for columns in (self.differences, Columns.joined([node.w for node in self.nodes])):
            w, gradient, _ = trial.functions(*columns).evaluate(x)
            found.append([np.abs(rows[:, order::3]).max() for order in (0, 2) for rows in (w, gradient)])
        return np.array(found[0]) / found[1]

    def check(self, surface: SurfaceMotion) -> None:
        """The derivatives are those of differences, and a surface is the full plate at a node."""
        k = len(self.edges) // 3
        middle, step = (self.edges[k] + self.edges[k + 1]) / 2, STEP * self.pace  # no breakpoint of a drive
        before, now, after = (self.node(time, self._near(time)) for time in (middle - step, middle, middle + step))
        trial, xy = self.reduction.discrete.trial, samples(self.layout.points)
        heights = [trial.functions(*node.w).values(xy / RADIUS) for node in (before, now, after)]
        for order in (1, 2):
            change = (heights[2] - heights[0])[:, order - 1] / (2 * STEP)
            off = np.abs(change - heights[1][:, order]).max() / np.abs(change).max()
            assert off < AGREEMENT, f"derivative {order} is off by {off:.1e}"
        w, gradient, _ = trial.functions(*self.nodes[k].w).evaluate(xy / RADIUS)
        state = surface.evaluate(xy, self.edges[k])
        for name, bound, one, other in (
            ("w", AGREEMENT, state.w, THICKNESS * w[:, 0]),
            ("the gradient", CELLS, state.gradient, THICKNESS / RADIUS * gradient[:, 0]),
            ("w_tt", CELLS, state.w_tt, THICKNESS / self.pace**2 * w[:, 2]),
        ):
            off = float(np.abs(one - other).max() / np.abs(other).max())
            print(f"{self.layout.name}: cells are off by {off:.1e} of {name}", flush=True)
            assert off < bound, f"{name} of the full plate's surface is off by {off:.1e}"

    def _near(self, time: float) -> FloatArray:
        """The model's corrections (n, 3) at any time, but for derivatives."""
        values = np.array([drive.evaluate(time)[0] for drive in self.corrections.drives]) / THICKNESS
        return values[:, None] * np.eye(1, 3)


def _leading(products: FloatArray, least: float) -> tuple[FloatArray, FloatArray]:
    """What combines k functions into orthonormal leading ones (k, m), and these' coefficients (m, k) in them."""
    squares, directions = np.linalg.eigh(products)
    kept = squares > least**2
    kept[-1] = True
    weights = directions[:, kept] / np.sqrt(squares[kept])
    return weights, weights.T @ products


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


def row(layout: Layout) -> str:
    """One line of the table."""
    offline = seconds(lambda: layout.model)
    model, reduction = layout.model, layout.model.reduction
    corrections = model.corrections(layout.drives, END)
    nodes = Nodes(layout, corrections)
    surfaces_of_both = surfaces(layout, nodes)
    nodes.check(surfaces_of_both[1])
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
    cells = [
        layout.name,
        reduction.solutions,
        len(reduction.plate.stiffness),
        len(reduction.plate.membrane),
        reduction.motions.shape[1],
        f"{reduction.error:.1e}",
        len(nodes.edges) - 1,
        f"{errors[0]:.1e}",
        f"{errors[1]:.1e}",
        *(f"{gap.max():.1e}, {np.median(gap):.1e}" for gap in gaps),
        f"{offline / full:.0f}",
        f"{schedule / unit:.2f}",
        f"{full / (schedule / corrections.equilibria):.0f}",
    ]
    return f"| {' | '.join(map(str, cells))} |"


def main() -> None:
    os.environ[FOLDER] = ""  # the model is to be made here
    chosen = [layouts()[int(number)] for number in sys.argv[1:]] or layouts()
    heads = "|".join(HEADS)
    lines = [f"| |{heads}|", "|---" + "|---:" * len(HEADS) + "|"]
    with threadpool_limits(1, "blas"):
        for layout in chosen:
            lines.append(row(layout))
            print(lines[-1], flush=True)
    if not sys.argv[1:]:
        report.write("stretched paths", lines, report.DOCS / "large-deflection.md")


if __name__ == "__main__":
    main()
