"""Trajectory.at against runs that end at those times, at a much tighter tolerance."""

import numpy as np
import pytest
from driven_surface import driven, level

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import ConstantFriction, CoulombAdhesion, Drive, EventKind, KogutEtsion, Micropart, State, simulate

G, MASS = 9.80665, 2e-9


def plate(radius=300e-6):
    return surface_motion(
        DiscShapes([[90e-6, 40e-6], [-60e-6, 120e-6]], radius), [Drive(150e-6, 300), Drive(90e-6, 450)]
    )


def shaken():
    """A tilted incline, shaken so that the part hops, slides and rests in each period."""
    shapes = [[[0.0, 0.1], [-0.15, 0.0]], [[1.0, 0.02], [0.03, 0.0]]]
    return driven([level(), Drive(4e-3, 20.0, "cosine")], shapes, size=1e-2)


def platform():
    """Two drives out of step: break-aways along turning pulls, and stops."""
    base = (Drive(0.05, 3.4, cycles=1), Drive(0.03, 3.4, cycles=1, delay=0.04))
    return driven([level(0.0)], base=base, size=0.05)


def rocking():
    """An incline: a part that is pushed straight up turns back; then the incline's slope across it rocks."""
    shapes = [[[0.0, 0.1], [0.6, 0.0]], [[0.0, 0.2], [0.0, 0.0]]]
    return driven([level(), Drive(1.0, 1.5, delay=0.3)], shapes)


CASES = {
    "plate": (plate, Micropart(MASS, (25e-6, 95e-6)), ConstantFriction(20.9 * MASS), 3e-3),
    "plate, hardly stopping": (plate, Micropart(MASS, (20e-6, 100e-6)), ConstantFriction(20.9 * MASS), 3e-3),
    "rough": (plate, Micropart(MASS, (20e-6, 100e-6)), KogutEtsion.paper(), 3e-3),
    "shaken": (shaken, Micropart(MASS, (0.0, 0.0)), CoulombAdhesion(0.15), 0.2),
    "platform": (platform, Micropart(MASS, (0.0, 0.0)), CoulombAdhesion(0.3), 1.0),
    "rocking": (rocking, Micropart(MASS, (0.0, 0.0), (1.2, 0.2)), CoulombAdhesion(0.4), 0.8),
    "squeezed": (platform, Micropart(MASS, (0.0, 0.0), (0.2, 0.1), squeeze=2 * MASS), CoulombAdhesion(0.3), 1.0),
}

# Of place, velocity, height, load and friction, in tolerances. On the plate a part stops where friction hardly holds.
BOUNDS = {False: np.array([5, 20, 3, 3, 3]), True: np.array([15, 2000, 5, 500, 50])}


@pytest.fixture(scope="module", params=CASES)
def case(request):
    """A path's surface, its run to any time at any tolerance, times all over it and close to its events, and truths."""
    surface, part, law, end = CASES[request.param]
    surface = surface()

    def run(tolerance, until=end):
        return simulate(surface, part, law, until, tolerance=tolerance, after_detachment="fly")

    events = np.array([e.time for e in run(1e-11).events])
    times = np.random.default_rng(3).uniform(0, end, 25)
    for since in (-1e-3, -1e-4, -1e-5, 1e-6, 1e-5, 1e-4, 1e-3):
        times = np.append(times, events[:6] + since * end)
    times = np.sort(times[(times > 0) & (times < end)])
    return surface, run, times, [run(1e-11, float(time)) for time in times], events, BOUNDS[surface.sources.size > 0]


@pytest.mark.compiled
@pytest.mark.parametrize("tolerance", [1e-6, 1e-7, 1e-9])
def test_samples_are_as_good_as_runs_that_end_there(case, tolerance):
    surface, run, times, truths, events, bounds = case
    path = run(tolerance)
    samples = path.at(times)
    ours = np.array([e.time for e in path.events])
    if len(ours) < len(events):
        # Within the tolerance it may also pass by a stop that the truth hardly makes; its place is as good.
        assert tolerance == 1e-6 and surface.sources.size > 0
        ends = np.array([truth.position[-1] for truth in truths])
        assert np.abs(samples.position - ends).max() / surface.size < bounds[0] * tolerance
        return
    early, late = np.minimum(ours, events), np.maximum(ours, events)
    speed, load, friction = (np.abs(row).max() for row in (path.velocity, path.normal_force, path.friction_force))
    compared, worst = 0, np.zeros(5)
    for k, truth in enumerate(truths):
        assert truth.time[-1] == samples.time[k] == times[k]
        distance = np.abs(samples.position[k] - truth.position[-1]).max() / surface.size
        worst[0] = max(worst[0], distance)
        # Between an event of the one and the same event of the other they are in different states.
        if ((times[k] > early - 1e-12) & (times[k] < late + 1e-12)).any():
            continue
        compared += 1
        assert samples.state[k] == truth.state[-1], times[k]
        gaps = [
            distance,
            np.abs(samples.velocity[k] - truth.velocity[-1]).max() / speed,
            abs(samples.height[k] - truth.height[-1]) / surface.size,
            abs(samples.normal_force[k] - truth.normal_force[-1]) / load,
            abs(samples.friction_force[k] - truth.friction_force[-1]) / friction,
        ]
        worst = np.maximum(worst, gaps)
    assert (worst < bounds * tolerance).all(), worst / tolerance
    assert compared > 0.9 * len(times)


def test_every_state_and_event_is_met():
    """So that the test above is one of flights, landings, reversals, stops and first moments of slides."""
    kinds, states = set(), set()
    for name in ("shaken", "rocking", "platform"):
        surface, part, law, end = CASES[name]
        path = simulate(surface(), part, law, end, tolerance=1e-6, after_detachment="fly")
        kinds |= {e.kind for e in path.events}
        states |= set(path.state.tolist())
    wanted = (EventKind.SLIPS, EventKind.STOPS, EventKind.REVERSES, EventKind.DETACHES, EventKind.LANDS)
    assert kinds == set(wanted)
    assert states == set(State)
