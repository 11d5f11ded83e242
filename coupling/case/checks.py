"""Check the tables of a case against each other, and build the case's actuators and friction from them."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from coupling.case.actuators import (
    ENDLESS,
    SAME_PLACE,
    ActuatorCase,
    Place,
    actuators_of,
    gaps,
    half_size,
    must_be_inside,
)
from coupling.case.friction import CoulombCase, FrictionCase, KogutEtsionCase, TableCase
from coupling.case.part import PartCase
from coupling.case.plates import INERTIA, PLATFORM, VON_KARMAN, MotionCase, PlateCase, PlatformCase, ShapeCase
from coupling.case.table import Faults, Location, Mistake, Table, location_text, stated
from coupling.case.tables import CaseTables, RunCase
from coupling.case.values import length_text, unreadable
from coupling.suggestion import near

if TYPE_CHECKING:
    from meshes import PlateMesh

MAX_STRETCHING: Final = 200
"""Actuators of a plate that stretches."""
MAX_VIBRATING: Final = 250
"""Actuators of a plate with inertia, under a pressure, on a foundation, or of a wafer under a tension."""
STEADY: Final = 'start = "steady"'
MAX_PERIODS: Final = 1000  # of one drive in the common period
MAX_CYCLES: Final = 100_000  # of one drive: a part that slips all the while takes minutes and up to 3 GB
MAX_TOGETHER: Final = 10_000_000  # of all drives
ROUNDING: Final = 4 * sys.float_info.epsilon


def build(tables: CaseTables, may_move: bool = False) -> dict[str, Any]:
    """The tables of a case: a lattice becomes actuators, and the points in the file of a friction law are read.

    Of many parts `part` is the first.
    may_move: accept that supports and actuators leave the plate free to move as a whole.
    Raises Faults with every mistake.
    """
    mistakes: list[Mistake] = []
    made, friction, parts = tables.actuators, tables.friction, _parts(tables)
    try:
        if isinstance(friction, TableCase):
            friction = friction.with_points()
    except Faults as error:
        mistakes += error.mistakes
    plate = tables.plate
    if isinstance(plate, PlatformCase):
        mistakes += _platform(tables, plate)
    else:
        try:
            mesh = _mesh_of(plate)
            made += actuators_of(tables.lattice, mesh) if tables.lattice else ()
            mistakes += (misplaced := list(_places(tables, plate, mesh, made, parts)))
            mistakes += _theory(plate, tables.run, made, len(tables.actuators))
            if not (may_move or misplaced):
                mistakes += _fixed(plate, mesh, made)
        except Faults as error:
            mistakes += error.mistakes
    mistakes += _face(tables, parts)
    mistakes += _air(tables, parts, friction)
    mistakes += _jumps(tables, parts, made)
    if wrong := _too_many(plate, made, tables.run.duration):
        mistakes.append((("run", "duration"), wrong))
    if mistakes:
        raise Faults(mistakes)
    first = next(iter(parts.values()))
    return {**dict(tables), "actuators": made, "part": first, "friction": friction, "lattice": None}


def _parts(tables: CaseTables) -> dict[Location, PartCase]:
    """The parts by their places in the file."""
    return {("parts", k): part.alone for k, part in enumerate(tables.parts)} or {("part",): tables.part}


def _face(tables: CaseTables, parts: Mapping[Location, PartCase]) -> Iterator[Mistake]:
    """Yield what does not go with parts of which some have a footprint, or none has one, or with a local contact."""
    run, friction, where = tables.run, tables.friction, "[[parts]]" if tables.parts else "[part]"
    for place, part in parts.items():
        if part.local_contact and not isinstance(friction, KogutEtsionCase):
            yield (*place, "local_contact"), f'must be false with model = "{friction.model}" in [friction]'
        elif part.local_contact and part.size is not None and "contact_area" in stated(friction):
            yield ("friction", "contact_area"), f"must not be given with local_contact and size in {where}"
        elif part.local_contact and part.face is not None and not part.face.star_shaped:
            yield (*place, "corners"), "must outline a face all of which its centroid sees, with local_contact = true"
    if run.after_tipping == "ignore" and any(part.local_contact and part.face for part in parts.values()):
        yield ("run", "after_tipping"), f'must be "stop" with local_contact = true in {where}; got "ignore"'
    if run.scheme == "paper" and any(part.local_contact for part in parts.values()):
        yield ("run", "scheme"), f'must be "events" or "fixed" with local_contact = true in {where}; got "paper"'
    motion = getattr(tables.plate, "motion", None)
    if isinstance(motion, MotionCase) and motion.turn is not None and any(part.face is None for part in parts.values()):
        yield ("plate", "motion", "turn"), f"must not be given without a footprint in {where}: a point has no heading"
    if all(part.face is None for part in parts.values()):
        if run.after_tipping == "ignore":
            yield ("run", "after_tipping"), f'must be "stop" without a footprint in {where}: a point does not tip'
        return
    if run.scheme != "events":
        yield ("run", "scheme"), f'must be "events" with a footprint in {where}; got "{run.scheme}"'
    if run.after_detachment == "fly":
        yield ("run", "after_detachment"), f'must be "stop" with a footprint in {where}; got "fly"'
    if isinstance(friction, KogutEtsionCase) and "contact_area" in stated(friction):
        yield (
            ("friction", "contact_area"),
            f"must not be given with a footprint in {where}, which has an area",
        )


def _air(tables: CaseTables, parts: Mapping[Location, PartCase], friction: FrictionCase) -> Iterator[Mistake]:
    """Yield what does not go with the air around the part."""
    if tables.air is None:
        return
    if tables.air.film and tables.air.pressure == 0:
        yield ("air", "film"), "must be false in a vacuum"
    elif tables.air.film:
        yield from _film(tables, parts)
    if tables.air.pressure == 0:
        return
    if tables.air.film and isinstance(friction, CoulombCase) and friction.adhesion == 0:
        yield ("friction", "adhesion"), "must be greater than 0 with a film of air, whose gap follows from it"
    elif tables.air.film and isinstance(friction, TableCase) and friction.loads and friction.loads[0] == 0:
        at: Location = ("friction", "file") if "file" in stated(tables.friction) else ("friction", "loads", 0)
        least = "the least load must be below 0" if at[1] == "file" else "must be below 0"
        yield at, f"{least} with a film of air, whose gap follows from that pull-off force; got 0 N"
    if tables.run.scheme != "events":
        yield ("run", "scheme"), f'must be "events" with [air], unless that is a vacuum; got "{tables.run.scheme}"'
    if not isinstance(tables.friction, KogutEtsionCase):
        for place in (place for place, part in parts.items() if part.face is None and part.size is None):
            must = 'it must be a length such as "100 um", the side of the part'
            yield (*place, "size"), f"is missing; with [air], unless that is a vacuum, {must}"


def _film(tables: CaseTables, parts: Mapping[Location, PartCase]) -> Iterator[Mistake]:
    """Yield what does not go with a film under a face."""
    where, faces = "[[parts]]" if tables.parts else "[part]", [part for part in parts.values() if part.face]
    if any(part.footprint == "polygon" for part in faces):
        yield (
            ("air", "film"),
            f"must be false with a polygon in {where}: only squares, rectangles and discs have a film",
        )
    if any(part.local_contact for part in faces):
        yield ("air", "film"), f"must be false with a footprint and local_contact = true in {where}"
    if tables.run.after_tipping == "ignore" and any(part.pressure == "linear" for part in faces):
        yield ("run", "after_tipping"), f'must be "stop" with a film of air under a footprint in {where}; got "ignore"'


def _jumps(tables: CaseTables, parts: Mapping[Location, PartCase], made: Sequence[ActuatorCase]) -> Iterable[Mistake]:
    """The drives whose velocity jumps under a film or a face; of a lattice only the first."""
    film, motion = tables.air is not None and tables.air.film, getattr(tables.plate, "motion", None)
    if not film and all(part.face is None for part in parts.values()):
        return ()
    under = "a film of air" if film else f"a footprint in {'[[parts]]' if tables.parts else '[part]'}"
    places = (_location(k, len(tables.actuators), "")[:-1] for k in range(len(made)))
    drives = [*zip(places, made, strict=True)]
    if isinstance(motion, MotionCase):
        drives += [(("plate", "motion", axis), drive) for axis, drive in motion if drive is not None]
    found: dict[Location, str] = {}
    for place, drive in drives:
        if jump := drive.jump(tables.run.duration):
            key, time = jump
            when = f"as the drive {'begins' if key == 'delay' else 'ends'}, at {time * 1e3:g} ms"
            avoided = 'phase = "0 deg"' if drive.cycle == "up-down" else "a ramp"
            must = f"must not be given with {under}: the velocity jumps {when}; {avoided} avoids that"
            found.setdefault((*place, key), must)
    return found.items()


def _platform(tables: CaseTables, platform: PlatformCase) -> Iterator[Mistake]:
    for key in ("actuators", "lattice"):
        if getattr(tables, key):
            yield (key,), f"must not be given with {PLATFORM}, which moves as a whole"
    if tables.run.start == "steady":
        yield ("run", "start"), f'must be "rest" with {PLATFORM}, which does not vibrate; got "steady"'
    yield from platform.mistakes(tables.run.duration)


def _mesh_of(plate: PlateCase) -> PlateMesh:
    """The mesh for a plate's outline; raises Faults where there is none."""
    try:
        return plate.coarse_mesh
    except OSError as error:
        wrong = [unreadable(Path(str(error.filename)).name, error)]
    except ValueError as error:
        wrong = [
            re.sub(r"^Input \w+ of \w+ ", "", text).replace("\n  ", " ", 1).replace("\n  ", "; ")
            for text in re.split(r"\n(?=Input )", str(error))
        ]
    raise Faults((("plate", plate.outlined_by), message) for message in wrong)


def _places(
    tables: CaseTables,
    plate: PlateCase,
    mesh: PlateMesh,
    made: Sequence[ActuatorCase],
    parts: Mapping[Location, PartCase],
) -> Iterator[Mistake]:
    """Yield what does not fit the plate's outline: names of boundaries, cells, actuators and parts."""
    names = list(mesh.boundaries)
    for key in ("supports", "in_plane_supports"):
        supports = getattr(plate, key)
        for name in supports if isinstance(supports, dict) else ():
            if name not in names:
                meant = near(name, names)
                hint = f"did you mean {meant}? It" if meant else "it"
                yield ("plate", key, name), f"is no boundary of the plate; {hint} has {', '.join(names)}"
    free = [name for name, support in plate.supports_of(names).items() if support == "free"]
    if plate.tension and free:
        rims = f"{' and '.join(free)} {'is' if len(free) == 1 else 'are'} free"
        rule = "must be 0 if a boundary is free (a free edge carries no tension)"
        yield ("plate", "tension"), f"{rule}; got {plate.tension:g} N/m, and {rims}"
    if isinstance(plate, ShapeCase) and plate.cell_size is not None:
        least, most, got = plate.min_cell_size, plate.measures[0] / 2, f"; got {length_text(plate.cell_size)}"
        if plate.cell_size < least:
            yield ("plate", "cell_size"), f"must be at least {length_text(least)}{got}"
        if plate.cell_size > most * (1 + SAME_PLACE):
            limit = f"half of the plate's smallest width, {length_text(most)}"
            yield ("plate", "cell_size"), f"must not exceed {limit}{got}"
    alone = len(tables.actuators)
    if not made:
        yield ("actuators",), "must be at least one table, written [[actuators]]; got none"
    places: dict[Location, Place] = {("actuators", k, "position"): one.position for k, one in enumerate(made)}
    places |= {(*at, "position"): part.position for at, part in parts.items()}
    least = SAME_PLACE * half_size(mesh)
    for at, gap in zip(places, gaps(mesh, list(places.values())), strict=True):
        if gap <= mesh.least_gap:
            yield at, must_be_inside(gap, mesh)
        elif (part := parts.get(at[:-1])) and (face := part.face) is not None:
            corners = face.outline(part.position, part.heading)
            if (gap := gap - face.radius if face.radius else float(mesh.outline.gap(corners).min())) < 0:
                beyond = f"got one that reaches {length_text(-gap)} beyond the rim"
                yield at, f"must put all of the part on the plate; {beyond}"
    for one, other in _shared(list(places.values())[: len(made)], least):
        first = location_text(("actuators", one, "position"))
        if one >= alone:
            yield (
                ("lattice", "pitch"),
                f"must keep the actuators apart; numbers {one} and {other} are at one point",
            )
            return
        if other >= alone:
            yield ("actuators", one, "position"), "must differ from the position of an actuator of the lattice"
        else:
            yield ("actuators", other, "position"), f"must differ from {first}; got the same point"


def _shared(places: Sequence[Place], least: float) -> Iterator[tuple[int, int]]:
    """Yield each place that is nearer than `least` [m] to an earlier one, after that."""
    cells: dict[Place, list[int]] = {}
    for k, (x, y) in enumerate(places):
        column, row = x // least, y // least
        around = [(column + i, row + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
        near = (one for cell in around for one in cells.get(cell, ()) if math.dist(places[one], (x, y)) < least)
        if (one := next(near, None)) is None:
            cells.setdefault((column, row), []).append(k)
        else:
            yield one, k


def _fixed(plate: PlateCase, mesh: PlateMesh, made: Sequence[ActuatorCase]) -> Iterator[Mistake]:
    """Yield that nothing keeps the plate from moving as a whole, w = a + b x + c y."""
    supports = plate.supports_of(list(mesh.boundaries))
    if plate.foundation > 0 or "clamped" in supports.values():
        return
    fixed = [one.position for one in made if one.force is None]
    rims = [mesh.boundaries[name].ravel() for name, support in supports.items() if support == "simply-supported"]
    if not mesh.spans([*fixed, *(place for rim in rims for place in mesh.points[rim].tolist())]):
        needed = "fix a boundary, or use three actuators with strokes that are not in line"
        yield ("plate", "supports"), f"must not leave the plate free to move as a whole: {needed}"
    if plate.theory == "von-karman" and not rims and len(fixed) == 3 == len(made):
        same = "which tilt it without bending it; both theories are the same there"
        yield ("plate", "theory"), f'must be "linear" on a free plate with three actuators, {same}'


def _theory(plate: PlateCase, run: RunCase, made: Sequence[ActuatorCase], alone: int) -> Iterator[Mistake]:
    """Yield what cannot be combined with a plate; alone: how many actuators are not of the lattice."""
    stretches, count = plate.theory == "von-karman", len(made)
    if stretches:
        if run.scheme == "paper":
            moves = "whose mid-plane also moves in its plane"
            yield ("run", "scheme"), f'must be "events" or "fixed" with {VON_KARMAN}, {moves}; got "paper"'
        for key, unit in (("tension", "N/m"), ("pressure", "Pa"), ("foundation", "N/m^3")):
            if value := getattr(plate, key):
                yield ("plate", key), f"must be 0 with {VON_KARMAN}; got {value:g} {unit}; leave out one of the two"
    general = [
        ("theory", '"linear"', stretches, MAX_STRETCHING),
        ("inertia", "false", plate.inertia, MAX_VIBRATING),
        ("pressure", "0", plate.pressure, MAX_VIBRATING),
        ("foundation", "0", plate.foundation, MAX_VIBRATING),
        ("tension", "0 with a wafer", plate.wafer and plate.tension, MAX_VIBRATING),
    ]
    for key, instead, has, most in general:
        if has and count > most:
            piece = f"as it needs one model of the whole plate; got {count}; use a piece of the array"
            yield ("plate", key), f"must be {instead} with more than {most} actuators, {piece}"
    if run.start != "steady":
        return
    if not plate.inertia:
        yield ("run", "start"), f"must not be given without {INERTIA} in [plate]; only then do vibrations build up"
    yield from _endless(made, alone)
    if plate.inertia and stretches:
        yield from _periodic(made, alone)
        damping = plate.damping
        if (damping if isinstance(damping, float) else min(ratio for _, ratio in damping)) == 0:
            rings = "as the steady state is what is left when all ringing has decayed"
            yield ("plate", "damping"), f"must be a positive ratio with {VON_KARMAN} and {STEADY}, {rings}"


def common_period(one: float | None, other: float) -> float:
    """The shortest common multiple of two periods [s], to rounding; inf where it has more than MAX_PERIODS of one."""
    if one is None:
        return other
    ratio = Fraction(one / other).limit_denominator(MAX_PERIODS)
    cycles = float(ratio.numerator), float(ratio.denominator)
    if min(cycles) < 1 or max(cycles) > MAX_PERIODS:
        return math.inf
    shared = cycles[1] * one
    return shared if abs(shared - cycles[0] * other) <= ROUNDING * shared else math.inf


def _location(k: int, alone: int, key: str) -> Location:
    return ("actuators", k, key) if k < alone else ("lattice", key)


def _periodic(made: Sequence[ActuatorCase], alone: int) -> Iterator[Mistake]:
    """Yield the first drive that has no common period with those before it."""
    period: float | None = None
    for k, one in enumerate(made):
        if one.frequency is None or one.stroke == 0 or one.force == 0:
            continue
        own = 1 / one.frequency + (2 * one.dwell if one.cycle == "up-down" else 0.0)
        if math.isinf(shared := common_period(period, own)):
            got = f"got a period of {own * 1e3:.15g} ms, and {(period or 0.0) * 1e3:.15g} ms before"
            must = f"must have a common period with the drives before it, with {VON_KARMAN} and {STEADY}"
            yield _location(k, alone, "frequency"), f"{must}; {got}; use frequencies in a ratio of small whole numbers"
            return
        period = shared


def _endless(made: Sequence[ActuatorCase], alone: int) -> Iterator[Mistake]:
    """Yield the drives that end or grow, and so have no steady state; of a lattice only the first."""
    why = f"with {STEADY} in [run], which takes a drive without end"
    for k, one in enumerate(made[: alone + 1]):
        if one.cycle == "up":
            yield _location(k, alone, "cycle"), f'must not be "up" {why}'
        if one.cycles is not None:
            yield _location(k, alone, "cycles"), f"must not be given {why}"
        if (one.table or one.segments) and one.repeats != ENDLESS:
            yield _location(k, alone, "repeats"), f'must be "{ENDLESS}" {why}'
        if one.ramp > 0:
            yield _location(k, alone, "ramp"), f"must not be given {why}"


def _too_many(plate: Table, actuators: Iterable[Any], duration: float) -> str:
    """What is wrong with a duration [s] in which drives make more strokes than can be followed; "": nothing."""
    motion = getattr(plate, "motion", None)
    axes = [drive for _, drive in motion if drive is not None] if isinstance(motion, Table) else []
    counts = [_cycles(drive, duration) for drive in (*actuators, *axes)]
    for count, most, of in (
        (max(counts, default=0.0), MAX_CYCLES, "each drive"),
        (sum(counts), MAX_TOGETHER, "all drives together"),
    ):
        if count > most:
            return f"must have at most {most} cycles, or points, of {of}; got {count:.3g} in {duration:g} s"
    return ""


def _cycles(drive: Any, duration: float) -> float:
    """How many cycles, or points, a drive runs through in a time [s]."""
    if drive.cycle == "up":
        return 0.0
    if drive.table:
        pieces = [(drive.table[-1][0], len(drive.table))]
    elif drive.segments:
        pieces = [(s.cycles * (1 / s.frequency if s.frequency else s.dwell), s.cycles) for s in drive.segments]
    else:
        return float(min(duration * drive.frequency, math.inf if drive.cycles is None else drive.cycles))
    total = sum(time for time, _ in pieces)
    passes = min(math.inf if drive.repeats == ENDLESS else drive.repeats, duration / total if total > 0 else 1.0)
    count, left = passes // 1 * sum(cycles for _, cycles in pieces), passes % 1 * total
    for time, cycles in pieces:
        count += cycles * min(1.0, left / time) if time > 0 else 0.0
        left = max(0.0, left - time)
    return count
