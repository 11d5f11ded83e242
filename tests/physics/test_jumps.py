"""A jump of the surface's velocity is an impact: closed forms for a base and a plate that start or end at speed."""

import math

import numpy as np
import pytest
from driven_surface import driven, level, steady
from scipy.integrate import solve_ivp

from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    EventKind,
    FrictionTable,
    HermiteDrive,
    Micropart,
    Outcome,
    State,
    simulate,
)

G, MASS = 9.80665, 2e-9
STILL = Drive(0.0, 10.0)
START, END = 0.1, 0.35  # s, of a steady motion
INCLINE = [[0.0, 0.3], [-0.4, 0.0]]  # slope (-0.4, 0.3), 0.5 in all
SLOPE = np.array([-0.4, 0.3])
S = math.sqrt(1.25)
LAWS = {
    "constant": (ConstantFriction(3.0 * MASS), 0.0),
    "slippery": (CoulombAdhesion(0.2), 0.2),
    "gripping": (CoulombAdhesion(0.55), 0.55),
    "sticky": (CoulombAdhesion(0.2, 6.0 * MASS), 0.2),
    "table": (FrictionTable([-6 * MASS, 50 * MASS, 1e6 * MASS], [0, 20 * MASS, 300 * MASS]), 0.0),
}


def run(surface, law, duration, velocity=(0.0, 0.0), **more):
    return simulate(surface, Micropart(MASS, (0.0, 0.0), velocity), law, duration, after_detachment="fly", **more)


def after_blow(relative, gradient, mu, held=False):
    """The velocity (3,) relative to the surface after an impact; the same if it leaves, unless it is held."""
    normal = np.array([*-gradient, 1.0]) / math.sqrt(1 + gradient @ gradient)
    approach = -relative @ normal
    if approach < 0 and not held:
        return relative
    along = relative + approach * normal
    size = math.sqrt(along @ along)
    return along * max(0.0, 1 - mu * abs(approach) / size) if size > 1e-14 else 0 * along


@pytest.mark.parametrize("law", ["constant", "slippery"])
def test_a_base_that_starts_and_ends_at_speed_leaves_a_block_behind_twice(law):
    """On a flat platform nothing presses: the block slides by V^2 / 2q back at the start and forth at the end."""
    v, q = 0.4, {"constant": 3.0, "slippery": 0.2 * G}[law]
    base = (steady(0.6 * v, 1.0, START), steady(-0.8 * v, 1.0, START))
    path = run(driven([level(0.0)], base=base), LAWS[law][0], 1.5)
    way, time = v**2 / 2 / q, v / q
    assert [e.kind for e in path.events if e.kind is EventKind.STOPS] == [EventKind.STOPS] * 2
    first, last = (e for e in path.events if e.kind is EventKind.STOPS)
    assert first.time == pytest.approx(START + time, abs=1e-9)
    assert first.position == pytest.approx((-0.6 * way, 0.8 * way), abs=1e-9)
    assert last.time == pytest.approx(START + 1.0 + time, abs=1e-9)
    assert last.position == pytest.approx((0.0, 0.0), abs=1e-9)
    sliding = path.at([START + 0.5 * time])
    assert sliding.velocity[0] == pytest.approx([-0.3 * v, 0.4 * v], abs=1e-9)
    assert path.energy.dissipated[-1] == pytest.approx(MASS * v**2, rel=1e-8)
    assert path.energy.work[-1] == pytest.approx(MASS * v**2, rel=1e-8)
    assert path.energy.balance < 1e-9


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("v", [0.3, 2.0])
def test_a_plate_that_rises_at_once_hits_a_part_at_rest_or_sliding(law, v):
    """A flat plate: nothing happens to a part at rest, and a sliding one loses mu V of its speed."""
    friction, mu = LAWS[law]
    surface = driven([steady(v, 1.0, START)])
    resting = run(surface, friction, 0.5)
    assert resting.outcome is Outcome.STUCK and not resting.position.any()
    assert resting.energy.work[-1] == pytest.approx(MASS * (v**2 + G * v * 0.4), rel=1e-9)
    assert resting.energy.dissipated[-1] == pytest.approx(MASS * v**2 / 2, rel=1e-9)
    # The load is m g before and after the blow.
    q = float(friction.friction_limit(MASS * G)) / MASS
    u = 2.0
    before, after = u - q * START, max(0.0, u - q * START - mu * v)
    path = run(surface, friction, 0.3, (0.0, -u))
    late = min(0.2, after / q)
    way = u * START - q * START**2 / 2 + after * late - q * late**2 / 2
    assert before > 0 and path.at([START * (1 - 1e-9)]).velocity[0, 1] == pytest.approx(-before, abs=1e-7)
    assert path.position[-1] == pytest.approx([0.0, -way], abs=1e-8)
    assert path.velocity[-1] == pytest.approx([0.0, -(after - q * late)], abs=1e-8)
    assert path.energy.balance < 1e-9


@pytest.mark.parametrize("law", ["constant", "slippery", "gripping", "sticky", "table"])
def test_an_incline_that_rises_at_once_throws_the_part_downhill(law):
    """From rest: relative to it the part falls at V, keeps V q/s along the slope, less mu V/s. Then it slides."""
    friction, mu = (CoulombAdhesion(0.6), 0.6) if law == "gripping" else LAWS[law]
    v, slope, late = 1.5, math.hypot(*SLOPE), 0.02
    path = run(driven([level(), steady(v, 1.0, START)], [INCLINE, [[1.0]]]), friction, START + late)
    q, pull = float(friction.friction_limit(MASS * G / S)) / MASS, G * slope / S  # along the surface
    rate = max(0.0, pull - q)
    hit = max(0.0, rate * START + v * slope / S - mu * v / S)
    downhill = -SLOPE / slope / S
    if hit > 0:
        way = rate * START**2 / 2 + hit * late + (pull - q) * late**2 / 2
        assert hit + (pull - q) * late > 0
        assert path.velocity[-1] == pytest.approx((hit + (pull - q) * late) * downhill, abs=1e-8)
        assert path.position[-1] == pytest.approx(way * downhill, abs=1e-8)
    else:
        assert law == "gripping" and not path.position.any() and path.outcome is Outcome.STUCK
    assert path.energy.balance < 1e-9


JOLTS = [(0.7, 0.0, 0.4), (0.0, -0.9, 0.0), (-0.8, 0.3, 0.0), (0.8, -0.2, 0.0), (0, 0, -0.6)]
VELOCITIES = [(0.0, 0.0), (0.9, 0.4), (-0.3, 0.8)]
PAIRS = [  # each pair of two of the three once at least
    pytest.param(law, VELOCITIES[(i + j) % 3], jolt, id=f"{law}-{i + j}-{j}")
    for i, law in enumerate(LAWS)
    for j, jolt in enumerate(JOLTS)
]


@pytest.mark.parametrize("law, velocity, jolt", PAIRS)
def test_a_jolt_in_any_direction_is_one_impact(law, velocity, jolt):
    """An incline whose base and height jump together under a part at rest or in motion; it may leave instead."""
    friction, mu = LAWS[law]
    x, y, z = (steady(v, 1.0, START) if v else STILL for v in jolt)
    surface = driven([level(), z], [INCLINE, [[1.0]]], base=(x, y))
    late = 0.02
    path = run(surface, friction, START + late, velocity, tolerance=1e-11)
    # The same without the jolt says how it comes, and one with the velocity after the blow how it goes on.
    still = driven([level()], [INCLINE])
    comes = run(still, friction, START, velocity, tolerance=1e-11)
    before = np.array([*comes.velocity[-1], comes.velocity[-1] @ SLOPE]) - np.array(jolt)
    held = math.isinf(friction.pull_off)
    after = after_blow(before, SLOPE, mu, held)
    leaves = bool(before @ np.array([*-SLOPE, 1.0]) > 1e-12 and not held)
    assert [e.time for e in path.events if e.kind is EventKind.DETACHES] == [START] * leaves
    if leaves:
        assert path.velocity[-1] == pytest.approx(after[:2], abs=1e-9)
        assert path.position[-1] == pytest.approx(comes.position[-1] + after[:2] * late, abs=1e-9)
        assert path.energy.dissipated[-1] == pytest.approx(comes.energy.dissipated[-1], rel=1e-9)
    else:
        goes = run(still, friction, late, tuple(after[:2]), tolerance=1e-11)
        assert path.velocity[-1] == pytest.approx(goes.velocity[-1], abs=2e-9)
        assert path.position[-1] == pytest.approx(comes.position[-1] + goes.position[-1], abs=1e-9)
        lost = path.energy.dissipated[-1] - comes.energy.dissipated[-1] - goes.energy.dissipated[-1]
        assert lost == pytest.approx(MASS * (before @ before - after @ after) / 2, abs=1e-8 * MASS)
    assert (path.state[-1] == State.FLIGHT) == leaves
    assert path.energy.balance < 1e-8


@pytest.mark.parametrize("law", ["slippery", "sticky", "table"])
def test_a_plate_that_stops_rising_at_once_throws_the_part_up(law):
    v, friction = 1.2, LAWS[law][0]
    path = run(driven([steady(v, END)]), friction, 1.0)
    kinds = [e.kind for e in path.events]
    assert kinds == [EventKind.DETACHES, EventKind.LANDS]
    assert path.events[0].time == END
    assert path.events[1].time == pytest.approx(END + 2 * v / G, rel=1e-9)
    assert path.at([END + v / G]).height[0] == pytest.approx(v * END + v**2 / 2 / G, rel=1e-10)
    assert path.energy.dissipated[-1] == pytest.approx(MASS * v**2 / 2, rel=1e-9)
    assert path.energy.balance < 1e-9
    ended = simulate(driven([steady(v, END)]), Micropart(MASS, (0.0, 0.0)), friction, 1.0)
    assert ended.outcome is Outcome.DETACHED and ended.time[-1] == END


def test_a_law_without_pull_off_holds_on_to_a_plate_that_stops():
    v = 1.2
    path = run(driven([steady(v, END)]), LAWS["constant"][0], 1.0, (2.0, 0.0))
    assert [e.kind for e in path.events] == [EventKind.STOPS]
    assert path.events[0].time == pytest.approx(2 / 3, abs=1e-8)
    assert path.events[0].position == pytest.approx((2 / 3, 0.0), abs=1e-8)
    assert path.height[-1] == pytest.approx(v * END, rel=1e-12)
    assert path.energy.balance < 1e-9


@pytest.mark.parametrize("cycles", [1, 3])
def test_a_sine_of_the_base_hits_at_its_start_and_after_its_last_cycle(cycles):
    """Too weak to move the block between: it slides by V^2 / 2q, plus what the sine's own motion gives it.

    With q above the sine's acceleration a sliding block stops before long; its speed over the inertial frame is
    V0 = 0 at the start (the base leaves) and that of the base at the end (the block goes on).
    """
    a, frequency, mu = 2e-3, 3.0, 0.3
    rate = 2 * math.pi * frequency
    top, q = a * rate, mu * G
    assert a * rate**2 < q
    base = (Drive(a, frequency, "sine", cycles=cycles, delay=START), STILL)
    last = START + cycles / frequency
    path = run(driven([level(0.0)], base=base, size=1e-2), CoulombAdhesion(mu), last + 0.2, tolerance=1e-11)
    stops = [e for e in path.events if e.kind is EventKind.STOPS]
    assert len(stops) == 2
    # In the inertial frame it is pushed by q until its speed q t is that of the base, top cos(rate t).
    low, high = 0.0, top / q
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if q * middle < top * math.cos(rate * middle) else (low, middle)
    lag = q * low**2 / 2 - a * math.sin(rate * low)
    assert stops[0].time - START == pytest.approx(low, abs=1e-9)
    assert stops[0].position[0] == pytest.approx(lag, abs=1e-10)
    assert stops[1].time - last == pytest.approx(top / q, abs=1e-9)
    assert stops[1].position[0] == pytest.approx(lag + top**2 / 2 / q, abs=1e-10)
    assert path.energy.balance < 1e-9


def test_a_sine_of_the_plate_hits_a_sliding_part_at_its_start_and_throws_it_at_its_end():
    """cos = 1 at both: at the start it loses mu V, at the end the plate stops under it and it flies for 2 V / g."""
    a, frequency, mu, u = 1e-2, 3.0, 0.1, 3.0
    top = a * 2 * math.pi * frequency
    surface = driven([Drive(a, frequency, "sine", cycles=2, delay=START)])
    last = START + 2 / frequency
    path = run(surface, CoulombAdhesion(mu), last + 2 * top / G + 0.05, (0.0, u), tolerance=1e-11)
    assert [e.kind for e in path.events] == [EventKind.DETACHES, EventKind.LANDS]
    assert path.events[0].time == pytest.approx(last, abs=1e-15)
    assert path.events[1].time == pytest.approx(last + 2 * top / G, rel=1e-9)
    # The plate's mean acceleration over whole periods is 0; the blow at the start takes mu V.
    flies_at = u - mu * G * last - mu * top
    assert path.velocity[np.flatnonzero(path.time == path.events[0].time)[-1], 1] == pytest.approx(flies_at, abs=1e-9)
    assert path.events[1].speed == pytest.approx(flies_at - mu * top, abs=1e-9)
    assert path.energy.balance < 1e-9


@pytest.mark.parametrize("velocity", [0.0, 0.3])
def test_a_jump_in_flight_moves_the_landing_only(velocity):
    """The surface falls away at once at 2 m/s and stops at once 0.1 s later, while the part is in the air."""
    fall = HermiteDrive([0.0, 0.1], [0.0, -0.2], [-2.0, -2.0], [0.0, 0.0], delay=START)
    path = run(driven([fall]), CoulombAdhesion(0.1), 0.5, (velocity, 0.0))
    off, landing = path.events[0], path.events[-1] if velocity == 0 else path.events[1]
    u = velocity - 0.1 * G * START
    assert (off.kind, landing.kind) == (EventKind.DETACHES, EventKind.LANDS)
    assert off.time == START
    assert landing.time == pytest.approx(START + math.sqrt(0.4 / G), rel=1e-9)
    if velocity:
        way = velocity * START - 0.1 * G * START**2 / 2 + u * math.sqrt(0.4 / G)
        assert landing.position[0] == pytest.approx(way, abs=1e-9)
        assert landing.speed == pytest.approx(max(0.0, u - 0.1 * math.sqrt(0.4 * G)), abs=1e-9)
    assert path.energy.balance < 1e-9


@pytest.mark.parametrize("since", [1e-5, 1e-3, 0.02, 0.1])
@pytest.mark.parametrize("jolt", [0.5, 1e-3])
def test_a_jolt_across_a_part_that_has_just_broken_away(since, jolt):
    """A base with a(t) = j t: the block slips at q/j and lags by j tau^3/6. Then the base jumps to the side."""
    jerk, q, end = 20.0, 3.0, 0.6
    slip = q / jerk
    drive = HermiteDrive([0, end], [0, jerk * end**3 / 6], [0, jerk * end**2 / 2], [0, jerk * end])
    base = (drive, steady(jolt, 1.0, slip + since))
    path = run(driven([level(0.0)], base=base), LAWS["constant"][0], slip + since + 0.2, tolerance=1e-11)
    assert path.events[0].kind is EventKind.SLIPS and path.events[0].time == pytest.approx(slip, abs=1e-12)

    def rate(tau, state):
        v = state[2:]
        return [*v, *(np.array([-jerk * tau - q, 0.0]) - q * v / np.hypot(*v))]

    start = [-jerk * since**3 / 6, 0.0, -jerk * since**2 / 2, -jolt]
    theirs = solve_ivp(rate, (since, since + 0.2), start, method="Radau", rtol=1e-10, atol=1e-13).y[:, -1]
    assert path.position[-1] == pytest.approx(theirs[:2], abs=1e-8)
    assert path.velocity[-1] == pytest.approx(theirs[2:], abs=1e-7)
    assert path.energy.balance < 1e-8


@pytest.mark.parametrize("law", ["holding", "gripping"])
def test_a_curved_plate_that_stops_at_once_throws_or_drags_the_part_by_its_own_height(law):
    """w = t V p(x): where it stops the slope is END V p', and the part has the velocity V p(x)."""
    v, x, y = 0.8, 0.3, -0.2
    p = np.array([[1.0, 0.3, 0.2], [0.5, 0.1, 0.0], [-0.4, 0.0, 0.0]])
    height = v * np.polynomial.polynomial.polyval2d(x, y, p)
    slope = v * END * np.array([0.5 + 0.1 * y - 0.8 * x, 0.3 + 0.1 * x + 0.4 * y])
    friction = ConstantFriction(40.0 * MASS) if law == "holding" else CoulombAdhesion(0.9)
    surface = driven([steady(v, END)], [p])
    path = simulate(surface, Micropart(MASS, (x, y)), friction, END + 1.0, after_detachment="fly")
    first = path.events[0]
    assert first.time == END and first.position == (x, y)
    row = np.flatnonzero(path.time == END)[-1]
    if law == "gripping":
        assert [e.kind for e in path.events] == [EventKind.DETACHES, EventKind.LANDS]
        assert path.events[1].time == pytest.approx(END + 2 * height / G, rel=1e-9)
        assert path.position[-1] == pytest.approx([x, y], abs=1e-12)
    else:
        assert [e.kind for e in path.events] == [EventKind.SLIPS, EventKind.STOPS]
        assert path.velocity[row] == pytest.approx(height * slope / (1 + slope @ slope), rel=1e-9)
    assert path.energy.balance < 1e-8
