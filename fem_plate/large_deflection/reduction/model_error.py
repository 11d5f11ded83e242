"""How far a reduced model is from full solutions."""

from __future__ import annotations

import numpy as np

from fem_plate.large_deflection.reduction.full_solutions import FullSolutions
from fem_plate.large_deflection.reduction.projection import Projection
from fem_plate.large_deflection.reduction.reduced_solver import reduced_equilibrium
from fem_plate.large_deflection.solution import Coefficients
from fem_plate.types import FloatArray


def deflected(known: FullSolutions, model: Projection, strokes: FloatArray) -> Coefficients:
    """The plate of a reduced model under strokes (N,)."""
    c = reduced_equilibrium(model.plate, strokes).corrections[0]
    a, b = known.linear.weighted(strokes[:, None]), model.corrections.weighted(c[:, None])
    return known.discrete.equilibrium.at((a.v + b.v)[:, 0], (a.extra + b.extra)[:, 0], 0.0)


def estimated_error(known: FullSolutions, model: Projection, strokes: FloatArray) -> float:
    """About the largest error of w in a reduced model: Newton's step, with the nearest solution's matrix."""
    state, equilibrium = deflected(known, model, strokes), known.discrete.equilibrium
    of_v, of_extra = equilibrium.imbalance(state, np.where(equilibrium.held, 0.0, strokes))
    missing = (strokes - equilibrium.heights(state))[equilibrium.held]
    dv, de, _ = known.nearest(strokes).solve(of_v, of_extra, missing)
    return equilibrium.change(dv, de)


def measured_error(known: FullSolutions, model: Projection, strokes: FloatArray) -> float:
    """The largest error of w in a reduced model, by a full solution, which is then known."""
    state = deflected(known, model, strokes)
    full = known.add(strokes, state)
    return known.discrete.equilibrium.change(full.v - state.v, full.extra - state.extra)
