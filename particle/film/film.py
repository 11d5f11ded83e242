"""Film: the air under the face of a part, and its numbers for kernels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np

from particle.air import POWER, RAREFIED, Air
from particle.checks import positive, refuse
from particle.footprint import Footprint
from particle.friction import Contact, FrictionLaw, KogutEtsion, LocalContact, ScaledFriction
from particle.types import FloatArray

FUNCTIONS: Final = 5  # of the pressure
SIDE_POINTS = 8  # of the rule for the flow
LONG = 2.5  # sides of a rectangle, one over the other, from where on more functions are along it than across
DIFFERENCE = 1e-2  # roughnesses
PER_AREA = 371.6019695430806  # Pa, the pull-off force of `KogutEtsion()`, which takes .4 s to find


class Layer(NamedTuple):
    """A film and the asperities in it, as kernels read it; means are over the face."""

    law: FrictionLaw  # of the asperities, point by point
    bends: bool  # whether they meet the surface as it bends; else a flat one
    grips: bool  # whether they carry the friction; else the part's own law does, under their load
    closed: float  # roughnesses, the separation at the nearest point where the contact's law ends
    half: float  # m, of the side along x, or a radius
    area: float  # m^2
    offset: float  # m, of the gap at the separation 0
    decay: float  # m, over which the asperities' load falls e times
    pressure: float  # Pa, around the face
    viscosity: float  # Pa s
    free_path: float  # m
    rarefied: float  # m^POWER, of the flow
    values: FloatArray  # (points, FUNCTIONS), of a rule for half the face
    slopes: FloatArray  # (points, 2, FUNCTIONS) times `half`
    places: FloatArray  # (points, 4) x^2/2, x y, y^2/2 [m^2] and weights of means
    heights: FloatArray  # (3,) m^2, means of x^2/2, x y and y^2/2
    means: FloatArray  # (4, FUNCTIONS) of the functions times 1, x^2/2, x y and y^2/2 [1, m^2]
    products: FloatArray  # (4, FUNCTIONS, FUNCTIONS) of products of two of them, likewise


@dataclass(frozen=True)
class Film:
    """The film of air under the flat face of a part: a square with sides along x and y, or the face of a `Body`.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    air: Air
    size: float | Footprint  # m, a side of the square under a part that does not turn; or a rectangle or disc

    def __post_init__(self) -> None:
        air = isinstance(self.air, Air) and self.air.pressure > 0
        if isinstance(self.size, Footprint):
            known, wanted = self.size.radius > 0 or self.size.is_rectangle, "a rectangle or a disc"
        else:
            known, wanted = positive(self.size), "a positive length in m, or a Footprint"
        refuse(
            "Film",
            [
                (air, "air", "an Air of a positive pressure", self.air),
                (known, "size", wanted, self.size),
            ],
        )

    @property
    def area(self) -> float:
        """m^2, of the face."""
        return self.size.area if isinstance(self.size, Footprint) else self.size**2

    def layer(self, friction: Contact) -> Layer:
        """Its numbers for kernels, with the asperities of a law, or `assumed_contact`."""
        contact, factor = unscaled(friction)
        local = contact if isinstance(contact, LocalContact) else None
        own = local.contact if local else contact if isinstance(contact, KogutEtsion) else KogutEtsion()
        rough = isinstance(contact, (LocalContact, KogutEtsion))
        share = 1.0 if local else own.contact_area / self.area if rough else share_of(contact, self.area)
        law = (local or _square(own, math.sqrt(self.area))).law
        air, disc, half = self.air, isinstance(self.size, Footprint) and self.size.radius > 0, self._halves
        (points, weights), (fine, fine_weights) = (_half_face(n, disc) for n in (SIDE_POINTS, 2 * SIDE_POINTS))
        longer = float(half[1] / half[0])
        values, slopes = _on_disc(points) if disc else _on_square(points, longer)
        exact, _ = _on_disc(fine) if disc else _on_square(fine, longer)
        bends = np.column_stack([np.ones(len(fine)), _heights(half * fine)])
        return Layer(
            law=law._replace(per_area=law.per_area * np.repeat([share, share * factor], 4)),
            bends=local is not None,
            grips=rough,
            closed=own.branch[0],
            half=float(half[0]),
            area=self.area,
            offset=float(own.mean_gap(0.0)) + air.bow,
            decay=_decay(own),
            pressure=air.pressure,
            viscosity=air.viscosity,
            free_path=air.mean_free_path,
            rarefied=RAREFIED * air.mean_free_path**POWER,
            values=values,
            slopes=slopes * (half[0] / half)[:, None],
            places=np.column_stack([_heights(half * points), weights]),
            heights=fine_weights @ bends[:, 1:],
            means=np.einsum("k,km,ki->mi", fine_weights, bends, exact),
            products=np.einsum("k,km,ki,kj->mij", fine_weights, bends, exact, exact),
        )

    @property
    def _halves(self) -> FloatArray:
        """(2,) m, half the sides along x and y, or the radius."""
        if isinstance(self.size, Footprint):
            return np.abs(self.size.corners).max(axis=0, initial=self.size.radius)
        return np.full(2, self.size / 2)


def assumed_contact(friction: Contact, area: float) -> KogutEtsion:
    """The rough contact of a face [m^2] under a law that states no separation: `KogutEtsion()` on a share of the face,
    that whose pull-off force is the law's.
    """
    return KogutEtsion(contact_area=share_of(friction, area) * area)


def share_of(friction: Contact, area: float) -> float:
    """A law's pull-off force over that of `KogutEtsion()` on a face [m^2]; 1 where it is 0 or infinite."""
    pull_off = friction.pull_off
    return pull_off / (PER_AREA * area) if 0 < pull_off < math.inf else 1.0


def unscaled(friction: Contact) -> tuple[Any, float]:
    """A law without its `ScaledFriction`, and the factor of these."""
    factor = 1.0
    while isinstance(friction, ScaledFriction):
        factor *= friction.factor
        friction = friction.contact
    return friction, factor


@lru_cache(maxsize=16)
def _decay(contact: KogutEtsion) -> float:
    """-N'/N'' [m] of a contact's net load N where it is 0."""
    steps = DIFFERENCE * np.array([-1, 0, 1])
    less, none, more = contact.net_load(contact.separation(0.0) + steps)
    return float(0.5 * DIFFERENCE * (less - more) / (less - 2 * none + more) * contact.roughness)


@lru_cache(maxsize=16)
def _square(contact: KogutEtsion, size: float) -> LocalContact:
    """The contact under a square, made once."""
    return LocalContact(contact, size)


def _half_face(count: int, disc: bool) -> tuple[FloatArray, FloatArray]:
    """Points (n, 2) of half the square of side 2, or of half the disc of radius 1, and weights (n,), which make 1."""
    if disc:
        s, w = np.polynomial.legendre.leggauss(count // 2)
        angle, r = np.meshgrid(np.pi * np.arange(count) / count, np.sqrt((s + 1) / 2), indexing="ij")
        return np.column_stack([(r * np.cos(angle)).ravel(), (r * np.sin(angle)).ravel()]), np.tile(
            w / (2 * count), count
        )
    x, w = np.polynomial.legendre.leggauss(count)
    places = np.meshgrid(x, x[count // 2 :], indexing="ij")
    return np.column_stack([along.ravel() for along in places]), np.outer(w, w[count // 2 :]).ravel() / 2


def _heights(places: FloatArray) -> FloatArray:
    """x^2/2, x y and y^2/2 at places (n, 2); (n, 3)."""
    x, y = places.T
    return np.column_stack([x * x / 2, x * y, y * y / 2])


def _on_square(places: FloatArray, longer: float = 1.0) -> tuple[FloatArray, FloatArray]:
    """The functions of the pressure, (n, FUNCTIONS), and their slopes, (n, 2, FUNCTIONS), on the square of side 2.

    Products of integrals of Legendre's polynomials, which are 0 at the rim: (1, 1), (1, 3), (3, 1) and (3, 3), even
    along x and y, and (2, 2), which a twist of the surface moves. In place of (3, 3) on a rectangle LONG times longer
    along y than along x (1, 5), or the other way around (5, 1).
    """
    x, y = ([_integral(n, along) for n in (1, 2, 3, 4, 5)] for along in places.T)
    pairs = ((0, 0), (0, 2), (2, 0), (0, 4) if longer > LONG else (4, 0) if longer < 1 / LONG else (2, 2), (1, 1))
    values = [x[i][0] * y[j][0] for i, j in pairs]
    slopes = [(x[i][1] * y[j][0], x[i][0] * y[j][1]) for i, j in pairs]
    return np.array(values).T.copy(), np.array(slopes).transpose(2, 1, 0).copy()


def _on_disc(places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The same on the disc of radius 1: 1 - r^2 times 1, r^2, r^4, x^2 - y^2 and x y."""
    x, y = places.T
    square, one = x * x + y * y, np.ones(len(x))
    factors = np.array([one, square, square * square, x * x - y * y, x * y])
    by_x = np.array([0 * x, 2 * x, 4 * x * square, 2 * x, y])
    by_y = np.array([0 * y, 2 * y, 4 * y * square, -2 * y, x])
    slopes = np.array([(1 - square) * by - 2 * along * factors for by, along in ((by_x, x), (by_y, y))])
    return np.ascontiguousarray(((1 - square) * factors).T), np.ascontiguousarray(slopes.transpose(2, 0, 1))


def _integral(n: int, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(P_n+1 - P_n-1)/sqrt(4 n + 2), a multiple of the integral of Legendre's P_n, and its slope."""
    legendre = np.polynomial.legendre
    c = np.zeros(n + 2)
    c[n + 1], c[n - 1] = 1.0, -1.0
    c /= math.sqrt(4 * n + 2)
    return np.asarray(legendre.legval(x, c)), np.asarray(legendre.legval(x, legendre.legder(c)))
