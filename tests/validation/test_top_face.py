"""Parts on the top face of a bent plate, some of which also stretch, against `motion_oracle`.

The oracle differentiates places in space by Taylor arithmetic (`top_face`) and shares no formula with the integrator.
What it found is written down in `top_face_results`; the slow test finds some of it again.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from motion_cases import NAMES, path_length
from scipy.optimize import brentq
from top_face import top_face
from top_face_cases import CASES, G, stretched
from top_face_results import RESULTS

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import CoulombAdhesion, Drive, Micropart, polynomial_surface, simulate

pytestmark = pytest.mark.compiled

TOLERANCE, NEAR, PROMPT = 1e-12, 1e-7, 1e-6  # ends over the length of the path, events over their time
REPEATS = 5e-9  # how well the oracle finds again what is written down
V = np.array([0.3, -0.7])


def check(path, expected, near, prompt):
    """`path`: end, events as (kind, time), dissipated and kinetic energy [J]."""
    end, events, dissipated, kinetic = path
    assert [kind for kind, _ in events] == [kind for kind, _ in expected.events]
    assert [time for _, time in events] == pytest.approx([time for _, time in expected.events], rel=prompt, abs=1e-17)
    assert math.dist(end, expected.end) < near * expected.length
    assert (dissipated, kinetic) == pytest.approx((expected.dissipated, expected.kinetic), rel=10 * near)


def of_package(run):
    events = [(NAMES[event.kind.name], event.time) for event in run.events]
    return run.position[-1], events, run.energy.dissipated[-1], run.energy.kinetic[-1]


@pytest.mark.parametrize("name", CASES)
def test_a_path_on_the_top_face_is_the_oracle_s(name):
    run = CASES[name].simulate(TOLERANCE)
    check(of_package(run), RESULTS[name], NEAR, PROMPT)
    assert run.energy.balance < NEAR


def test_the_default_tolerance_gives_the_reference_to_a_millionth_of_its_path():
    check(of_package(CASES["one actuator"].simulate(1e-9)), RESULTS["one actuator"], 1e-6, PROMPT)


@pytest.mark.parametrize("name", [name for name in CASES if name.endswith(", stretched")])
def test_the_motion_in_the_plane_matters(name):
    """Without it these paths end elsewhere, a thousand times farther off than the bound above at least."""
    without = CASES[name.removesuffix(", stretched")].simulate(1e-10)
    assert math.dist(without.position[-1], RESULTS[name].end) > 1e3 * NEAR * RESULTS[name].length


def test_without_the_lengths_the_part_of_the_reference_moves_a_third_as_far():
    flat = CASES["one actuator"].at(0.0, 0.0)
    run = flat.simulate(TOLERANCE)
    assert math.dist(run.position[-1], flat.start) == pytest.approx(9.670575238222e-6, rel=NEAR)
    assert [event.kind.name for event in run.events] == ["SLIPS"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["one actuator", "tilted, squeezed, on a base, stretched"])
def test_the_oracle_finds_again_what_is_written_down(name):
    case, expected = CASES[name], RESULTS[name]
    path = case.trace()
    events = [(kind, time) for kind, time, *_ in path.events]
    check((path.position, events, path.dissipated, path.kinetic), expected, REPEATS, REPEATS)
    assert path_length(path, case.start) == pytest.approx(expected.length, rel=1e-5)


@pytest.mark.parametrize(
    "case, place, time, step, size",
    [
        (CASES["tilted, squeezed, on a base"], (0.3, 0.2), 0.66, 1e-3, 1.0),
        (CASES["two actuators"], (100e-6, -100e-6), 0.9e-3, 1e-6, 1e-3),
        (stretched(CASES["tilted, squeezed, on a base"], 0.2), (0.3, 0.2), 0.66, 1e-3, 1.0),
        (stretched(CASES["two actuators"], 0.2), (100e-6, -100e-6), 0.9e-3, 1e-6, 1e-3),
    ],
    ids=["polynomial", "disc", "stretched polynomial", "stretched disc"],
)
def test_the_oracle_s_acceleration_is_the_difference_of_places(case, place, time, step, size):
    """Along a line at constant X', by the central difference of the eighth order."""
    v = V * size
    surface = top_face(case.height(), 0.03 * size, 0.08 * size, case.base(), case.in_plane())

    def at(moment):
        return surface(*(np.array(place) + (moment - time) * v), moment).frame(v)

    here, weights = at(time), np.array([-9, 128, -1008, 8064, -14350, 8064, -1008, 128, -9]) / 5040
    places = np.array([at(time + k * step).place for k in range(-4, 5)])
    assert here.carried == pytest.approx(weights @ places / step**2, rel=1e-6, abs=1e-7 * np.abs(here.carried).max())
    assert here.normal @ here.centre == pytest.approx([0.0, 0.0], abs=1e-14)
    assert here.normal @ here.contact == pytest.approx([0.0, 0.0], abs=1e-14)


RADIUS, FRICTION = 0.5, 0.2  # m, of the trough


def trough(half_thickness):
    """w = R - sqrt(R^2 - x^2) to the twenty-second order."""
    c = np.zeros((23, 1))
    term = 0.5 / RADIUS
    for n in range(1, 12):
        c[2 * n] = term
        term *= (2 * n - 1) / (2 * n + 2) / RADIUS**2
    return replace(polynomial_surface(c), half_thickness=half_thickness)


@pytest.mark.parametrize(("contact", "height"), [(0.0, 0.0), (0.04, 0.0), (0.0, 0.06), (0.04, 0.06)])
def test_a_block_in_a_trough_turns_about_its_axis(contact, height):
    """With r = R - contact and q = r - height, m q^2 phi'' = -m g q sin phi - F r, F = mu m (q phi'^2 + g cos phi).

    So y = phi'^2 obeys dy/dphi + 2 l y = -2 (g/q) (sin phi + l cos phi), l = mu r/q, on the way up, and it stays where
    tan phi < l.
    """
    r, q = RADIUS - contact, RADIUS - contact - height
    ratio, square, start = FRICTION * r / q, G / q, G / (8 * q)
    cosine = 2 * square * (1 - 2 * ratio**2) / (1 + 4 * ratio**2)
    sine = -2 * ratio * (square + cosine)

    def y(phi):
        return cosine * math.cos(phi) + sine * math.sin(phi) + (start - cosine) * math.exp(-2 * ratio * phi)

    stop = brentq(y, 0.0, 0.5)
    surface, law = trough(contact), CoulombAdhesion(FRICTION, 0.0)
    part = Micropart(1e-3, (0.0, 0.0), (RADIUS * math.sqrt(start), 0.0), centre_height=height)
    run = simulate(surface, part, law, 1.0, tolerance=1e-11)
    assert run.events[0].kind.name == ("STOPS" if math.tan(stop) < ratio else "REVERSES")
    assert run.events[0].position[0] == pytest.approx(RADIUS * math.sin(stop), rel=1e-9)
    assert run.energy.balance < 1e-9
    assert np.abs(run.energy.work).max() < 1e-12 * run.energy.dissipated[-1]  # a surface at rest does none
    for share, outcome in ((0.999, "STUCK"), (1.001, "MOVING")):
        place = RADIUS * math.sin(share * math.atan(ratio))
        run = simulate(surface, Micropart(1e-3, (place, 0.0), centre_height=height), law, 0.01)
        assert run.outcome.name == outcome


@pytest.mark.parametrize(
    ("height", "end"),
    [
        (0.0, (0.00010057507488831754, 0.0002033705915554097)),
        (25e-6, (9.790614614578088e-05, 0.00020820572168610618)),
    ],
)
def test_a_point_with_height_is_the_limit_of_small_faces(height, end):
    """Ends of faces of uniform friction that shrink to a point, by a formulation in the poses of rigid bodies."""
    drives = [Drive(20e-6, 120.0, "cosine", phase=phase) for phase in (0.0, math.pi / 2)]
    surface = surface_motion(DiscShapes([[-3e-4, 0.0], [3e-4, 0.0]], 1e-3), drives)
    part = Micropart(1e-9, (1e-4, 2e-4), centre_height=height)
    run = simulate(replace(surface, half_thickness=10e-6), part, CoulombAdhesion(0.02, 0.0), 0.02, tolerance=1e-11)
    assert math.dist(run.position[-1], end) < 1e-9
