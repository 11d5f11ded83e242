"""A stretching plate's full solutions over time, with the derivatives that its equilibrium has under moving strokes.

With w in the trial space, p = grad w and the membrane force F(p), which is quadratic in p, equilibrium is

    a(w, q) + int F(p) : p grad q = forces on q,   w = stroke at each actuator.

Its derivatives are two more solutions with the matrix of Newton's method: with F' = dF(p) p' and 2 F(p') = d2F p' p',

    K w' = 0,   K w'' = -int (2 F(p') : p + 2 F' : p') grad q,   and the strokes' derivatives at the actuators.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fem_plate.large_deflection import Columns, DiscretePlate
from fem_plate.large_deflection.membranes.samples import times
from fem_plate.large_deflection.reduction.snapshots import slopes
from fem_plate.large_deflection.solution.equilibrium import Coefficients, Loads, Solution

FloatArray = NDArray[np.float64]
Slopes = list[FloatArray]  # (k, 2 n) at each set of samples


class Node(NamedTuple):
    """A full solution; derivatives in the time that the strokes' own are in."""

    w: Columns  # of w, w' and w''
    u: FloatArray  # (in-plane unknowns, 3), of u, u' and u''


class FullSolutions:
    """Those of one plate on rigid actuators."""

    def __init__(self, discrete: DiscretePlate) -> None:
        self.discrete, self.equilibrium = discrete, discrete.equilibrium
        in_plane, trial = discrete.plane_stress.membrane, discrete.trial
        self._sets = [
            (discrete.membrane.samples, self.equilibrium.known),
            (in_plane.samples, [trial.slopes(samples) for samples in in_plane.samples]),
        ]

    def solve(self, strokes: FloatArray, start: Coefficients | None = None) -> Solution:
        """The plate with strokes (N,) over its thickness."""
        return self.equilibrium.solve(Loads(strokes, 0.0), start)

    def node(self, strokes: FloatArray, start: Coefficients | None) -> Node:
        """The plate with strokes (3, N) over its thickness, and their derivatives."""
        solution = self.solve(strokes[0], start)
        state, no_load = solution.state, (np.zeros(self.discrete.model.unknowns), np.zeros(self.discrete.trial.count))
        v_t, extra_t, _ = solution.solver.solve(*no_load, strokes[1])
        p_t = self._slopes(0, v_t, extra_t)
        v_tt, extra_tt, _ = solution.solver.solve(*self._load(state.slopes, p_t), strokes[2])
        v, extra = np.stack([state.v, v_t, v_tt], axis=1), np.stack([state.extra, extra_t, extra_tt], axis=1)
        p, p_t, p_tt = (self._slopes(1, v[:, k], extra[:, k]) for k in range(3))
        u_tt = 2 * self._motion(p_t) + derivative(self._motion, p, p_tt)
        return Node(Columns(v, extra), np.stack([self._motion(p), derivative(self._motion, p, p_t), u_tt], axis=1))

    def _load(self, p: Slopes, p_t: Slopes) -> tuple[FloatArray, FloatArray]:
        """What drives w'' in v and in the extra coefficients."""
        membrane, space, trial = self.discrete.membrane, self.discrete.model.space, self.discrete.trial
        of_v, of_extra = np.zeros(space.all_count), np.zeros(trial.count)
        ends = np.cumsum([q.size * 3 // 2 for q in p])[:-1]
        both = [np.split(rows, ends) for rows in (2 * self._force(p_t), 2 * derivative(self._force, p, p_t))]
        for samples, known, q, q_t, second, first in zip(
            membrane.samples, self._sets[0][1], p, p_t, *both, strict=True
        ):
            pulls = [(second, q), (first, q_t)]
            of_p = sum(
                samples.weighted(times(pull.reshape(len(slope), -1), slope[..., None]))[..., 0] for pull, slope in pulls
            )
            element = np.einsum("kni,kn->ki", samples.gradient, of_p, optimize=True)
            np.add.at(of_v, space.dofs[samples.triangle], element)
            of_extra += np.einsum("knj,kn->j", known[..., :-1], of_p, optimize=True)
        return -space.to_independent(of_v), -of_extra

    def _slopes(self, i: int, v: FloatArray, extra: FloatArray) -> Slopes:
        columns = Columns(v[:, None], extra[:, None])
        return [p[..., 0] for p in slopes(self.discrete, *self._sets[i], columns)]

    def _force(self, p: Slopes) -> FloatArray:
        """The membrane force, all samples in a row."""
        membrane = self.discrete.membrane
        everything = membrane.expand(membrane.respond(p)[0])
        return np.concatenate(
            [membrane.force(samples, everything, q).ravel() for samples, q in zip(membrane.samples, p, strict=True)]
        )

    def _motion(self, p: Slopes) -> FloatArray:
        return self.discrete.plane_stress.membrane.respond(p)[0]


def derivative(quadratic: Callable[[Slopes], FloatArray], p: Slopes, p_t: Slopes) -> FloatArray:
    """What a homogeneous quadratic function changes by, exactly."""
    ahead, behind = ([q + sign * q_t for q, q_t in zip(p, p_t, strict=True)] for sign in (1, -1))
    return np.asarray((quadratic(ahead) - quadratic(behind)) / 2)
