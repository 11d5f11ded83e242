"""Friction laws: the largest tangential force Q that a contact under the net normal force N transmits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from particle.checks import finite, not_negative, positive, refuse
from particle.jit import device_no_arrays, jit
from particle.types import FloatArray, IntArray

CONSTANT, COULOMB, TABLE, POINTS, LOCAL = 0, 1, 2, 3, 4


class FrictionLaw(NamedTuple):
    """A friction law as kernels read it. Q must not fall with the load: the search for slips relies on that."""

    kind: int
    limit: float  # CONSTANT: N
    coefficient: float  # COULOMB: kinetic
    static_ratio: float  # limit of a part that is stuck over that of one that slides
    impact_coefficient: float  # limit of Q/N for large N: what bounds the friction of a blow
    adhesion: float  # COULOMB: N
    pull_off: float  # N
    largest_load: float  # N, above which the law says nothing
    step: float  # TABLE: width of a knot interval in u = ln(1 + sqrt((N + pull_off) / pull_off))
    loads: FloatArray  # POINTS: (points,) N, ascending
    # Polynomials on each interval, highest power first. TABLE: (4, knots - 1), of ln Q over u, from the knot before.
    # POINTS: (6, points + 1), of Q [N] over the load, from the point before; below them all, from the first point.
    pieces: FloatArray
    # LOCAL, with the table of a flat surface: see `grip`, and `body.press` for a part with a face.
    roughness: float  # m
    fold: float  # roughnesses, the separation at pull-off
    per_area: FloatArray  # (intervals, 8) Pa, cubics of p - a and q, highest power first, over the separation
    places: FloatArray  # (points + 1, 4) x^2/2, x y, y^2/2 over the roughness [m] and weights [m^2]; last the corner.
    # Of a face two more columns: x and y over its reach.
    ends: IntArray  # (4,) where the rules end that `places` has one after the other


class Contact(Protocol):
    """What `simulate` asks of a friction law, and what people may ask of it."""

    @property
    def law(self) -> FrictionLaw: ...

    @property
    def pull_off(self) -> float:
        """N, the pull at which contact ends; inf where it never does."""

    @property
    def largest_load(self) -> float:
        """N, the net load where the law ends; inf where it never does."""

    @property
    def table_error(self) -> float:
        """Relative error of the tabulated limit; 0 where there is no table."""

    def friction_limit(self, net_load: ArrayLike) -> FloatArray:
        """Q [N] under net loads [N] of any shape; ValueError for one below -pull_off or above largest_load."""


@device_no_arrays
def friction_limit(law: FrictionLaw, load: float) -> float:
    """Q [N] while sliding under the net normal force `load` [N]; outside the law it goes on, never negative."""
    if law.kind == CONSTANT:
        return law.limit
    if law.kind == COULOMB:
        return max(0.0, law.coefficient * (load + law.adhesion))
    c = law.pieces
    if law.kind == POINTS:
        piece = int(np.searchsorted(law.loads, load, side="right"))
        s = load - law.loads[max(piece - 1, 0)]
        limit = c[0, piece]
        for power in range(1, c.shape[0]):
            limit = limit * s + c[power, piece]
        return max(0.0, limit)
    above = max(0.0, (load + law.pull_off) / law.pull_off)
    place = math.log1p(math.sqrt(above)) / law.step
    knot = int(min(place, c.shape[1] - 1.0))
    s = (place - knot) * law.step
    return math.exp(((c[0, knot] * s + c[1, knot]) * s + c[2, knot]) * s + c[3, knot])


@device_no_arrays
def friction_slope(law: FrictionLaw, load: float) -> float:
    """dQ/dN while sliding under the net normal force `load` [N]."""
    if law.kind == CONSTANT or friction_limit(law, load) <= 0.0:
        return 0.0
    if law.kind == COULOMB:
        return law.coefficient
    c = law.pieces
    if law.kind == POINTS:
        piece = int(np.searchsorted(law.loads, load, side="right"))
        s = load - law.loads[max(piece - 1, 0)]
        slope = 0.0
        last = c.shape[0] - 1
        for power in range(last):
            slope = slope * s + (last - power) * c[power, piece]
        return slope
    # Q is a function of the root of the load above pull-off: where that is 0 its slope has no bound.
    above = max(1e-12, (load + law.pull_off) / law.pull_off)
    root = math.sqrt(above)
    place = math.log1p(root) / law.step
    knot = int(min(place, c.shape[1] - 1.0))
    s = (place - knot) * law.step
    slope = (3 * c[0, knot] * s + 2 * c[1, knot]) * s + c[2, knot]
    return friction_limit(law, load) * slope / (2 * root * (1 + root) * law.pull_off)


@jit
def _limits(law: FrictionLaw, loads: FloatArray) -> FloatArray:
    out = np.empty(len(loads))
    for k in range(len(loads)):
        out[k] = friction_limit(law, loads[k])
    return out


def friction_limits(law: FrictionLaw, net_load: ArrayLike) -> FloatArray:
    """Q [N] under net loads [N] of any shape; ValueError for one outside the law, as `check_loads` says."""
    loads = np.asarray(net_load, dtype=float)
    check_loads(loads, law.pull_off, law.largest_load)
    return np.reshape(_limits(law, np.ascontiguousarray(loads.ravel())), loads.shape)


def check_loads(loads: FloatArray, pull_off: float, largest_load: float) -> None:
    """Raises ValueError, with both numbers, for net loads [N] below -pull_off or above the largest, and for nan."""
    below, above = ~(loads >= -pull_off), loads > largest_load
    if below.any():
        least = f"at least minus the pull-off force, {-pull_off:.6g} N" if pull_off < math.inf else "a number"
        raise ValueError(f"Input net_load must be {least}; got {loads[below].min():.6g} N")
    if above.any():
        raise ValueError(
            f"Input net_load must be at most {largest_load:.6g} N, where the friction law ends; "
            f"got {loads[above].max():.6g} N"
        )


def new_law(
    kind: int,
    pull_off: float,
    largest_load: float = math.inf,
    *,
    limit: float = 0.0,
    coefficient: float = 0.0,
    static_ratio: float = 1.0,
    adhesion: float = 0.0,
    step: float = 1.0,
    loads: FloatArray | None = None,
    pieces: FloatArray | None = None,
) -> FrictionLaw:
    """A law, with neutral values for what its kind does not use; only Coulomb's rises without end."""
    return FrictionLaw(
        kind,
        float(limit),
        float(coefficient),
        float(static_ratio),
        float(coefficient) if kind == COULOMB else 0.0,
        float(adhesion),
        float(pull_off),
        float(largest_load),
        float(step),
        np.zeros(1) if loads is None else loads,
        np.zeros((4, 1)) if pieces is None else pieces,
        *(0.0, 0.0, np.zeros((1, 8)), np.zeros((1, 4)), np.zeros(1, dtype=np.int64)),
    )


@dataclass(frozen=True)
class ConstantFriction:
    """A constant friction limit, Q = limit whatever the load; the part never comes off.

    Raises
    ------
    ValueError
        The limit is negative.
    """

    limit: float  # N

    table_error = 0.0
    pull_off = math.inf
    largest_load = math.inf

    def __post_init__(self) -> None:
        refuse("ConstantFriction", [(not_negative(self.limit), "limit", "0 or a positive force in N", self.limit)])

    @property
    def law(self) -> FrictionLaw:
        return new_law(CONSTANT, math.inf, limit=self.limit)

    def friction_limit(self, net_load: ArrayLike) -> FloatArray:
        """Q [N] under net loads [N] of any shape; ValueError for one that is no number."""
        return friction_limits(self.law, net_load)


@dataclass(frozen=True)
class CoulombAdhesion:
    """Coulomb friction with adhesion: Q = max(0, coefficient (N + adhesion)); the part comes off below N = -adhesion.

    Parameters
    ----------
    static_coefficient : float, optional
        Coefficient of a stuck part, at least the (kinetic) coefficient.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    coefficient: float
    adhesion: float = 0.0  # N
    static_coefficient: float | None = None

    table_error = 0.0
    largest_load = math.inf

    def __post_init__(self) -> None:
        static, sliding = self.static_coefficient, self.coefficient
        checks = [
            (not_negative(sliding), "coefficient", "0 or positive", sliding),
            (not_negative(self.adhesion), "adhesion", "0 or a positive force in N", self.adhesion),
        ]
        if static is not None and not_negative(sliding):
            at_least = f"at least the coefficient {sliding!r}, which must then be positive"
            checks.append((finite(static) and static >= sliding > 0, "static_coefficient", at_least, static))
        refuse("CoulombAdhesion", checks)

    @property
    def pull_off(self) -> float:
        return self.adhesion

    @property
    def law(self) -> FrictionLaw:
        static = self.coefficient if self.static_coefficient is None else self.static_coefficient
        ratio = static / self.coefficient if self.coefficient > 0 else 1.0
        return new_law(COULOMB, self.adhesion, coefficient=self.coefficient, static_ratio=ratio, adhesion=self.adhesion)

    def friction_limit(self, net_load: ArrayLike) -> FloatArray:
        """Q [N] while sliding under net loads [N] of any shape; ValueError for one below -pull_off."""
        return friction_limits(self.law, net_load)


@dataclass(frozen=True)
class ScaledFriction:
    """A law all of whose limits are `factor` times as high, and whose pull-off force is the same.

    Raises ValueError when the factor is not positive.
    """

    contact: Contact
    factor: float

    def __post_init__(self) -> None:
        refuse("ScaledFriction", [(positive(self.factor), "factor", "positive", self.factor)])

    @property
    def pull_off(self) -> float:
        return self.contact.pull_off

    @property
    def largest_load(self) -> float:
        return self.contact.largest_load

    @property
    def table_error(self) -> float:
        return self.contact.table_error

    @cached_property
    def law(self) -> FrictionLaw:
        law, factor = self.contact.law, self.factor
        pieces = law.pieces * factor
        if law.kind in (TABLE, LOCAL):
            pieces = law.pieces + math.log(factor) * np.eye(len(law.pieces))[:, -1:]
        return law._replace(
            limit=law.limit * factor,
            coefficient=law.coefficient * factor,
            impact_coefficient=law.impact_coefficient * factor,
            pieces=pieces,
            per_area=law.per_area * np.repeat([1.0, factor], 4),
        )

    def friction_limit(self, net_load: ArrayLike) -> FloatArray:
        """Q [N] under net loads [N] of any shape; ValueError for one outside the law."""
        return friction_limits(self.law, net_load)
