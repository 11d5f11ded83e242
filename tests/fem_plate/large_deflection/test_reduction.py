"""A stretching plate in a few shapes: its forms and energies beside those of the whole plate."""

import numpy as np
import pytest
from reduced_solver import energy, reduced_equilibrium

from fem_plate import Excitation, HeldShapes, Plate, PlateSection
from fem_plate.large_deflection import Columns, mode_columns, reduce, with_modes
from fem_plate.large_deflection.equilibrium import Loads
from fem_plate.large_deflection.full_solutions import FullSolutions
from fem_plate.large_deflection.reduction import deflected, estimated_error, measured_error, project
from meshes import disc

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0)
POINTS = [[0.3, 0.1], [-0.25, -0.35]]
STROKES = np.array([[1.0, 0.6], [1.0, 0.0], [0.0, 0.6], [0.5, 0.3], [0.3, 0.6], [0.8, 0.5]])
ELSEWHERE = np.array([0.7, 0.2])


def corrections_of(plate, strokes):
    return reduced_equilibrium(plate, strokes).corrections[0]


@pytest.fixture(scope="module")
def discrete():
    return Plate(disc(1.0, 0.5), UNIT).large_deflection(POINTS).discrete(0, 0)


@pytest.fixture(scope="module")
def known(discrete):
    known = FullSolutions(discrete, np.array([1.0, 0.6]), corrections_of)
    known.add(STROKES[0], None)
    known.add(STROKES[1], None)
    return known


def test_the_energy_is_that_of_the_whole_plate(discrete, known):
    """Of two states with the same strokes: a full solution, and the plate without corrections, a little from below."""
    model, equilibrium, loads = project(known, 1e-9), discrete.equilibrium, Loads(STROKES[0], 0.0)
    c = corrections_of(model.plate, STROKES[0])
    reduced = [energy(model.plate, each, STROKES[0]) for each in (c, 0 * c)]
    whole = [
        equilibrium.energy(state, loads) for state in (deflected(known, model, STROKES[0]), equilibrium.linear(loads))
    ]
    raised = whole[1] - whole[0]
    assert (1 - 1e-4) * raised < reduced[1] - reduced[0] < raised


def test_a_model_of_few_solutions_is_off_elsewhere_by_about_its_estimate(known):
    model = project(known, 1e-9)
    assert estimated_error(known, model, STROKES[0]) < 1e-6
    estimate = estimated_error(known, model, ELSEWHERE)
    count = len(known)
    measured = measured_error(known, model, ELSEWHERE)
    assert len(known) == count + 1
    assert measured / 2 < estimate < 2 * measured and measured > 1e-5


def test_a_reduction_meets_its_tolerance_where_it_was_not_made(discrete):
    told = []
    reduction = reduce(discrete, STROKES, 1e-4, corrections_of, lambda *progress: told.append(progress))
    full = discrete.equilibrium.solve(Loads(ELSEWHERE, 0.0)).state
    c = corrections_of(reduction.plate, ELSEWHERE)
    few = Columns.joined([reduction.linear, reduction.corrections]).weighted(np.append(ELSEWHERE, c)[:, None])
    off = discrete.equilibrium.change(few.v[:, 0] - full.v, few.extra[:, 0] - full.extra)
    assert off < 1e-4 * discrete.equilibrium.change(full.v, full.extra)
    assert reduction.error < 1e-4 and reduction.solutions > told[-1][0] >= 2
    assert [solutions for solutions, _ in told] == sorted({solutions for solutions, _ in told})


def test_a_start_does_not_change_a_solution(discrete):
    equilibrium = discrete.equilibrium
    far = equilibrium.solve(Loads(STROKES[0], 0.0))
    near = equilibrium.solve(Loads(STROKES[0], 0.0), equilibrium.solve(Loads(1.02 * STROKES[0], 0.0)).state)
    assert equilibrium.change(far.state.v - near.state.v, far.state.extra - near.state.extra) < 1e-8
    assert near.forces == pytest.approx(far.forces, rel=1e-8)


@pytest.mark.parametrize("membrane", ["airy", "plane-stress"])
def test_with_modes_the_plate_stretches_as_the_whole_plate_in_the_same_shape(membrane):
    """Not only in equilibrium: for any strokes, swings of modes and corrections up to the amplitudes it is made for."""
    discrete = Plate(disc(1.0, 0.5), UNIT).large_deflection(POINTS, membrane=membrane).discrete(0, 0)
    reduction = reduce(discrete, STROKES, 1e-3, corrections_of)
    shapes = HeldShapes(reduction, np.array(POINTS), np.full(len(POINTS), np.inf))
    modes = mode_columns(discrete, shapes.springs, Excitation(shapes, 1.0, UNIT.rigidity).modes())
    modes = modes.weighted(np.eye(modes.v.shape[1])[:, :2])
    amplitudes = STROKES.max(axis=0), np.array([0.5, 0.2]), np.full(reduction.corrections.v.shape[1], 0.05)
    off = []
    for least in (1e-4, 1e-6):
        both = with_modes(reduction, modes, amplitudes, least)
        largest = np.concatenate([amplitudes[1], np.full(both.corrections.v.shape[1] - 2, 0.02)])
        generator, worst = np.random.default_rng(1), 0.0
        for _ in range(8):
            strokes, c = amplitudes[0] * generator.uniform(-1, 1, 2), largest * generator.uniform(-1, 1, len(largest))
            linear, added = both.linear.weighted(strokes[:, None]), both.corrections.weighted(c[:, None])
            whole = discrete.equilibrium.at((linear.v + added.v)[:, 0], (linear.extra + added.extra)[:, 0], 0.0)
            stretching = energy(both.plate, c, strokes) - 0.5 * c @ both.plate.stiffness @ c
            worst = max(worst, abs(stretching / whole.stretching - 1))
        off.append(worst)
    print("stretching energies differ by", " and ".join(f"{each:.1e}" for each in off))
    assert off[0] < 1e-5 and off[1] < 1e-9
