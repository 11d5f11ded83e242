"""PlateEnergy: the plate's energy at each of its points, as a quadratic form of w and its derivatives."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from numbers import Real
from typing import TYPE_CHECKING

import numpy as np

from fem_plate.anisotropic import AnisotropicSection
from fem_plate.elements.argyris import polynomials
from fem_plate.elements.forms import triangle_quadrature
from fem_plate.elements.space import QUADRATURE
from fem_plate.sections import Field, PlateSection, Section, VaryingSection, values_at
from fem_plate.types import BoolArray, FloatArray
from meshes import PlateMesh

if TYPE_CHECKING:
    from skfem import BilinearForm, DiscreteField


VALUE, GRADIENT, HESSIAN = 0, slice(1, 3), slice(3, 6)  # of the channels (w, w_x, w_y, w_xx, w_xy, w_yy)
ORDERS = np.array([0, 1, 1, 2, 2, 2])
JUMP = 0.05  # of the largest entry: what polynomials may leave in a cell a quarter as large as the mesh's
VARIES = 1e-12  # of the largest entry: less is rounding


@dataclass(frozen=True, eq=False)
class PlateEnergy:
    """The form a(w, q) of a plate on a mesh: bending, a foundation, a tension and forms of users.

    section: its rigidity makes the form dimensionless, and `size` [m] places.  foundation: N/m^3.  tension: N/m.
    points: (n, 2) m, all over the plate, at which the form is examined.
    """

    section: Section
    foundation: float | Field
    tension: float
    forms: Sequence[BilinearForm]
    points: FloatArray
    size: float

    def at(self, xy: FloatArray) -> FloatArray:
        """The matrices (..., 6, 6) at places (..., 2), all dimensionless."""
        places = xy.reshape(-1, 2) * self.size
        own = np.zeros((len(places), JET, JET))
        for k, form in enumerate(self.forms):
            own += form_coefficients(form, places, f"forms[{k}] of Plate")
        own[:, VALUE, VALUE] += self._foundation_at(places)
        own[:, GRADIENT, GRADIENT] += self.tension * np.eye(2)
        own *= self.size ** (4.0 - ORDERS - ORDERS[:, None]) / self.section.rigidity
        own[:, HESSIAN, HESSIAN] += self.section.law * self.relative_thickness(xy).reshape(-1, 1, 1) ** 3
        return own.reshape(*xy.shape[:-1], JET, JET)

    def _foundation_at(self, places: FloatArray) -> FloatArray | float:
        if callable(self.foundation):
            return values_at(self.foundation, places, "foundation of Plate", "N/m^3")
        return self.foundation

    def laws(self, xy: FloatArray) -> FloatArray:
        """The laws of bending (n, 3, 3) at places (n, 2)."""
        return self.at(xy)[:, HESSIAN, HESSIAN]

    def relative_thickness(self, xy: FloatArray) -> FloatArray:
        """The thickness at places (..., 2) over that for reference, (...); so is the mass per area."""
        if not isinstance(self.section, VaryingSection):
            return np.ones(xy.shape[:-1])
        return self.section.relative_thickness(xy.reshape(-1, 2) * self.size).reshape(xy.shape[:-1])

    @cached_property
    def _at_points(self) -> FloatArray:
        return self.at(self.points / self.size)

    def _has(self, rows: slice | int, columns: slice | int) -> bool:
        return bool(np.any(self._at_points[:, rows, columns]))

    @property
    def uniform_law(self) -> bool:
        """Whether the law of bending is the same everywhere."""
        laws = self._at_points[:, HESSIAN, HESSIAN]
        return bool(np.ptp(laws, axis=0).max() <= VARIES * np.abs(laws).max())

    @property
    def exponent(self) -> float:
        """What w less the response of the infinite plate with the law at an actuator is there, r^(exponent + 1) ln r.

        inf where it is as smooth as matters.
        """
        if not self.uniform_law or self._has(GRADIENT, HESSIAN):
            return 2.0
        return 3.0 if self._has(GRADIENT, GRADIENT) or self._has(VALUE, HESSIAN) else math.inf

    def check(self) -> None:
        """ValueError where the law of bending is not positive definite, with the first place."""
        lowest = np.linalg.eigvalsh(self._at_points[:, HESSIAN, HESSIAN])[:, 0]
        if (lowest <= 0).any():
            x, y = self.points[int(np.argmax(lowest <= 0))].tolist()
            raise ValueError(
                f"Input forms of Plate must leave it a positive bending stiffness; it has none at ({x:.6g}, {y:.6g}) m"
            )

    def warn_of_jumps(self, table: FloatArray) -> None:
        """Warn where no polynomial follows the form in a cell.

        table: (n, 21), polynomials at the points of a cell; those of each cell come in succession.
        """
        cells = self._at_points.reshape(-1, len(table), JET * JET)
        scale = np.abs(cells).max(axis=(0, 1))
        rest = np.abs(cells - table @ (np.linalg.pinv(table) @ cells)) / np.where(scale > 0, scale, 1.0)
        if rest.max() > JUMP:
            x, y = self.points[int(np.argmax(rest.max(axis=2)))].tolist()
            warnings.warn(
                f"Thickness, foundation or forms of Plate change abruptly at ({x:.4g}, {y:.4g}) m, inside a cell. No "
                "polynomial follows a jump there, and the error estimate is far too small. Put edges of cells along it",
                stacklevel=5,
            )

    @property
    def may_soften(self) -> bool:
        """Whether what is added to bending may have a negative energy."""
        return callable(self.foundation) or self.foundation < 0 or bool(self.forms)


def plate_energy(
    mesh: PlateMesh, section: Section, foundation: float | Field, tension: float, forms: Sequence[BilinearForm]
) -> PlateEnergy | None:
    """The energy of a plate that has more than a uniform section (isotropic, if it has a tension); else None.

    Raises ValueError, naming the foundation or forms that are of the wrong type, or the first place where one is not
    valid.
    """
    wrong = [
        f"Input forms[{k}] of Plate must be a skfem.BilinearForm; got {form!r}"
        for k, form in enumerate(forms)
        if not callable(getattr(form, "form", None))
    ]
    if not callable(foundation) and not (isinstance(foundation, Real) and math.isfinite(foundation)):
        wrong.append(f"Input foundation of Plate must be a finite number or a callable; got {foundation!r}")
    if wrong:
        raise ValueError("; ".join(wrong))
    uniform = isinstance(section, PlateSection) or (isinstance(section, AnisotropicSection) and not tension)
    if uniform and not callable(foundation) and not foundation and not forms:
        return None
    fine = mesh.refined().refined()
    xy, _ = triangle_quadrature(QUADRATURE)
    one, two, three = np.moveaxis(fine.points[fine.triangles], 1, 0)[..., None, :]
    share = xy + 1 / 3
    inside = one + share[:, :1] * (two - one) + share[:, 1:] * (three - one)
    energy = PlateEnergy(section, foundation, tension, tuple(forms), inside.reshape(-1, 2), mesh.size)
    energy.check()
    if isinstance(section, VaryingSection) or callable(foundation) or forms:
        energy.warn_of_jumps(polynomials(*xy.T))
    return energy


JET = 6  # w and its derivatives to the second
ROUNDING = 1e-9  # of the largest entry at a point


def form_coefficients(form: BilinearForm, xy: FloatArray, name: str) -> FloatArray:
    """The matrices (n, 6, 6) of a form at points (n, 2) [m], in N m, and 1/m of it for each derivative less.

    A form that is bilinear in the value, the gradient and the Hessian of u and v is, at each point, a matrix (6, 6) in
    (w, w_x, w_y, w_xx, w_xy, w_yy). Its entries are what the form returns for u and v that have one of these, each 1,
    and none of the others.

    Raises ValueError where it uses more than `w.x`, or is not real, finite, symmetric and bilinear.
    """
    from skfem import DiscreteField  # here, because it takes a while
    from skfem.assembly.form.form import FormExtraParams

    places = FormExtraParams(x=DiscreteField(np.ascontiguousarray(xy.T)[:, :, None]))

    def returned(u: FloatArray, v: FloatArray) -> FloatArray:
        try:
            with np.errstate(all="ignore"):  # what is not finite is refused below
                result = form.form(_field(u, len(xy)), _field(v, len(xy)), places)
            values = np.broadcast_to(np.nan if result is None else result, (len(xy), 1))[:, 0]
        except (AttributeError, KeyError, TypeError, IndexError, ValueError) as wrong:
            raise ValueError(
                f"Input {name} must be a form of u, v, their gradients and Hessians, and w.x alone: {wrong}"
            ) from None
        if np.iscomplexobj(values):
            raise ValueError(f"Input {name} must be real; it returns complex numbers")
        return values

    entries = np.array([[returned(u, v) for u in np.eye(JET)] for v in np.eye(JET)], dtype=float).transpose(2, 0, 1)
    size = np.abs(entries).max(axis=(1, 2))
    _refuse(~np.isfinite(size), xy, name, "finite")
    asymmetry = np.abs(entries - entries.swapaxes(1, 2)).max(axis=(1, 2))
    _refuse(asymmetry > ROUNDING * size, xy, name, "symmetric in u and v")
    u, v = np.cos(np.arange(JET)), -2 * np.sin(1 + np.arange(JET))
    expected, most = v @ entries @ u, np.abs(v) @ np.abs(entries) @ np.abs(u)
    _refuse(~(np.abs(returned(u, v) - expected) <= ROUNDING * most), xy, name, "linear in u and in v")
    return np.asarray((entries + entries.swapaxes(1, 2)) / 2)


def _refuse(faulty: BoolArray, xy: FloatArray, name: str, what: str) -> None:
    if faulty.any():
        x, y = xy[int(np.argmax(faulty))].tolist()
        raise ValueError(f"Input {name} must be {what} on the plate; it is not at ({x:.6g}, {y:.6g}) m")


def _field(jet: FloatArray, count: int) -> DiscreteField:
    """The field at `count` points that has the value and derivatives of a jet (6,) at each."""
    from skfem import DiscreteField

    w, x, y, xx, xy, yy = np.tile(jet[:, None, None], (1, count, 1))
    return DiscreteField(value=w, grad=np.stack([x, y]), hess=np.array([[xx, xy], [xy, yy]]))
