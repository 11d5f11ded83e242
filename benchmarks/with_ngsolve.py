"""The problem by NGSolve: the C0 interior penalty method (Brenner and Sung, 2005) of high degree on a curved mesh.

    int H(u):H(q) - sum over edges [ {u_nn} [q_n] + {q_nn} [u_n] - gamma [u_n] [q_n] ],   gamma = 4 degree^2 / h

in two ways: plainly, with point loads and cells that shrink towards the actuators; and with the singular part F
subtracted, the rest taking -F on the rim strongly and -dF/dn by Nitsche's method.
"""

from __future__ import annotations

from functools import partial

import ngsolve as ng
import numpy as np
from netgen.geom2d import SplineGeometry
from problem import ACTUATORS, FloatArray, Run, Solution, forces

from fem_plate.elements import UNIT_STRENGTH, point_load

PENALTY = 4.0
IMAGES = ACTUATORS / (ACTUATORS**2).sum(axis=1)[:, None]
# Degree, mesh size, (how cells shrink,) and the bound on the Hessian's error.
SUBTRACTED = [
    *[(4, 0.3, 0.2), (4, 0.15, 0.06), (4, 0.08, 0.02), (6, 0.3, 2e-2), (6, 0.2, 4e-3), (6, 0.15, 2e-3)],
    *[(8, 0.6, 8e-3), (8, 0.3, 2e-3), (8, 0.2, 2e-4), (8, 0.15, 6e-5)],
    *[(10, 0.6, 1e-3), (10, 0.3, 1e-4), (10, 0.25, 4e-5), (10, 0.2, 4e-6)],
    *[(12, 0.6, 2e-4), (12, 0.4, 8e-5), (12, 0.3, 8e-6), (12, 0.25, 3e-6)],
]
GRADED = [(8, 0.5, 0.8, 8e-4), (8, 0.4, 0.6, 5e-5), (10, 0.5, 0.8, 6e-5), (10, 0.4, 0.6, 1e-6)]
PLAIN = [(4, 0.15, 1.5, 0.03, 0.15), (6, 0.3, 1.5, 0.01, 1e-2), (8, 0.3, 1.2, 0.004, 2e-4)]


def curved(size: float, degree: int, towards: FloatArray | None = None, ratio: float = 1.0, least: float = 0.0):  # type: ignore[no-untyped-def]
    """The disc in cells no larger than `ratio` times their distance from the nearest of the points, or than `least`."""
    geometry = SplineGeometry()
    geometry.AddCircle((0, 0), 1, bc="rim")
    mesh = ng.Mesh(geometry.GenerateMesh(maxh=size))
    while towards is not None:
        vertices = np.array([v.point for v in mesh.vertices])
        corners = vertices[np.array([[v.nr for v in e.vertices] for e in mesh.Elements()])]
        sizes = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        distance = np.linalg.norm(corners.mean(axis=1)[:, None] - towards, axis=2).min(axis=1)
        large = sizes > ratio * np.maximum(distance, least)
        if not large.any():
            break
        for cell in mesh.Elements():
            mesh.SetRefinementFlag(cell, bool(large[cell.nr]))
        mesh.Refine()
    mesh = ng.Mesh(mesh.ngmesh)  # made anew: one that was refined and curved fails at point loads
    mesh.Curve(degree)
    return mesh


def solve(mesh, degree: int, subtract: bool) -> Solution:  # type: ignore[no-untyped-def]
    space = ng.H1(mesh, order=degree, dirichlet="rim", dgjumps=True)
    u, q = space.TnT()
    n, gamma = ng.specialcf.normal(2), PENALTY * degree**2 / ng.specialcf.mesh_size

    def hessian(v):  # type: ignore[no-untyped-def]
        return v.Operator("hesse")

    def bend(v):  # type: ignore[no-untyped-def]
        return ng.InnerProduct(hessian(v) * n, n)

    def mean(v):  # type: ignore[no-untyped-def]
        return (bend(v) + ng.InnerProduct(hessian(v.Other()) * n, n)) / 2

    def slope(v):  # type: ignore[no-untyped-def]
        return ng.grad(v) * n

    def jump(v):  # type: ignore[no-untyped-def]
        return (ng.grad(v) - ng.grad(v.Other())) * n

    energy = ng.BilinearForm(space, symmetric=True)
    energy += ng.InnerProduct(hessian(u), hessian(q)) * ng.dx
    energy += (gamma * jump(u) * jump(q) - mean(u) * jump(q) - mean(q) * jump(u)) * ng.dx(skeleton=True)
    energy += (gamma * slope(u) * slope(q) - bend(u) * slope(q) - bend(q) * slope(u)) * ng.ds(skeleton=True)
    energy.Assemble()
    inverse = energy.mat.Inverse(space.FreeDofs(), inverse="sparsecholesky")

    px, py = ng.Parameter(0), ng.Parameter(0)
    x, y = ng.x - px, ng.y - py
    square = x * x + y * y
    rim_value = -UNIT_STRENGTH / 2 * square * ng.log(square)
    rim_slope = -UNIT_STRENGTH * (ng.log(square) + 1) * (x * n[0] + y * n[1])
    load = ng.LinearForm(space)
    load += rim_slope * (gamma * slope(q) - bend(q)) * ng.ds(skeleton=True)

    answers = []
    for at in ACTUATORS:
        answer = ng.GridFunction(space)
        if subtract:
            px.Set(at[0])
            py.Set(at[1])
            load.Assemble()
            answer.Set(rim_value, ng.BND)
            answer.vec.data += inverse * (load.vec - energy.mat * answer.vec).Evaluate()
        else:
            point = ng.LinearForm(space)
            point += q(*at)
            point.Assemble()
            answer.vec.data = inverse * point.vec
        answers.append(answer)
    there = mesh(*ACTUATORS.T)
    compliance = np.column_stack([answer(there) for answer in answers])
    if subtract:
        compliance += point_load(ACTUATORS, ACTUATORS)[0]
    strengths, total = forces(compliance), ng.GridFunction(space)
    for strength, answer in zip(strengths, answers, strict=True):
        total.vec.data += strength * answer.vec

    def evaluate(xy: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        there = mesh(*xy.T)
        w, gradient, bending = total(there)[:, 0], ng.grad(total)(there), hessian(total)(there).reshape(-1, 2, 2)
        if not subtract:
            return w, gradient, bending
        f, f_x, f_xx = point_load(xy, ACTUATORS)
        return (
            w + f @ strengths,
            gradient + np.einsum("njd,j->nd", f_x, strengths),
            bending + np.einsum("njde,j->nde", f_xx, strengths),
        )

    return Solution(sum(space.FreeDofs()), evaluate)


def runs() -> list[Run]:
    found = []
    for degree, size, ratio, least, bound in PLAIN:
        mesh = partial(curved, size, degree, ACTUATORS, ratio, least)
        found.append(Run("NGSolve, point loads", mesh, partial(solve, degree=degree, subtract=False), bound))
    for degree, size, bound in SUBTRACTED:
        name = f"NGSolve degree {degree}, subtracted"
        found.append(Run(name, partial(curved, size, degree), partial(solve, degree=degree, subtract=True), bound))
    for degree, size, ratio, bound in GRADED:
        mesh = partial(curved, size, degree, IMAGES, ratio)
        name = f"NGSolve degree {degree}, subtracted, graded"
        found.append(Run(name, mesh, partial(solve, degree=degree, subtract=True), bound))
    return found
