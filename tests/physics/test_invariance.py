"""The same motion turned, mirrored, later, larger, slower or heavier is the same motion: random cases."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from driven_surface import driven, level
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from particle import (
    AnyDrive,
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    EventKind,
    HermiteDrive,
    Micropart,
    SurfaceMotion,
    Trajectory,
    simulate,
)

SIZE, MASS, G, TOLERANCE, DURATION = 300e-6, 2e-9, 9.80665, 1e-11, 4e-3
SLIPS, STOPS, REVERSES = EventKind.SLIPS, EventKind.STOPS, EventKind.REVERSES
OTHER_STEPS = 300.0  # tolerances; rounding can begin a slide in other steps
NUDGE = 1e-8  # of the size
pytestmark = pytest.mark.compiled
FEW = settings(max_examples=40, deadline=None, derandomize=True)


@dataclass(frozen=True)
class Case:
    """w = sum_k h_k(t) (a_k + b_k.x / size + x.C_k x / size^2), on a base that moves along one direction."""

    strokes: tuple[float, ...]  # m
    frequencies: tuple[float, ...]  # Hz
    cycle: str
    delays: tuple[float, ...]  # s
    slopes: np.ndarray  # (K, 2), b
    bends: np.ndarray  # (K, 2, 2), C
    base: np.ndarray  # (2,) m
    tilt: np.ndarray  # (2,) m/s^2
    start: np.ndarray  # (2,) m
    velocity: np.ndarray  # (2,) m/s
    friction: float  # m/s^2 or 1
    adhesion: float | None  # m/s^2, of Coulomb's law; None: constant friction
    mass: float = MASS
    gravity: float = G
    size: float = SIZE
    duration: float = DURATION

    def drives(self) -> list[AnyDrive]:
        given = zip(self.strokes, self.frequencies, self.delays, strict=True)
        return [Drive(stroke, f, self.cycle, delay=delay) for stroke, f, delay in given]

    def surface(self, extra: tuple[AnyDrive, ...] = ()) -> SurfaceMotion:
        """extra: none, or three drives that move the whole device along x, y and z instead of its base."""
        shapes = []
        for b, c in zip(self.slopes, self.bends, strict=True):
            p = np.zeros((3, 3))
            p[0, 0], p[1, 0], p[0, 1] = 1.0, *(b / self.size)
            p[2, 0], p[0, 2], p[1, 1] = c[0, 0], c[1, 1], c[0, 1] + c[1, 0]
            p[[2, 0, 1], [0, 2, 1]] /= self.size**2
            shapes.append(p)
        f, delay = self.frequencies[0], self.delays[0]
        base = [Drive(s, f, "cosine", delay=delay) if s else level(0.0) for s in self.base]
        if extra:
            return driven([*self.drives(), extra[2]], [*shapes, [[1.0]]], extra[:2], size=self.size)
        if not self.base.any():
            return driven(self.drives(), shapes, size=self.size)
        return driven(self.drives(), shapes, base, size=self.size)

    def path(self, extra: tuple[AnyDrive, ...] = ()) -> Trajectory:
        if self.adhesion is None:
            law: ConstantFriction | CoulombAdhesion = ConstantFriction(self.friction * self.mass)
        else:
            law = CoulombAdhesion(self.friction, self.adhesion * self.mass)
        part = Micropart(self.mass, tuple(self.start), tuple(self.velocity))
        gravity = (*self.tilt, -self.gravity)
        surface = self.surface(extra)
        return simulate(surface, part, law, self.duration, gravity=gravity, tolerance=TOLERANCE, after_detachment="fly")

    def moved(self, m: np.ndarray) -> Case:
        """Turned or mirrored by an orthogonal matrix (2, 2)."""
        turned = {name: m @ getattr(self, name) for name in ("base", "tilt", "start", "velocity")}
        return replace(self, slopes=self.slopes @ m.T, bends=m @ self.bends @ m.T, **turned)

    def scaled(self, length: float, time: float, mass: float = 1.0) -> Case:
        """All lengths, times and masses times these; accelerations follow."""
        rate = length / time**2
        return replace(
            self,
            strokes=tuple(length * s for s in self.strokes),
            frequencies=tuple(f / time for f in self.frequencies),
            delays=tuple(time * d for d in self.delays),
            base=length * self.base,
            tilt=rate * self.tilt,
            start=length * self.start,
            velocity=length / time * self.velocity,
            friction=self.friction * (rate if self.adhesion is None else 1.0),
            adhesion=None if self.adhesion is None else rate * self.adhesion,
            mass=mass * self.mass,
            gravity=rate * self.gravity,
            size=length * self.size,
            duration=time * self.duration,
        )


def numbers(low, high, count):
    """Numbers to four digits, so that what is found can be read."""
    one = st.floats(0, 1).map(lambda x: round(low + x * (high - low), 4))
    return st.lists(one, min_size=count, max_size=count).map(np.array)


@st.composite
def cases(draw, moving=True):
    count = draw(st.integers(1, 2))
    coulomb = draw(st.booleans())
    return Case(
        strokes=tuple(1e-6 * draw(numbers(20, 150, count))),
        frequencies=tuple(draw(numbers(250, 600, count))),
        cycle=draw(st.sampled_from(["up-down", "up", "cosine", "sine"])),
        delays=tuple(1e-3 * draw(numbers(0.1, 0.6, count))),
        slopes=draw(numbers(-0.5, 0.5, 2 * count)).reshape(count, 2),
        bends=draw(numbers(-0.3, 0.3, 4 * count)).reshape(count, 2, 2),
        base=1e-6 * draw(numbers(-30, 30, 2)) * draw(st.booleans()),
        tilt=draw(numbers(-1, 1, 2)) * draw(st.booleans()),
        start=SIZE * draw(numbers(-0.5, 0.5, 2)),
        velocity=draw(numbers(-0.1, 0.1, 2)) * (moving and draw(st.booleans())),
        friction=float(draw(numbers(0.15, 0.8, 1))[0] if coulomb else draw(numbers(3, 30, 1))[0]),
        adhesion=float(draw(numbers(0, 40, 1))[0]) if coulomb else None,
        gravity=draw(st.sampled_from([G, 100.0])),  # the latter lets it land again
    )


def kinds(path):
    """What happens, but for slides that last no time: rounding begins them, at no load or on a flat surface."""
    out, brief = [], 1e-7 * path.time[-1]
    for k, event in enumerate(path.events):
        before = path.events[k - 1] if k else event
        at_once = before.kind is SLIPS and event.time - before.time < brief and event is not before
        if at_once and event.kind is not REVERSES:
            out.pop()
        if not (at_once and event.kind in (STOPS, REVERSES)):
            out.append(event.kind)
    return out


def growth(case, path):
    """How much an error of the start grows to the end; cases that a nudge sends another way are not compared."""
    most = 1.0
    for nudge in ([1.0, 0.3], [-0.4, 0.9]):
        other = replace(case, start=case.start + NUDGE * case.size * np.array(nudge)).path()
        assume(kinds(other) == kinds(path))
        most = max(most, float(np.abs(other.position[-1] - path.position[-1]).max()) / (NUDGE * case.size))
    assume(most < 1e4)
    return most


def same(case, path, other, back=None, length=1.0, time=1.0, later=0.0):
    """The same path to a few hundred tolerances, as far as errors grow; back: (2, 2), to the path's own axes."""
    bound = OTHER_STEPS * TOLERANCE * growth(case, path)
    back = np.eye(2) if back is None else back
    assert kinds(other) == kinds(path)
    assert other.outcome is path.outcome
    assert (other.time[-1] - later) / time == pytest.approx(path.time[-1], rel=1e-9)
    assert np.abs(back @ other.position[-1] / length - path.position[-1]).max() < bound * case.size
    speed = np.abs(path.velocity).max() + case.size / case.duration
    assert np.abs(back @ other.velocity[-1] * time / length - path.velocity[-1]).max() < 100 * bound * speed


def identical(path, other, back=None, length=1.0, time=1.0):
    """The same to the last bit."""
    back = np.eye(2) if back is None else back
    assert kinds(other) == kinds(path)
    assert np.array_equal(other.time / time, path.time)
    assert np.array_equal(other.position @ back.T / length, path.position)
    assert np.array_equal(other.velocity @ back.T * time / length, path.velocity)


@FEW
@given(cases(), st.floats(0.05, 6.2))
def test_turned(case, angle):
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    same(case, case.path(), case.moved(turn).path(), back=turn.T)


@FEW
@given(cases(), st.sampled_from([(1, -1), (-1, 1), (-1, -1)]))
def test_mirrored_in_an_axis_to_the_bit(case, signs):
    mirror = np.diag(np.array(signs, dtype=float))
    identical(case.path(), case.moved(mirror).path(), back=mirror)


@FEW
@given(cases(), st.floats(0, math.pi))
def test_mirrored_in_any_line(case, angle):
    c, s = math.cos(2 * angle), math.sin(2 * angle)
    mirror = np.array([[c, s], [s, -c]])
    same(case, case.path(), case.moved(mirror).path(), back=mirror)


@FEW
@given(cases(), st.floats(1e-3, 1e3), st.floats(1e-2, 1e2), st.floats(1e-6, 1e6))
def test_all_lengths_times_and_masses_scaled(case, length, time, mass):
    same(case, case.path(), case.scaled(length, time, mass).path(), length=length, time=time)


@FEW
@given(cases(), *[st.integers(0, 6).map(lambda k: 2.0**k)] * 3)
def test_scaled_by_powers_of_two_to_the_bit(case, length, rate, mass):
    """To larger lengths and shorter times: where gravity is below 1 m/s^2, ends are located by another weight."""
    time = 1 / rate
    identical(case.path(), case.scaled(length, time, mass).path(), length=length, time=time)


@FEW
@given(cases(moving=False), st.floats(1e-4, 5e-2))
def test_begun_later(case, delay):
    path = case.path()
    assume(all(event.time > 0.99 * min(case.delays) for event in path.events))  # it waits at rest
    late = replace(case, delays=tuple(d + delay for d in case.delays), duration=case.duration + delay)
    same(case, path, late.path(), later=delay)


@FEW
@given(cases(), numbers(-3, 3, 3))
def test_an_accelerated_device_is_one_under_another_gravity(case, lift):
    """Base and plate with the acceleration (a_x, a_y, a_z) from the first moment, against gravity less that."""
    case = replace(case, base=np.zeros(2))
    end = case.duration

    def push(a):
        return HermiteDrive([0, end], [0, a * end**2 / 2], [0, a * end], [a, a])

    x, y, z = (push(a) for a in lift)
    heavier = replace(case, gravity=case.gravity + lift[2], tilt=case.tilt - lift[:2])
    same(heavier, heavier.path(), case.path(extra=(x, y, z)))


@FEW
@given(cases(), numbers(-2, 2, 3))
def test_a_device_at_constant_velocity_is_one_at_rest(case, velocity):
    case = replace(case, base=np.zeros(2))
    end = case.duration
    x, y, z = (HermiteDrive([0, end], [0, v * end], [v, v], [0, 0]) for v in velocity)
    same(case, case.path(), case.path(extra=(x, y, z)))


@FEW
@given(cases(), cases())
def test_the_same_bits_again_whatever_ran_between(case, between):
    first = case.path()
    between.path()
    again = case.path()
    identical(first, again)
    for name in ("height", "normal_force", "friction_force", "state"):
        assert np.array_equal(getattr(first, name), getattr(again, name)), name
    assert first.events == again.events and first.evaluations == again.evaluations
    assert np.array_equal(first.energy.work, again.energy.work)
