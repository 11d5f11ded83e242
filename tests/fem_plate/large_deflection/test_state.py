"""A deflected plate: its in-plane motion and membrane forces, energy and balance."""

import axisymmetric_plates as radial
import numpy as np
import pytest

from fem_plate import Plate, PlateSection
from fem_plate.large_deflection.equilibrium import NotConverged
from meshes import disc, rectangle

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)
TWO = [(0.3, 0.1), (-0.25, -0.35)]


@pytest.fixture(scope="module", params=["airy", "plane-stress"])
def lifted(request):
    """A clamped disc with its centre at 2 t, and the same in one dimension."""
    plate = Plate(disc(1.0, 0.15), UNIT)
    return plate.large_deflection([(0, 0)], membrane=request.param).solve([2.0]), radial.disc(height=2.0)


def on_rays(r):
    angle = np.linspace(0.1, 6, len(r))
    outwards = np.column_stack([np.cos(angle), np.sin(angle)])
    return r[:, None] * outwards, outwards, np.column_stack([-outwards[:, 1], outwards[:, 0]])


def test_in_plane_motion(lifted):
    state, expected = lifted
    r = np.linspace(0.02, 1.0, 20)
    xy, outwards, along = on_rays(r)
    u = state.in_plane(xy)
    motion = radial.at_radii(expected, expected.u(0.3), r)
    assert np.abs((u * outwards).sum(axis=1) - motion).max() < 1e-4 * np.abs(expected.u(0.3)).max()
    assert np.abs((u * along).sum(axis=1)).max() < 1e-4 * np.abs(expected.u(0.3)).max()


def test_membrane_force(lifted):
    state, expected = lifted
    r = np.linspace(0.1, 0.98, 20)
    xy, outwards, along = on_rays(r)
    N = state.membrane_force(xy)
    across = np.einsum("ni,nij,nj->n", outwards, N, outwards)
    round_about = np.einsum("ni,nij,nj->n", along, N, along)
    shear = np.einsum("ni,nij,nj->n", outwards, N, along)
    bound = 1e-3 * expected.N_r.max()
    assert np.abs(across - radial.at_radii(expected, expected.N_r, r)).max() < bound
    assert np.abs(round_about - radial.at_radii(expected, expected.N_theta, r)).max() < bound
    assert np.abs(shear).max() < bound


def test_gradient_and_energy(lifted):
    state, expected = lifted
    r = np.linspace(0.01, 0.99, 20)
    xy, outwards, _ = on_rays(r)
    slope = (state.evaluate(xy)[1] * outwards).sum(axis=1)
    assert np.abs(slope - radial.at_radii(expected, expected.slope, r)).max() < 5e-5 * np.abs(expected.slope).max()
    assert state.energy == pytest.approx(expected.bending + expected.stretching, rel=3e-6)
    assert state.stretching_energy == pytest.approx(expected.stretching, rel=1e-5)


@pytest.mark.slow
def test_both_membranes_move_alike():
    """Actuators off every symmetry, on a square, where both geometries are exact."""
    plate = Plate(rectangle(2.0, 2.0, 0.3), UNIT)
    states = [plate.large_deflection(TWO, membrane=name).solve([1.0, -0.6]) for name in ("airy", "plane-stress")]
    xy = np.random.default_rng(0).uniform(-0.95, 0.95, (40, 2))
    u = [state.in_plane(xy) for state in states]
    N = [state.membrane_force(xy) for state in states]
    assert np.abs(u[0] - u[1]).max() < 5e-4 * np.abs(u[1]).max()
    assert np.abs(N[0] - N[1]).max() < 2e-2 * np.abs(N[1]).max()
    assert states[0].reactions == pytest.approx(states[1].reactions, rel=2e-5)


def test_motions_in_the_plane_are_the_sum_of_both_components_of_all_functions():
    plane = (
        Plate(disc(1.0, 0.4), UNIT).large_deflection(TWO).solved(np.array([1.0, -0.6]), 0.0, 0, 0).discrete.plane_stress
    )
    rng = np.random.default_rng(0)
    x, u = rng.uniform(-0.6, 0.6, (20, 2)), rng.normal(size=(len(plane.membrane.reduce(np.zeros(plane.basis.N))), 3))
    value, gradient = np.zeros((20, 2, 3)), np.zeros((20, 2, 2, 3))
    triangle, everything = plane.space.triangle_of(x), plane.membrane.expand(u)
    local = plane._local(x, triangle)
    for i in range(plane.basis.Nbfun):
        (function,) = plane.basis.elem.gbasis(plane.basis.mapping, local, i, triangle)
        weight = everything[plane.basis.element_dofs[i, triangle]]
        value += np.einsum("an,nc->nac", np.asarray(function)[..., 0], weight)
        gradient += np.einsum("abn,nc->nabc", function.grad[..., 0], weight)
    assert np.array_equal(plane.values(x, u), value)
    assert np.array_equal(plane.gradients(x, u), gradient)


@pytest.mark.slow
def test_energy_bracket_closes():
    """The Airy function's stretching energy of one and the same w is the lower, in-plane motion's the upper bound."""
    gaps = []
    large = Plate(rectangle(2.0, 2.0, 0.5), UNIT).large_deflection([(0.2, 0.1)])
    for halvings in (0, 1):
        state = large.solved(np.array([1.5]), 0.0, 0, halvings)
        discrete = state.discrete
        other = discrete.plane_stress.membrane
        above = other.respond(discrete.equilibrium.slopes_at(other.samples, state.coefficients))[1]
        below = state.coefficients.stretching
        assert below < above
        gaps.append((above - below) / below)
    assert gaps[1] < gaps[0] / 4
    assert gaps[1] < 1e-4


def test_energy_is_the_work_of_the_reactions():
    large, heights = Plate(disc(1.0, 0.4), UNIT).large_deflection(TWO), np.array([2.0, -1.0])
    nodes, weights = np.polynomial.legendre.leggauss(4)
    work = 0.0
    for node, weight in zip((nodes + 1) / 2, weights / 2, strict=True):
        work += weight * heights @ large.solve(node * heights).reactions
    assert large.solve(heights).energy == pytest.approx(work, rel=3e-6)


@pytest.mark.slow
def test_forces_and_moments_on_a_free_plate_balance():
    """Forces to rounding. Moments as far as in-plane motion makes up for the strain of a rotation, as the mesh does."""
    points = np.array([(0.5, 0.1), (-0.3, 0.5), (-0.3, -0.5), (0.1, 0.0)])
    state = Plate(disc(1.0, 0.4), UNIT, "free").large_deflection(points).solve([0.0, 0.5, 0.3, 1.5])
    P = state.reactions
    assert abs(P.sum()) < 1e-9 * np.abs(P).max()
    assert np.abs(points.T @ P).max() < 1e-6 * np.abs(P).max()
    assert np.abs(P).min() > 0.1


@pytest.mark.slow
def test_pressure_on_a_free_plate_is_borne_by_its_actuators():
    points = np.array([(0.5, 0.1), (-0.3, 0.5), (-0.3, -0.5)])
    state = Plate(disc(1.0, 0.3), UNIT, "free").large_deflection(points).solve([0.0, 0.5, 0.3], 20.0)
    assert state.reactions.sum() == pytest.approx(-20.0 * np.pi, rel=1e-7)
    assert np.abs(points.T @ state.reactions).max() < 1e-6 * 20 * np.pi


def test_a_tolerance_is_met():
    plate = Plate(disc(1.0, 0.4), UNIT, tolerance=2e-7)
    state = plate.large_deflection([(0, 0)]).solve([1.0])
    assert state.error_estimate <= 2e-7
    assert state.reactions == pytest.approx([radial.disc(height=1.0).force], rel=2e-7)


def test_no_equilibrium_is_an_error(monkeypatch):
    monkeypatch.setattr("fem_plate.large_deflection.equilibrium.MAX_STEPS", 2)
    with pytest.raises(NotConverged, match="no equilibrium after 2 steps; the last one changed w by"):
        Plate(disc(1.0, 0.4), UNIT).large_deflection([(0, 0)]).solve([10.0])
