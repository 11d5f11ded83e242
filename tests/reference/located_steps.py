"""One of scipy's solvers up to the first of some events, which are located by repeating the last step."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

RTOL = 1e-13  # of one step
INSIDE = np.linspace(0, 1, 7)[1:]  # of a step: where its interpolant is searched for events


def march(method, rate, start, y, end, atol, events, **options):
    """One solver up to the end or the first of the events, (kind, function that falls through 0)."""
    solver = method(rate, start, y, end, rtol=RTOL, atol=atol, **options)
    values = [max(measure(start, y), 0.0) for _, measure in events]
    while solver.status == "running":
        before, y_before = solver.t, solver.y.copy()
        message = solver.step()
        if solver.status == "failed":
            raise RuntimeError(message)
        between = solver.dense_output()
        hits = []
        for (kind, measure), value in zip(events, values, strict=True):
            for share in INSIDE:
                at = before + share * (solver.t - before)
                if value >= 0 > measure(at, solver.y if share == 1 else between(at)):
                    hits.append((at, kind, measure))
                    break
        if hits:
            found = []
            for at, kind, measure in hits:
                found.append((_locate(method, rate, before, y_before, at, atol, measure), kind))
            (t, y), kind = min(found, key=lambda one: one[0][0])
            return t, y, kind
        values = [measure(solver.t, solver.y) for _, measure in events]
    return solver.t, solver.y, ""


def _locate(method, rate, before, y_before, at, atol, measure):
    """The event's time and state, by repeating the step up to a time that is sought."""

    def state(t):
        if t <= before:
            return y_before
        return solve_ivp(rate, (before, t), y_before, method=method, rtol=RTOL, atol=atol).y[:, -1]

    def value(t):
        return measure(t, state(t))

    last = value(at)
    if value(before) <= 0 or last >= 0:  # on the edge already, or only the interpolant was beyond
        t = before if last < 0 else at
    else:
        t = float(brentq(value, before, at, xtol=1e-18, rtol=1e-14))
    return t, state(t)
