"""Trials: the paths of cases with many values of their parameters, and how far they are from their tracks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from copy import copy
from threading import Event
from typing import Final, Literal, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from active_surface.arrays import BoolArray, FloatArray
from active_surface.identification.parameters import case_with
from active_surface.identification.track import Track
from active_surface.parameter import Parameter
from coupling import PathTask, ProgressCallback, build_friction, build_part, follow
from coupling.case import Case
from particle import Body, Micropart, SurfaceMotion, Trajectory, interruptible, processors
from particle.friction import Contact
from particle.surface import rim_gap

Loss = Literal["squares", "absolute"]
Item = TypeVar("Item")
Found = TypeVar("Found")

MIDDLE: Final = 0.15  # on both sides of the median: the residuals from which their density there is estimated
NEGLIGIBLE: Final = 1e-2  # of a cost that one residual adds: less is no progress
EXACT: Final = 1e-12  # m: what is nearer cannot be distinguished from a path
NEAR_MEDIAN: Final = 1e-2  # of the median distance: nearer places weigh no more
REMEMBERED: Final = 400  # paths of a track


class Trial(NamedTuple):
    """The paths of all cases with one set of values, beside their tracks."""

    shares: FloatArray  # (n,) of the parameters' bounds
    residuals: FloatArray  # (m,) m, paths minus tracks
    cost: float  # m^2 or m; inf where a case cannot be run


class Recording(NamedTuple):
    """One track, with the case whose path it is."""

    case: Case
    surface: SurfaceMotion
    track: Track
    parameters: Sequence[Parameter]  # shared, then own


class Trials:
    """N tracks with m residuals in all, and n parameters: those shared, then track by track its own.

    Where residuals are normal, or of Laplace's distribution, with one unknown deviation for each track, their
    likelihood is greatest where the sum of freedom x log(loss) over tracks is least. The cost is the exponential of
    that over all freedom: the loss of one track, a geometric mean of several. So near the optimum a track counts by its
    own noise.
    """

    def __init__(self, recordings: Sequence[Recording], shared: int, loss: Loss, threads: int | None) -> None:
        self.recordings, self.shared, self.loss, self._threads = list(recordings), shared, loss, threads
        tracks, slots = len(recordings), len(recordings[0].parameters)
        sizes = np.array([one.track.measured.sum() for one in recordings])
        ends = np.cumsum(sizes).tolist()
        self.size = ends[-1]  # m
        self.rows = [slice(end - size, end) for end, size in zip(ends, sizes.tolist(), strict=True)]  # of each track
        own = shared + np.arange(tracks * (slots - shared)).reshape(tracks, -1)
        # (N, s) the number of the parameter in each slot of a track
        self.columns: NDArray[np.intp] = np.hstack([np.tile(np.arange(shared), (tracks, 1)), own]).astype(np.intp)
        self.count = int(self.columns.max()) + 1  # n
        self.several = tracks > 1 and slots > shared  # whether any track has fields that others lack
        # (N,): own fields take theirs from residuals, shared ones in proportion to places
        self.freedom: FloatArray = sizes - (slots - shared) - shared * sizes / self.size
        self.seen: list[tuple[FloatArray, float]] = []  # shares and costs of all that were followed
        self.best = Trial(np.zeros(self.count), np.zeros(self.size), np.inf)
        self.followed = 0  # paths
        self.refusal = ""  # why a case could not be run
        self._stop = Event()
        self._known: list[dict[bytes, FloatArray]] = [{} for _ in recordings]

    def of(self, rows: FloatArray) -> list[Trial]:
        """Trials at shares (k, n), followed side by side."""
        rows = (1 + rows) - 1  # multiples of the spacing of numbers above 1, as which the search counts them
        away = [self._tried(number, rows[:, own]) for number, own in enumerate(self.columns)]
        found = [Trial(np.array(row), one, self.cost(one)) for row, one in zip(rows, np.hstack(away), strict=True)]
        self.seen += [(trial.shares, trial.cost) for trial in found]
        self.best = min([self.best, *found], key=lambda trial: trial.cost)
        return found

    def side_by_side(
        self, work: Callable[[Trials, Item], Found], items: Sequence[Item], tell: ProgressCallback
    ) -> list[Found]:
        """What work(trials, item) gives for each item, on threads: each knows the trials so far and its own alone.

        So the result is the same for any number of threads.  tell: gets how many are done.
        """
        branches, known, stop = [copy(self) for _ in items], len(self.seen), Event()
        for branch in branches:
            branch.seen, branch.followed, branch._threads, branch._stop = list(self.seen), 0, 1, stop
            branch._known = [dict(own) for own in self._known]
        pool = ThreadPoolExecutor(self._threads or processors())
        found: list[Found] = []

        def gather() -> None:
            for one in pool.map(work, branches, items):
                found.append(one)
                tell(len(found), len(items))

        try:
            interruptible(gather)
        finally:
            stop.set()
            pool.shutdown(wait=False, cancel_futures=True)
        for branch in branches:
            self.seen += branch.seen[known:]
            self.followed += branch.followed
        self.best = min([self, *branches], key=lambda one: one.best.cost).best
        return found

    def slopes(self, trial: Trial, width: float | FloatArray, free: BoolArray) -> FloatArray:
        """The derivatives (m, n) of residuals at a trial, by differences over a width of the bounds.

        Own fields of all tracks change together, as none of them acts on another's track. 0 of parameters that are not
        free (n,), and where a case cannot be run.
        """
        step = np.where(trial.shares < 0.5, width, -np.asarray(width)) * free
        slots = self.columns[:, free[self.columns].any(axis=0)]
        rows, slope = np.tile(trial.shares, (slots.shape[1], 1)), np.zeros((self.size, self.count))
        for row, slot in zip(rows, slots.T, strict=True):
            row[slot] += step[slot]
        others = self.of(rows)
        for columns, track in zip(slots, self.rows, strict=True):
            for column, other in zip(columns, others, strict=True):
                change = other.residuals[track] - trial.residuals[track]
                if free[column] and np.isfinite(change).all():
                    slope[track, column] = change / (other.shares[column] - trial.shares[column])
        return slope

    def paths(self, number: int, runs: Sequence[tuple[Micropart | Body, Contact]]) -> list[Trajectory]:
        """The paths of parts with their friction, until a track ends."""
        case, surface, track, _ = self.recordings[number]
        if self._stop.is_set():
            raise KeyboardInterrupt
        self.followed += len(runs)
        run = case.run.model_copy(update={"duration": float(track.time[-1])})
        return follow([PathTask(surface, part, law, run) for part, law in runs], self._threads)

    def losses(self, residuals: FloatArray) -> FloatArray:
        """Of each track (N,), m^2 or m."""
        sizes, least = (residuals**2, EXACT**2) if self.loss == "squares" else (np.abs(residuals), EXACT)
        return np.array([max(float(sizes[rows].sum()), least) for rows in self.rows])

    def cost(self, residuals: FloatArray) -> float:
        """Of residuals (m,)."""
        return float(np.exp(self.freedom @ np.log(self.losses(residuals)) / self.freedom.sum()))

    def robust(self, squares: FloatArray) -> FloatArray:
        """The cost of squares (m,) of residuals, spread over them, with its slopes (3, m): a `loss` of `least_squares`.

        Without curvature, so that steps are those of least squares with the slopes as weights.
        """
        size = np.sqrt(squares)
        cost, rho = self.cost(size), np.zeros((3, self.size))
        rho[0] = cost / self.size
        for rows, loss, freedom in zip(self.rows, self.losses(size), self.freedom / self.freedom.sum(), strict=True):
            if self.loss == "absolute":
                loss = 2 * loss * np.maximum(size[rows], NEAR_MEDIAN * np.median(size[rows]) + EXACT)
            rho[1, rows] = cost * freedom / loss
        return rho

    def curvature(self) -> tuple[FloatArray, FloatArray]:
        """With what weights (N,) tracks' slopes add to the curvature of - log likelihood at the optimum, and to the
        variance of its gradient, 1/m^2.

        Both are one over the variance of noise if it is normal. Of distances they follow from the density of residuals
        at their median, whatever their distribution (Koenker and Machado 1999, J. Am. Stat. Assoc. 94, 1296).
        """
        residuals = self.best.residuals
        weight = self.freedom / self.losses(residuals)
        if self.loss == "squares":
            return weight, weight
        ends = [np.quantile(residuals[rows], (0.5 - MIDDLE, 0.5 + MIDDLE)) for rows in self.rows]
        deviation = np.array([max(float(high - low), EXACT) / (4 * MIDDLE) for low, high in ends])
        return weight / deviation, weight**2

    def alike(self, cost: float, before: float) -> bool:
        """Whether a cost is no progress over that before."""
        return cost > before * (1 - NEGLIGIBLE / self.size)

    def threshold(self, rise: float) -> float:
        """The cost at which -2 log likelihood is by a rise above its least."""
        times = 1 if self.loss == "squares" else 2
        return self.best.cost * float(np.exp(rise / (times * self.freedom.sum())))

    def run(self, number: int, shares: FloatArray) -> tuple[Micropart | Body, Contact] | None:
        """A part and its friction; None where the case contradicts itself or the part is not on the plate."""
        case, surface, _, parameters = self.recordings[number]
        try:
            case = case_with(case, parameters, shares)
            part, law = build_part(case), build_friction(case)
            if not rim_gap(surface.record, *part.position) >= 0:
                raise ValueError("the part must lie on the plate")
        except ValueError as error:
            self.refusal = str(error)
            return None
        return part, law

    def _tried(self, number: int, rows: FloatArray) -> FloatArray:
        """Residuals (k, m) of one track at shares (k, s); inf where a case cannot be run."""
        known, (case, _, track, _) = self._known[number], self.recordings[number]
        measured = track.measured
        runs = {row.tobytes(): self.run(number, row) for row in rows if row.tobytes() not in known}
        able = {key: run for key, run in runs.items() if run is not None}
        new = {key: np.full(int(measured.sum()), np.inf) for key in runs}
        for key, path in zip(able, self.paths(number, list(able.values())), strict=True):
            new[key] = track.away(path, case.part.gyration)[measured]
        known |= new
        found = np.array([known[row.tobytes()] for row in rows])
        for key in list(known)[:-REMEMBERED]:
            del known[key]
        return found
