"""Plate: a mesh, a section and its supports, ready to be loaded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from common import draw, notebook_html
from fem_plate import modes
from fem_plate.arrays import PatchedShapes, ProgressCallback, patched_shapes
from fem_plate.deflection import Deflection, refined
from fem_plate.graded import GradedPlate
from fem_plate.influence import MAX_DENSE, InfluenceShapes
from fem_plate.inputs import one_per_point, places_on, stiffness_per_point
from fem_plate.modes import HeldPlate, Modes
from fem_plate.sections import Field, Section
from fem_plate.stability import buckling_load, check_stability, warn_of_polygon, warn_of_wedges
from fem_plate.types import FloatArray
from meshes import PlateMesh

if TYPE_CHECKING:
    from skfem import BilinearForm

    from common import Axes, Figure
    from fem_plate.large_deflection import DeflectedPlate, LargeDeflection


TRUNCATION = 1e-6  # of unit shapes on patches, by default


class Plate(GradedPlate):
    """A Kirchhoff-Love plate.

    Parameters
    ----------
    mesh : PlateMesh
        The outline and its cells.
    section : PlateSection, AnisotropicSection or VaryingSection
        Material and thickness.
    supports : str or mapping of str to str
        "clamped", "simply-supported" or "free", of the whole rim or by boundary; boundaries left out are free.
    tolerance : float, optional
        Refine shapes and deflections until their error estimate, relative to the largest deflection, meets it, or until
        100 000 unknowns; `error_estimate` is what was reached. Shapes on patches get somewhat finer cells instead.
        Modes ignore it; their `error_estimate` says how good they are.
    tension : float
        Residual force per length N0 in the plate's plane, the same in all directions [N/m]: positive pulls, negative
        presses. It stays what it is while the plate bends. Every boundary must be held then.
    foundation : float or callable
        Winkler's modulus of an elastic foundation under all of the plate [N/m^3]: it pulls back by so much pressure for
        each metre. As a callable it returns the modulus (n,) at x and y, both (n,) [m]. Negative softens, as an
        electrode does.
    forms : sequence of skfem.BilinearForm
        More of the plate's energy, in SI units: each is symmetric and bilinear in the value, gradient and Hessian of u
        and v, and depends on places by `w.x` alone.

    Raises
    ------
    ValueError
        Names every unknown support and boundary; the tolerance is not positive; there is a tension where a boundary
        is free; thickness, foundation or a form is not valid somewhere on the plate, and the message names the place;
        or compression, foundation and forms make the plate buckle without actuators.

    Warns
    -----
    UserWarning
        A simply supported rim of many straight sides looks like a round one's polygon, which is another plate.
    """

    def __init__(
        self,
        mesh: PlateMesh,
        section: Section,
        supports: str | Mapping[str, str] = "clamped",
        tolerance: float | None = None,
        tension: float = 0.0,
        foundation: float | Field = 0.0,
        forms: Sequence[BilinearForm] = (),
    ) -> None:
        if tolerance is not None and not tolerance > 0:
            raise ValueError(f"Input tolerance of Plate must be greater than 0; got {tolerance!r}")
        super().__init__(mesh, section, supports, tolerance, tension, foundation, forms)
        warn_of_polygon(self)
        warn_of_wedges("on a foundation, with forms, or that is not isotropic and uniform", self.left_out)
        if self.energy is not None and self.energy.may_soften:
            check_stability(self, max(self.tension, 0.0))
        if tension < 0 and -tension >= (load := self.buckling_load()):
            raise ValueError(
                f"Input tension of Plate must exceed {-load:.6g} N/m, at which it buckles; got {self.tension!r}"
            )

    def as_meshed(self, tension: float | None = None) -> Plate:
        """The plate on the mesh as it is, without a tolerance; tension: another one [N/m]."""
        pulled = self.tension if tension is None else tension
        return Plate(self.mesh, self.section, self.supports, None, pulled, self.foundation, self.forms)

    def buckling_load(self) -> float:
        """The compression, the same in all directions, at which the plate buckles without actuators [N/m].

        It is D mu with the lowest mu of a(v, q) = mu int grad v.grad q, whatever tension the plate has, with a the form
        of bending, foundation and users' forms.

        Raises
        ------
        ValueError
            A boundary is free, or foundation and forms make the plate buckle by themselves.
        """
        return buckling_load(self)

    def influence(
        self,
        points: ArrayLike,
        stiffness: ArrayLike | None = None,
        truncation: float | None = None,
        tell: ProgressCallback = lambda done, of: None,
        free_motions: bool = False,
    ) -> InfluenceShapes | PatchedShapes:
        """The influence shapes of actuators.

        Parameters
        ----------
        points : (N, 2) array_like
            Places of the actuators [m], inside the rim or, without a truncation, on a free boundary.
        stiffness : float or (N,) array_like, optional
            Stiffness of the actuators [N/m], springs in series with their strokes: inf is rigid (the default); 0 is a
            floating actuator, driven by a force.
        truncation : float, optional
            Compute the shapes on patches, and cut each off where it is below this fraction of its largest deflection.
            More than 2 000 actuators are always computed so, with a truncation of 1e-6 by default.
        tell : callable, optional
            Called with the number of tiles of patches done, and their total.
        free_motions : bool
            Accept that supports and actuators, none of them floating, leave the plate rigid motions. Each shape is
            then orthogonal to these over the plate, as a plate with mass moves. Not with a truncation.

        Raises
        ------
        ValueError
            Names every point that coincides with another, or is not inside the rim by more than 6e-4 of half the
            plate's longer side; or a stiffness is negative, or
            supports and actuators leave the plate a rigid motion that they may not.
        """
        on_patches = truncation is not None or np.size(points) > 2 * MAX_DENSE
        points = places_on(self.mesh, points, "influence", least=1, free=() if on_patches else self.free_boundaries)
        actuator_stiffness = stiffness_per_point(stiffness, len(points), "influence", may_float=True)
        shapes: InfluenceShapes | PatchedShapes
        if on_patches:
            cut = TRUNCATION if truncation is None else truncation
            if self.energy is not None:
                raise ValueError(
                    f"Input points of influence must be at most {MAX_DENSE}, without a truncation, on a plate with a "
                    f"foundation, forms, a varying thickness, or a tension on an anisotropic section; got {len(points)}"
                )
            warn_of_wedges("on patches", len(self.enriched_corners))
            shapes = patched_shapes(self, points, actuator_stiffness, cut, tell)
        else:
            rigidity = self.section.rigidity
            model, gain = self.refinement(points)
            shapes = refined(
                lambda level: InfluenceShapes(
                    model(level), points, rigidity, actuator_stiffness, free_motions, partial(model, level + 1)
                ),
                self.tolerance,
                gain,
            )
        shapes.plate = self
        return shapes

    def large_deflection(
        self,
        points: ArrayLike,
        in_plane_supports: str | Mapping[str, str] = "immovable",
        stiffness: ArrayLike | None = None,
        membrane: str | None = None,
    ) -> LargeDeflection:
        """The plate with actuators in von Karman's theory, which stretches as it bends.

        Parameters
        ----------
        points : (N, 2) array_like
            Places of the actuators [m]; there may be none.
        in_plane_supports : str or mapping of str to str
            "immovable" or "movable", whether the rim is held in its plane: of all boundaries that `supports` hold, or
            by boundary. Free boundaries, and those that a mapping leaves out, are movable.
        stiffness : float or (N,) array_like, optional
            As for `influence`.
        membrane : str, optional
            How to compute stretching: "airy", by Airy's stress function, the default where it applies (plates without
            holes whose rim is immovable, or movable and clamped); or "plane-stress", by in-plane motion.

        Returns
        -------
        large_deflection : LargeDeflection
            Solves for strokes and a pressure.

        Raises
        ------
        ValueError
            As for `influence`; an in-plane support or boundary is unknown; the membrane does not apply; the plate has a
            tension, a foundation or forms, or a section that is not a `PlateSection`.
        """
        # Here, as scikit-fem takes a while.
        from fem_plate.large_deflection import LargeDeflection, check_stretches, movable_by_boundary

        check_stretches(self, "large_deflection")
        points = places_on(self.mesh, points, "large_deflection")
        actuator_stiffness = stiffness_per_point(stiffness, len(points), "large_deflection", may_float=True)
        movable = movable_by_boundary(in_plane_supports, self.supports)
        warn_of_wedges("that stretches", len(self.enriched_corners))
        return LargeDeflection(self, points, actuator_stiffness, movable, membrane)

    def deflection(self, points: ArrayLike, forces: ArrayLike, pressure: float = 0.0) -> Deflection:
        """The plate under forces and a uniform pressure, both positive up.

        Where the supports leave the plate a rigid motion, mean deflection and mean slope vanish.

        Parameters
        ----------
        points : (N, 2) array_like
            Where the forces act [m], inside the rim or on a free boundary.
        forces : float or (N,) array_like
            [N].
        pressure : float
            [Pa].

        Raises
        ------
        ValueError
            As for `influence`; or there is not one force per point, a load is not finite, or the loads on a plate that
            can move rigidly are not in balance.
        """
        points = places_on(self.mesh, points, "deflection", free=self.free_boundaries)
        loads = one_per_point(forces, len(points), "forces of deflection")
        if not (np.isfinite(loads).all() and np.isfinite(pressure)):
            raise ValueError("Input forces and pressure of deflection must be finite; got some that are not")
        rigidity = self.section.rigidity
        model, gain = self.refinement(points)
        return refined(
            lambda level: Deflection(model(level), points, loads, float(pressure), rigidity), self.tolerance, gain
        )

    def pressure(self, load: float) -> Deflection:
        """The plate under a uniform pressure `load` [Pa], positive up; raises as `deflection` does."""
        return self.deflection(np.empty((0, 2)), np.empty(0), load)

    def frequencies(self, count: int, held: ArrayLike | None = None, stiffness: ArrayLike | None = None) -> FloatArray:
        """The lowest natural frequencies (count,) [Hz], ascending, repeated ones repeated; raises as `modes` does."""
        return self.modes(count, held, stiffness).frequencies

    def modes(
        self,
        count: int,
        held: ArrayLike | None = None,
        stiffness: ArrayLike | None = None,
        deflected: DeflectedPlate | None = None,
    ) -> Modes:
        """The lowest modes of vibration, without motions that bend nothing and stretch no spring.

        Parameters
        ----------
        count : int
            Number of modes.
        held : (N, 2) array_like, optional
            Points that actuators hold still [m], inside the rim or, of the flat plate, on a free boundary.
        stiffness : float or (N,) array_like, optional
            Stiffness of those actuators [N/m]; inf is rigid (the default).
        deflected : DeflectedPlate, optional
            A state of `large_deflection` to vibrate about; by default the flat plate. Held points are among its
            actuators; the others keep their force.

        Raises
        ------
        ValueError
            The section has no density, the count or a stiffness is not positive, a held point is not inside the rim or
            coincides with another, or there are more than 2 000 of them; or the
            deflected state has no actuator at a held point, or is not stable.
        """
        density = self.section.density
        if density is None:
            raise ValueError("Input density of PlateSection must be given for frequencies; got None")
        free = self.free_boundaries if deflected is None else ()
        points = places_on(self.mesh, [] if held is None else held, "modes", "held", MAX_DENSE, free=free)
        actuator_stiffness = stiffness_per_point(stiffness, len(points), "modes", may_float=False)
        model = self.model(points) if deflected is None else deflected.discrete.model
        max_count = model.unknowns // 2 - 1
        if not (isinstance(count, int | np.integer) and 1 <= count <= max_count):
            raise ValueError(f"Input count of modes must be a whole number from 1 to {max_count}; got {count!r}")
        inertia = density * self.section.thickness
        if deflected is not None:
            return deflected.modes(count, points, actuator_stiffness, inertia)
        return self._modes(points, actuator_stiffness, count, inertia, 0)

    def _modes(self, points: FloatArray, stiffness: FloatArray, count: int, inertia: float, halvings: int) -> Modes:
        held_plate = HeldPlate(self.model(points, halvings), points, self.section.rigidity, stiffness)
        refine = partial(self._modes, points, stiffness, count, inertia, halvings + 1)
        return modes.modes(held_plate, count, inertia, refine)

    def plot(self, axes: Axes | None = None) -> Figure:
        """Draw the rim by its supports and the mesh, into axes in m or new ones."""
        return draw(self, axes)

    _repr_html_ = notebook_html
