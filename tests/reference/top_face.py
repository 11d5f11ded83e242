"""Surfaces of `motion_oracle` off the mid-plane, by Taylor arithmetic of the places in space alone.

    r(X, t) = P(X, t) + z n(X, t),  P = (X + u(X, t) + base(t), w(X, t)),  n = P_x x P_y / |P_x x P_y|

A jet is an array (20, ...) of Taylor coefficients in (x, y, t) about a place and time, up to the third order: w needs
three for the two of n, and its t^3 enters nowhere. Boggio's function and polynomials are put together from jets of x, y
and t; no derivative is written down.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

import numpy as np
from motion_problem import Frame, Height, Surface
from motion_surfaces import still
from scipy.special import comb

ORDER = 3
MONOMIALS = sorted((m for m in itertools.product(range(ORDER + 1), repeat=3) if sum(m) <= ORDER), key=sum)
INDEX = {m: k for k, m in enumerate(MONOMIALS)}
POWERS = np.array(MONOMIALS)
FLAT = np.ravel_multi_index(POWERS.T, (ORDER + 1,) * 3)
_TRIPLES = sorted(
    (INDEX[tuple(np.add(a, b))], INDEX[a], INDEX[b])
    for a, b in itertools.product(MONOMIALS, repeat=2)
    if sum(a) + sum(b) <= ORDER
)
_TARGET, LEFT, RIGHT = np.array(_TRIPLES).T
STARTS = np.searchsorted(_TARGET, np.arange(len(MONOMIALS)))
X, Y, T, TT, XX, YY = (INDEX[m] for m in [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 2), (2, 0, 0), (0, 2, 0)])
SECOND = [INDEX[m] for m in MONOMIALS if sum(m) == 2]
ONE, OTHER = np.array([np.repeat(range(3), POWERS[k]) for k in SECOND]).T  # the factors of these monomials
RAISED = np.array([[INDEX.get((i + 1, j, k), 0), INDEX.get((i, j + 1, k), 0)] for i, j, k in MONOMIALS])
NEXT, AFTER = np.array([1, 2, 0, 2, 0, 1]), np.array([2, 0, 1, 1, 2, 0])  # of a cross product, plus and minus
FACTORS = np.where(RAISED > 0, POWERS[:, :2] + 1, 0)
Jets = Callable[[float, float, float], np.ndarray]  # x, y, t -> w (20,)


def times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.add.reduceat(a.take(LEFT, 0) * b.take(RIGHT, 0), STARTS, axis=0)


def of(derivatives: Sequence[np.ndarray], a: np.ndarray) -> np.ndarray:
    """f(a), with f and its three derivatives at a's value."""
    d = a.copy()
    d[0] = 0.0
    square = times(d, d)
    jet = times(derivatives[3] / 6 * square + derivatives[2] / 2 * d, d) + derivatives[1] * d
    jet[0] += derivatives[0]
    return jet


def log(a: np.ndarray) -> np.ndarray:
    return of((np.log(a[0]), 1 / a[0], -1 / a[0] ** 2, 2 / a[0] ** 3), a)


def inverse_root(a: np.ndarray) -> np.ndarray:
    f = a[0] ** -0.5
    return of((f, -(f**3) / 2, 3 * f**5 / 4, -15 * f**7 / 8), a)


def drive(height: Height, time: float) -> np.ndarray:
    h, h_t, h_tt = height(time)
    jet = np.zeros(len(MONOMIALS))
    jet[0], jet[T], jet[TT] = h, h_t, h_tt / 2
    return jet


def boggio(points: Sequence[Sequence[float]], radius: float, heights: Sequence[Height]) -> Jets:
    """A clamped disc: 16 pi G = R ln(R/S) + S - R around each source, weighted so that w = h_i at each of them."""
    sources = np.array(points, float) / radius
    size = (sources**2).sum(1)
    scale = radius ** -(POWERS[:, 0] + POWERS[:, 1]).astype(float)

    def terms(place: np.ndarray) -> np.ndarray:
        """Of each source (20, n), with the radius as unit."""
        to = place - sources
        r, s = np.zeros((2, len(MONOMIALS), len(sources)))
        r[[0, X, Y]] = np.maximum((to**2).sum(1), 1e-40), 2 * to[:, 0], 2 * to[:, 1]
        s[0] = place @ place * size - 2 * sources @ place + 1
        s[[X, Y]] = 2 * (np.outer(place, size) - sources.T)
        r[[XX, YY]], s[[XX, YY]] = 1.0, size
        return times(r, log(r) - log(s)) + s - r

    weights = np.linalg.inv(np.array([terms(place)[0] for place in sources]))

    def w(x: float, y: float, time: float) -> np.ndarray:
        moved = np.array([drive(height, time) for height in heights])
        shapes = terms(np.array([x, y]) / radius)
        return scale * times(shapes, (weights @ moved).T).sum(1)

    return w


def polynomial(coefficients) -> Jets:
    """w = sum c[i, j, k] x^i y^j t^k (or c[i, j])."""
    c = np.atleast_3d(np.asarray(coefficients, float))

    orders, powers = np.arange(ORDER + 1)[:, None], np.arange(max(c.shape))
    lowered, binomial = np.maximum(powers - orders, 0), comb(powers, orders)

    def w(x: float, y: float, time: float) -> np.ndarray:
        # Of each variable, the Taylor coefficients (order, power) of its powers.
        of = binomial * np.array([x, y, time])[:, None, None] ** lowered
        of_x, of_y, of_t = (each[:, :n] for each, n in zip(of, c.shape, strict=True))
        by_y_and_t = of_y @ (c @ of_t.T)  # (power of x, order of y, order of t)
        return (of_x @ by_y_and_t.reshape(len(c), -1)).ravel().take(FLAT)

    return w


def driven(shapes: Sequence[np.ndarray], size: float, heights: Sequence[Height]) -> Jets:
    """The sum of polynomials sum c[i, j] (x / size)^i (y / size)^j, each times its height."""
    fixed = [polynomial(c / size ** np.add.outer(*map(np.arange, c.shape))) for c in shapes]

    def u(x: float, y: float, time: float) -> np.ndarray:
        of_place, of_time = [shape(x, y, time) for shape in fixed], [drive(height, time) for height in heights]
        return times(np.transpose(of_place), np.transpose(of_time)).sum(1)

    return u


def top_face(
    w: Jets, contact: float, centre: float, base: Sequence[Height] = (still, still), u: Sequence[Jets] = ()
) -> Surface:
    """The contact and the centre of mass at these heights [m] over the mid-plane, along its normal.

    u: the mid-plane's motion in its plane along x and y; none: it only moves up and down.
    """

    def surface(x: float, y: float, time: float) -> _Lifted:
        place = np.empty((len(MONOMIALS), 3))
        for axis, height in enumerate(base):
            place[:, axis] = drive(height, time)
        for axis, component in enumerate(u):
            place[:, axis] += component(x, y, time)
        place[:, 2] = w(x, y, time)
        place[0, :2] += x, y
        place[X, 0] += 1
        place[Y, 1] += 1
        along = [FACTORS[:, axis, None] * place.take(RAISED[:, axis], 0) for axis in range(2)]
        products = times(along[0].take(NEXT, 1), along[1].take(AFTER, 1))
        across = products[:, :3] - products[:, 3:]
        normal = times(across, inverse_root(times(across, across).sum(axis=1))[:, None])
        return _Lifted(place + contact * normal, place + centre * normal, normal[0])

    return surface


class _Lifted:
    """Jets (20, 3) of the contact's and the centre's place, and the normal."""

    def __init__(self, contact: np.ndarray, centre: np.ndarray, normal: np.ndarray) -> None:
        self.contact, self.centre, self.normal = contact, centre, normal

    def frame(self, v: np.ndarray) -> Frame:
        along = np.array([*v, 1.0])  # (x, y, t) by t
        carried = 2 * (along[ONE] * along[OTHER]) @ self.centre[SECOND]
        r = self.centre
        return Frame(r[0], r[T], carried, self.normal, r[[X, Y]].T, self.contact[[X, Y]].T)
