"""Film: the air under the square face of a part, and its numbers for kernels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final, NamedTuple

import numpy as np

from particle.air import POWER, RAREFIED, Air
from particle.checks import positive, refuse
from particle.friction import Contact, FrictionLaw, KogutEtsion, LocalContact, ScaledFriction
from particle.types import FloatArray

FUNCTIONS: Final = 5  # of the pressure
SIDE_POINTS = 8  # of the rule for the flow
PER_AREA = 371.6019695430806  # Pa, the pull-off force of `KogutEtsion()`, which takes .4 s to find


class Layer(NamedTuple):
    """A film and the asperities in it, as kernels read it; means are over the face."""

    law: FrictionLaw  # of the asperities, point by point
    bends: bool  # whether they meet the surface as it bends; else a flat one, under a gap that is uniform
    grips: bool  # whether they carry the friction; else the part's own law does, under their load
    closed: float  # roughnesses, the separation at the nearest point where the contact's law ends
    half: float  # m, of a side
    area: float  # m^2
    offset: float  # m, of the gap at the separation 0
    pressure: float  # Pa, around the face
    viscosity: float  # Pa s
    free_path: float  # m
    rarefied: float  # m^POWER, of the flow
    values: FloatArray  # (points, FUNCTIONS), of a rule for half the face
    slopes: FloatArray  # (points, 2, FUNCTIONS) over half a side
    places: FloatArray  # (points, 4) x^2/2, x y, y^2/2 [m^2] and weights of means
    means: FloatArray  # (4, FUNCTIONS) of the functions times 1, x^2/2, x y and y^2/2 [1, m^2]
    products: FloatArray  # (4, FUNCTIONS, FUNCTIONS) of products of two of them, likewise


@dataclass(frozen=True)
class Film:
    """The film of air under the flat, square face of a part that does not turn, its sides along x and y.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    air: Air
    size: float  # m, a side of the face

    def __post_init__(self) -> None:
        air = isinstance(self.air, Air) and self.air.pressure > 0
        refuse(
            "Film",
            [
                (air, "air", "an Air of a positive pressure", self.air),
                (positive(self.size), "size", "a positive length in m", self.size),
            ],
        )

    def layer(self, friction: Contact) -> Layer:
        """Its numbers for kernels, with the asperities of a law, or `assumed_contact`."""
        contact, factor = unscaled(friction)
        local = contact if isinstance(contact, LocalContact) else None
        own = local.contact if local else contact if isinstance(contact, KogutEtsion) else KogutEtsion()
        rough = isinstance(contact, (LocalContact, KogutEtsion))
        share = 1.0 if local else own.contact_area / self.size**2 if rough else share_of(contact, self.size**2)
        law = (local or _square(own, self.size)).law
        air, half = self.air, self.size / 2
        points, weights = _half_square()
        values, slopes = _functions(points)
        heights = _heights(half * points)
        fine, fine_weights = _half_square(2 * SIDE_POINTS)
        exact, bends = _functions(fine)[0], np.column_stack([np.ones(len(fine)), _heights(half * fine)])
        return Layer(
            law=law._replace(per_area=law.per_area * np.repeat([share, share * factor], 4)),
            bends=local is not None,
            grips=rough,
            closed=own.branch[0],
            half=half,
            area=self.size**2,
            offset=float(own.mean_gap(0.0)) + air.bow,
            pressure=air.pressure,
            viscosity=air.viscosity,
            free_path=air.mean_free_path,
            rarefied=RAREFIED * air.mean_free_path**POWER,
            values=values,
            slopes=slopes,
            places=np.column_stack([heights, weights]),
            means=np.einsum("k,km,ki->mi", fine_weights, bends, exact),
            products=np.einsum("k,km,ki,kj->mij", fine_weights, bends, exact, exact),
        )


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
def _square(contact: KogutEtsion, size: float) -> LocalContact:
    """The contact under a square, made once."""
    return LocalContact(contact, size)


def _half_square(count: int = SIDE_POINTS) -> tuple[FloatArray, FloatArray]:
    """Gauss's points (n, 2) of half the square of side 2, and their weights (n,), which make 1."""
    x, w_x = np.polynomial.legendre.leggauss(count)
    y, w_y = np.polynomial.legendre.leggauss(count // 2)
    places = np.meshgrid(x, (y + 1) / 2, indexing="ij")
    return np.column_stack([along.ravel() for along in places]), np.outer(w_x, w_y).ravel() / 4


def _heights(places: FloatArray) -> FloatArray:
    """x^2/2, x y and y^2/2 at places (n, 2); (n, 3)."""
    x, y = places.T
    return np.column_stack([x * x / 2, x * y, y * y / 2])


def _functions(places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The functions of the pressure, (n, FUNCTIONS), and their slopes, (n, 2, FUNCTIONS), on the square of side 2.

    Products of integrals of Legendre's polynomials, which are 0 at the rim: (1, 1), (1, 3), (3, 1) and (3, 3), even
    along x and y, and (2, 2), which a twist of the surface moves.
    """
    x, y = ([_integral(n, along) for n in (1, 2, 3)] for along in places.T)
    pairs = ((0, 0), (0, 2), (2, 0), (2, 2), (1, 1))
    values = [x[i][0] * y[j][0] for i, j in pairs]
    slopes = [(x[i][1] * y[j][0], x[i][0] * y[j][1]) for i, j in pairs]
    return np.array(values).T.copy(), np.array(slopes).transpose(2, 1, 0).copy()


def _integral(n: int, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(P_n+1 - P_n-1)/sqrt(4 n + 2), a multiple of the integral of Legendre's P_n, and its slope."""
    legendre = np.polynomial.legendre
    c = np.zeros(n + 2)
    c[n + 1], c[n - 1] = 1.0, -1.0
    c /= math.sqrt(4 * n + 2)
    return np.asarray(legendre.legval(x, c)), np.asarray(legendre.legval(x, legendre.legder(c)))
