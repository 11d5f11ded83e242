"""A stretching plate by NGSolve and by fem_plate: time and error of one deflected state, in one run.

    python benchmarks/with_ngsolve_large_deflection.py

A clamped, immovable disc under the central force that deflects it by 1 and by 5 thicknesses. Both get the force. Errors
are those of w at 24 radii against collocation in one dimension (tests/reference/axisymmetric_plates.py), over the
largest w.

NGSolve: w by the C0 interior penalty method (Brenner and Sung, 2005) and in-plane motion u, both of one degree, on a
curved mesh that shrinks towards the force; Newton's method on the von Karman energy, from the linear plate.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import ngsolve as ng
import numpy as np
from with_ngsolve import PENALTY, curved

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "reference"))
import axisymmetric_plates as radial  # noqa: E402

from fem_plate import Plate, PlateSection  # noqa: E402
from meshes import disc  # noqa: E402

NU = 0.3
KAPPA = 12.0
SECTION = PlateSection(youngs_modulus=12 * (1 - NU**2), poisson_ratio=NU, thickness=1.0)
RADII = np.linspace(0.03, 0.95, 24)
ANGLES = np.linspace(0.0, 6.0, len(RADII))
PLACES = np.column_stack([RADII * np.cos(ANGLES), RADII * np.sin(ANGLES)])
HEIGHTS = (1.0, 5.0)
CELLS = (0.4, 0.2)  # of fem_plate
# Degree, cell size, cells over their distance from the force, and their least distance, of NGSolve.
RIVALS = ((4, 0.4, 1.2, 0.1), (4, 0.4, 0.8, 0.03), (6, 0.5, 1.2, 0.03))


def by_ngsolve(
    degree: int, size: float, ratio: float, least: float, force: float, height: float
) -> tuple[np.ndarray, int]:
    """w at PLACES, and the number of unknowns."""
    mesh = curved(size, degree, np.zeros((1, 2)), ratio, least)
    bent = ng.H1(mesh, order=degree, dirichlet="rim", dgjumps=True)
    stretched = ng.VectorH1(mesh, order=degree, dirichlet="rim")
    space = bent * stretched
    (w, u), (q, _) = space.TnT()
    n, gamma = ng.specialcf.normal(2), PENALTY * degree**2 / ng.specialcf.mesh_size

    def hessian(v):  # type: ignore[no-untyped-def]
        return v.Operator("hesse")

    def bend(v):  # type: ignore[no-untyped-def]
        return ng.InnerProduct(hessian(v) * n, n)

    def mean(v):  # type: ignore[no-untyped-def]
        return (bend(v) + ng.InnerProduct(hessian(v.Other()) * n, n)) / 2

    def jump(v):  # type: ignore[no-untyped-def]
        return (ng.grad(v) - ng.grad(v.Other())) * n

    strain = (ng.Grad(u) + ng.Grad(u).trans + ng.OuterProduct(ng.grad(w), ng.grad(w))) / 2
    law = KAPPA * ((1 - NU) * ng.InnerProduct(strain, strain) + NU * ng.Trace(strain) ** 2)
    energy = ng.BilinearForm(space, symmetric=True)
    energy += ng.InnerProduct(hessian(w), hessian(q)) * ng.dx
    energy += (gamma * jump(w) * jump(q) - mean(w) * jump(q) - mean(q) * jump(w)) * ng.dx(skeleton=True)
    energy += (
        gamma * (ng.grad(w) * n) * (ng.grad(q) * n) - bend(w) * (ng.grad(q) * n) - bend(q) * (ng.grad(w) * n)
    ) * (ng.ds(skeleton=True))
    energy += ng.Variation(law / 2 * ng.dx(bonus_intorder=degree))
    load = ng.LinearForm(space)
    load += q(0.0, 0.0)
    load.Assemble()
    load.vec.data *= force

    state = ng.GridFunction(space)
    residual, step, trial = (state.vec.CreateVector() for _ in range(3))
    for count in range(40):
        energy.AssembleLinearization(state.vec)
        energy.Apply(state.vec, residual)
        residual.data -= load.vec
        inverse = energy.mat.Inverse(space.FreeDofs(), inverse="sparsecholesky")
        step.data = -inverse * residual
        if count == 0:  # the linear plate, shrunk to the height that is expected
            state.vec.data = step
            step.data = (height / state.components[0](mesh(0.0, 0.0)) - 1) * state.vec
            state.vec.data += step
            continue
        now = energy.Energy(state.vec) - ng.InnerProduct(load.vec, state.vec)
        share = 1.0
        while True:
            trial.data = state.vec + share * step
            if share < 1e-3 or energy.Energy(trial) - ng.InnerProduct(load.vec, trial) <= now + 1e-9 * abs(now):
                break
            share /= 2
        state.vec.data = trial
        if share == 1.0 and step.Norm() < 1e-6 * state.vec.Norm():
            return state.components[0](mesh(*PLACES.T)).ravel(), space.ndof
    raise RuntimeError("NGSolve's state did not converge")


def by_fem_plate(cell: float, force: float) -> tuple[np.ndarray, int]:
    """w at PLACES, and the number of unknowns."""
    state = Plate(disc(1.0, cell), SECTION).large_deflection([(0, 0)], stiffness=0.0).solve([force])
    return state.evaluate(PLACES)[0], state.unknowns


def main() -> None:
    ng.SetNumThreads(1)
    by_fem_plate(0.4, 1.0)  # imports
    print("height  method                                 unknowns  error of w   time [s]  over fem_plate at 0.2")
    for height in HEIGHTS:
        expected = radial.disc(height=height)
        w = radial.at_radii(expected, expected.w, RADII)
        runs = [(f"fem_plate, cells {cell}", by_fem_plate, (cell, expected.force)) for cell in CELLS]
        runs += [
            (
                f"NGSolve, degree {rival[0]}, cells {rival[1]} to {rival[3]}",
                by_ngsolve,
                (*rival, expected.force, height),
            )
            for rival in RIVALS
        ]
        results = []
        for name, solve, arguments in runs:
            start = time.perf_counter()
            found, unknowns = solve(*arguments)  # type: ignore[operator]
            taken = time.perf_counter() - start
            error = np.abs(found - w).max() / height
            assert error < 2e-2, f"{name} disagrees with one dimension by {error:.1e}"
            results.append((name, unknowns, error, taken))
        ours = results[len(CELLS) - 1][3]
        for name, unknowns, error, taken in results:
            print(f"{height:4.0f} t  {name:37}  {unknowns:8d}  {error:10.1e}  {taken:9.2f}  {taken / ours:8.2f}")


if __name__ == "__main__":
    main()
