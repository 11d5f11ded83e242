"""Fits of actuators' stiffness and a plate's tension to measured influence functions.

With the compliance G of the plate under a tension T, and its deflections U under unit forces at the actuators, the
functions are gain U (G + 1/k)^-1. Only U and G need the plate; the gain follows by linear least squares.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from fem_plate.influence import InfluenceShapes
from fem_plate.inputs import places_on
from fem_plate.optics.measured import MeasuredInfluence
from fem_plate.plate import Plate
from fem_plate.types import FloatArray, IntArray

STIFFNESS, TENSION = "stiffness", "tension"
UNKNOWNS = STIFFNESS, TENSION
MAX_ACTUATORS = 500  # compliances of more take long
MIN_VALUES = 10
STEP = 1e-4  # of an unknown, for differences
PRESSED = 0.9  # of the load at which the plate buckles: more compression is not tried
RIGID = 1e4  # times the plate's own stiffness at an actuator: more cannot be distinguished from rigid


@dataclass(frozen=True)
class InfluenceFit:
    """What `fit_influence` found; each uncertainty is a standard error, None where the value was given.

    Attributes
    ----------
    stiffness, stiffness_error : float, float or None
        Of all actuators [N/m].
    tension, tension_error : float, float or None
        Of the plate [N/m].
    gain : float
        What the functions were multiplied by; 1 where their unit is known.
    residual : float
        Root mean square of what is left, over the largest value.
    correlation : float or None
        Of both errors; None where only one was fitted.
    pixels, functions : int
        How many values on the plate there were, and of how many functions.
    rigid : bool
        Whether the stiffness went to its upper bound, where actuators cannot be distinguished from rigid ones.
    """

    stiffness: float
    stiffness_error: float | None
    tension: float
    tension_error: float | None
    gain: float
    residual: float
    correlation: float | None
    pixels: int
    functions: int
    rigid: bool


def fit_influence(
    measured: MeasuredInfluence,
    plate: Plate,
    points: ArrayLike,
    stiffness: float | None = None,
    fitted: Collection[str] = UNKNOWNS,
    actuator: int | None = None,
) -> InfluenceFit:
    """Fit the stiffness that all actuators share, and the plate's tension, to measured influence functions.

    Parameters
    ----------
    measured : MeasuredInfluence
        The functions, from `read_influence`.
    plate : Plate
        The plate, with the tension to begin with, or to keep.
    points : (N, 2) array_like
        Places of its actuators [m].
    stiffness : float, optional
        Stiffness [N/m] to begin with, or to keep; by default that of the plate at its actuators.
    fitted : collection of str
        What to fit: "stiffness", "tension" or both; the other keeps its value.
    actuator : int, optional
        Whose function it is, where it is one alone and the file does not say; by default of the actuator closest to
        the middle of the plate.

    Returns
    -------
    fit : InfluenceFit

    Raises
    ------
    ValueError
        Nothing, or something else, is to be fitted; the functions are not those of so many actuators, or too few
        values lie on the plate; a boundary is free, so that there is no tension, or the plate is not held; there are
        more than 500 actuators.
    """
    from scipy.optimize import least_squares  # here, as it takes a while

    points = places_on(plate.mesh, points, "fit_influence")
    _check(measured, points, fitted, stiffness, actuator)
    xy, rows, values = _on_plate(measured, plate, points, actuator)
    known = np.isfinite(values)
    scale = float(np.abs(values[known]).max())
    free_gain = not measured.scaled
    unit = plate.section.rigidity / plate.mesh.size**2  # N/m

    @lru_cache(maxsize=8)
    def unit_forces(tension: float) -> tuple[FloatArray, FloatArray]:
        """Deflections (P, N) and compliance (N, N) [m/N] under unit forces."""
        shapes = plate.as_meshed(tension).influence(points, 0.0)  # fine enough
        assert isinstance(shapes, InfluenceShapes)
        return shapes.values(xy), shapes.compliance

    own = 1 / float(np.median(np.diag(unit_forces(plate.tension)[1])))  # N/m
    begin = {STIFFNESS: np.log(own if stiffness is None else stiffness), TENSION: plate.tension / unit}
    names = [name for name in UNKNOWNS if name in fitted]

    def values_at(unknowns: FloatArray) -> tuple[dict[str, float], float, FloatArray]:
        """The unknowns [log N/m; tension over the unit], the gain, and what is left (n,), over the largest value."""
        at = begin | dict(zip(names, unknowns.tolist(), strict=True))
        deflections, compliance = unit_forces(at[TENSION] * unit)
        yielding = compliance + np.diag(np.full(len(points), np.exp(-at[STIFFNESS])))
        forces = np.linalg.solve(yielding, np.eye(len(points))[:, rows])
        shapes = (deflections @ forces).T[known]
        gain = float(shapes @ values[known] / (shapes @ shapes)) if free_gain else 1.0
        return at, gain, (gain * shapes - values[known]) / scale

    lowest = -PRESSED * plate.buckling_load() / unit if TENSION in names else 0.0
    bounds = {STIFFNESS: (-np.inf, np.log(RIGID * own)), TENSION: (lowest, np.inf)}
    low, high = np.array([bounds[name] for name in names]).T
    start = np.clip([begin[name] for name in names], low, high)
    step = {STIFFNESS: 1.0, TENSION: max(abs(begin[TENSION]), 1.0)}
    answer = least_squares(
        lambda unknowns: values_at(unknowns)[2],
        start,
        _differences(lambda unknowns: values_at(unknowns)[2], [STEP * step[name] for name in names], high),
        (low, high),
        x_scale=[step[name] for name in names],
        xtol=1e-8,
    )
    at, gain, left = values_at(answer.x)
    errors, correlation = _errors(answer.jac, left, free_gain)
    of = dict(zip(names, errors, strict=True))
    found = float(np.exp(at[STIFFNESS]))
    return InfluenceFit(
        stiffness=found,
        stiffness_error=found * of[STIFFNESS] if STIFFNESS in of else None,
        tension=at[TENSION] * unit,
        tension_error=unit * of[TENSION] if TENSION in of else None,
        gain=gain,
        residual=float(np.sqrt(np.mean(left**2))),
        correlation=correlation,
        pixels=int(known.sum()),
        functions=len(values),
        rigid=bool(STIFFNESS in of and at[STIFFNESS] > bounds[STIFFNESS][1] - 0.01),
    )


def _differences(
    function: Callable[[FloatArray], FloatArray], steps: list[float], high: FloatArray
) -> Callable[[FloatArray], FloatArray]:
    """The Jacobian of a function by differences: a step up, or down at an upper bound."""

    def jacobian(x: FloatArray) -> FloatArray:
        here, columns = function(x), []
        for k, length in enumerate(steps):
            moved = x.copy()
            moved[k] += length if x[k] + length < high[k] else -length
            columns.append((function(moved) - here) / (moved[k] - x[k]))
        return np.stack(columns, axis=1)

    return jacobian


def _errors(jacobian: FloatArray, left: FloatArray, free_gain: bool) -> tuple[list[float], float | None]:
    """Standard errors of the unknowns, and their correlation, if what is left is independent noise."""
    freedom = len(left) - jacobian.shape[1] - free_gain
    covariance = np.linalg.pinv(jacobian.T @ jacobian) * float(left @ left) / max(freedom, 1)
    errors = np.sqrt(np.diag(covariance))
    correlation = float(covariance[0, 1] / errors.prod()) if len(errors) == 2 and errors.all() else None
    return errors.tolist(), correlation


def _on_plate(
    measured: MeasuredInfluence, plate: Plate, points: FloatArray, actuator: int | None
) -> tuple[FloatArray, IntArray, FloatArray]:
    """Pixels on the plate (P, 2) [m], whose functions (M,) they are of, and the values (M, P)."""
    outline = plate.mesh.outline
    middle = outline.box.mean(axis=0)
    rows = measured.actuators
    if measured.alone:
        if actuator is not None:
            rows = np.array([actuator])
        elif rows is None:
            rows = np.array([np.argmin(np.linalg.norm(points - middle, axis=1))])
        middle = points[rows[0]]
    assert rows is not None
    xy = middle + measured.offsets
    on = outline.gap(xy) > 0
    values = measured.values[:, on]
    count = int(np.isfinite(values).sum())
    if count < MIN_VALUES:
        width = float(np.ptp(measured.offsets, axis=0).max())
        raise ValueError(
            f"Input measured of fit_influence must have {MIN_VALUES} values on the plate or more; got {count}, as the "
            f"functions are {width:.3g} m wide"
        )
    if not np.nan_to_num(values).any():
        raise ValueError("Input measured of fit_influence must have values other than 0 on the plate; got none")
    return xy[on], rows, values


def _check(
    measured: MeasuredInfluence,
    points: FloatArray,
    fitted: Collection[str],
    stiffness: float | None,
    actuator: int | None,
) -> None:
    """Raise ValueError, naming each input that is wrong."""
    mistakes = []
    if not fitted or not set(fitted) <= set(UNKNOWNS):
        mistakes.append(f"Input fitted of fit_influence must be some of {', '.join(UNKNOWNS)}; got {sorted(fitted)}")
    if stiffness is not None and not (np.isfinite(stiffness) and stiffness > 0):
        mistakes.append(f"Input stiffness of fit_influence must be positive and finite; got {stiffness!r} N/m")
    if not 1 <= len(points) <= MAX_ACTUATORS:
        mistakes.append(f"Input points of fit_influence must be 1 to {MAX_ACTUATORS}; got {len(points)}")
    if measured.actuators is not None and measured.actuators.max(initial=0) >= len(points):
        got = f"one of number {int(measured.actuators.max())} with {len(points)} actuators"
        mistakes.append(f"Input measured of fit_influence must have functions of the plate's actuators; got {got}")
    if STIFFNESS in fitted and not measured.scaled and len(points) == 1:
        mistakes.append(
            'Input fitted of fit_influence must be "tension" alone for functions in a unit of their own with one '
            "actuator, whose stiffness changes no more than their height"
        )
    if actuator is not None and not measured.alone:
        mistakes.append("Input actuator of fit_influence must not be given where functions have numbers; got one")
    elif actuator is not None and not 0 <= actuator < len(points):
        mistakes.append(f"Input actuator of fit_influence must be from 0 to {len(points) - 1}; got {actuator}")
    if mistakes:
        raise ValueError("; ".join(mistakes))
