"""Drift: the displacement of a part in a period of the drives, from everywhere on the plate, by groups of actuators."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from active_surface.arrays import BoolArray, FloatArray, IntArray
from active_surface.studies.drift.basins import STILL, Basins, Fate, Field, basins_of
from active_surface.studies.feasibility.area import moving
from active_surface.studies.feasibility.counting import HANGS, RESTS, find_states
from active_surface.studies.feasibility.places import responses_of, resting_of, squares_within
from common import draw, percent, quantity
from coupling import (
    PathTask,
    Progress,
    ProgressCallback,
    SolvedPlates,
    build_friction,
    build_part,
    follow,
    no_progress,
    one_blas_thread,
    silent,
    whole_file,
)
from coupling.borders import KEPT, at_rest
from coupling.case import Case, PlateCase, endless_case, groups_of, running_case
from coupling.drives import build_drives
from coupling.scene import PlateScene
from coupling.stretch import schedule_of
from coupling.vibration import always_running
from meshes import Outline
from particle import Outcome, PartAtRest, State, Trajectory
from particle.friction import LOCAL, Contact, ScaledFriction

if TYPE_CHECKING:
    import xarray

ACROSS: Final = 32  # places along the plate's longer side
LOOSE: Final = 1e-6  # the tolerance of the paths, unless that of the case is larger
PER_STROKE: Final = 10  # moments in the shortest stroke, at which a part at rest is looked at
SURE: Final = 0.8  # of the friction limit: a part that is pulled less at these moments never slips
CHECKED: Final = 8  # runs that a map is compared with
MOST: Final = 40  # periods of each
SEED: Final = 1
NAMED: Final = 3  # ends, in words


@dataclass(frozen=True, eq=False)
class DriftMap:
    """Where a part goes in a period of some actuators, which have always been running, from rest at n places."""

    name: str  # of the group
    actuators: tuple[int, ...]  # that run; the others hold the plate where it is
    period: float  # s
    field: Field
    starts: FloatArray  # (n, 2) m
    turned: FloatArray  # (n,) rad, in a period; 0 of a point
    sliding: float  # share of the parts that still slide when the period ends
    gap: float  # m, the median between the ends of runs and those by this map; nan where it moves nothing
    checked: tuple[int, int]  # how many runs there were, and how many periods each
    outline: Outline
    places: FloatArray  # (N, 2) m, of all actuators

    @property
    def moved(self) -> FloatArray:
        """(n, 2) m, in a period."""
        return self.field.moved

    @property
    def fates(self) -> IntArray:
        """(n,) of `Fate`, within a period."""
        return self.field.fates

    @cached_property
    def basins(self) -> Basins:
        """Where parts end in the long run."""
        return basins_of(self.field, self.starts)

    @property
    def speed(self) -> float:
        """The largest mean speed [m/s] of a part that stays on."""
        return float(np.hypot(*self.moved.T).max(initial=0.0)) / self.period

    def figures(self) -> dict[str, Any]:
        """The figures by name, in SI units."""
        basins = self.basins
        return {
            "group": self.name,
            "actuators": list(self.actuators),
            "period": self.period,
            "fastest": self.speed,
            "stay": basins.stay,
            "come_off": basins.come_off,
            "leave": basins.leave,
            "ends": [{"place": list(one.place), "extent": one.extent, "share": one.share} for one in basins.ends],
            "still_sliding": self.sliding,
            "gap_to_runs": None if math.isnan(self.gap) else self.gap,
            "runs": self.checked[0],
            "periods_of_a_run": self.checked[1],
        }

    @property
    def text(self) -> str:
        """What becomes of the parts, in words."""
        basins = self.basins
        if not self.speed and not basins.come_off and not basins.leave:
            return "no part moves"
        ends = ["{} end {} ({:.4g}, {:.4g}) um".format(
            percent(one.share), "about" if one.extent > 2 * self.field.spacing else "at", *(1e6 * c for c in one.place)
        ) for one in basins.ends[:NAMED]]  # fmt: skip
        others = sum(one.share for one in basins.ends[NAMED:])
        shares = ((others, "elsewhere"), (basins.stay, "stay"), (basins.come_off, "come off"), (basins.leave, "leave"))
        found = [*ends, *(f"{percent(share)} {what}" for share, what in shares if share)]
        return f"up to {quantity(self.speed, 'm/s')}; of all starts {', '.join(found)}"


@dataclass(frozen=True, eq=False)
class Drift:
    """The drift of a case's part, for all of its actuators or for groups of them."""

    case: Case
    maps: tuple[DriftMap, ...]

    def figures(self) -> dict[str, Any]:
        """The figures by name, in SI units."""
        return {"maps": [one.figures() for one in self.maps]}

    def lines(self) -> list[tuple[str, str]]:
        """Rows (label, text) to print."""
        first = self.maps[0]
        rows = [("period", f"{quantity(first.period, 's')}, after which the drives repeat")] if len(self.maps) == 1 else []
        for one in self.maps:
            period = "" if len(self.maps) == 1 else f"in {quantity(one.period, 's')}; "
            rows.append((one.name, f"{period}{one.text}"))
            if not math.isnan(one.gap):
                runs, periods = one.checked
                rows.append(
                    ("", f"{runs} runs of {periods} periods end {quantity(one.gap, 'm', 2)} from where the map says")
                )
        spacing = quantity(first.field.spacing, "m")
        return [*rows, ("places", f"{len(first.starts)}, {spacing} apart, each from rest")]

    def warnings(self) -> list[str]:
        """What to know of it."""
        found = []
        if most := max(one.sliding for one in self.maps) > 0.05:
            share = percent(max(one.sliding for one in self.maps))
            found.append(f"{share} of the parts still slide when a period ends, so later periods carry them otherwise.")
        if self.case.part.face is not None:
            heading = math.degrees(self.case.part.heading)
            found.append(f"The drift is that at the heading of the case, {heading:g} deg, though the part turns.")
        return found

    def dataset(self) -> xarray.Dataset:
        """All of it with labels."""
        import xarray

        of_place, names = ("group", "place"), {int(fate): fate.name.lower() for fate in Fate}
        stack = {name: np.stack([getattr(one, name) for one in self.maps]) for name in ("moved", "turned", "fates")}
        first = self.maps[0]
        return xarray.Dataset(
            {
                "dx": (of_place, stack["moved"][..., 0], {"units": "m", "long_name": "displacement in a period"}),
                "dy": (of_place, stack["moved"][..., 1], {"units": "m", "long_name": "displacement in a period"}),
                "turn": (of_place, stack["turned"], {"units": "rad", "long_name": "turn in a period"}),
                "fate": (of_place, stack["fates"].astype(np.int8), {"meaning": str(names)}),
                "end": (of_place, np.stack([one.basins.of_start for one in self.maps]), {
                    "long_name": "number of the end, -1: it stays, -2: it comes off, -3: it leaves the plate"
                }),
                "period": ("group", [one.period for one in self.maps], {"units": "s"}),
            },
            {
                "group": ("group", [one.name for one in self.maps]),
                "x": ("place", first.starts[:, 0], {"units": "m"}),
                "y": ("place", first.starts[:, 1], {"units": "m"}),
            },
            {"case": self.case.source or "", "spacing": first.field.spacing},
        )  # fmt: skip

    def plot(self) -> Any:
        """A figure of all maps."""
        return draw(self)

    def write(self, folder: Path) -> tuple[Path, ...]:
        """Writes NAME.drift.nc and NAME.drift.png into a folder; returns them."""
        from coupling.pictures import save_picture  # here, because it loads matplotlib

        folder.mkdir(parents=True, exist_ok=True)
        data = folder / f"{self.case.name}.drift.nc"
        with whole_file(data) as partial:
            partial.write_bytes(self.dataset().to_netcdf(engine="h5netcdf"))
        return data, save_picture(draw(self), folder / f"{self.case.name}.drift.png")


def drift(
    case: Case,
    groups: str | Mapping[str, Sequence[int]] = "all",
    across: int = ACROSS,
    threads: int | None = None,
    progress: Progress = silent,
    plates: SolvedPlates | None = None,
) -> Drift:
    """Find where the drives of a case carry its part in a period, from rest at places all over the plate.

    The drives have always been running, whatever their delays, numbers of cycles and ramps. Where a period carries a
    part from rest to rest, many periods are that map again and again, and `Basins` follows it to where parts end; how
    far runs from other places end from that is measured on CHECKED of them.

    Parameters
    ----------
    case : Case
        A case with a plate, whose drives have a common period.
    groups : str or mapping
        `"all"` actuators, or each of the `"columns"`, `"rows"` or actuators (`"each"`) alone, the others holding the
        plate where it is; or the numbers of the actuators by the groups' names.
    across : int
        Places along the plate's longer side.
    threads : int, optional
        Paths at a time, by default one a processor.
    progress : Progress
        Reports the progress of a stage.
    plates : SolvedPlates, optional
        Those of earlier cases.

    Returns
    -------
    drift : Drift
        One map for each group.

    Raises
    ------
    ValueError
        The case has a platform, or drives without a common period, or the part has no room on the plate.
    """
    if not isinstance(case.plate, PlateCase):
        raise ValueError("Input case of drift must have a plate on actuators; on a platform a part drifts everywhere alike")
    if case.air is not None and case.air.film:
        raise ValueError("Input case of drift must be without a film of air, which remembers the periods before")
    chosen = groups_of(case, groups) if isinstance(groups, str) else dict(groups)
    plates, maps = plates or SolvedPlates(progress), []
    with one_blas_thread():
        for name, numbers in chosen.items():
            maps.append(_map(running_case(endless_case(case), numbers), name, tuple(numbers), across, threads, progress, plates))
    return Drift(case, tuple(maps))


def _map(
    case: Case, name: str, numbers: tuple[int, ...], across: int, threads: int | None, progress: Progress,
    plates: SolvedPlates,
) -> DriftMap:  # fmt: skip
    """The map of a case whose drives have no end."""
    duration, schedule = case.run.duration, schedule_of([always_running(one) for one in build_drives(case)], math.inf)
    if schedule.loop < 0:
        raise ValueError("Input case of drift must have drives with a common period; give frequencies in a ratio of whole numbers")
    period = float(schedule.edges[-1] - schedule.edges[schedule.loop])
    settings = {"duration": period, "start": "steady", "tolerance": max(case.run.tolerance, LOOSE), "after_detachment": "stop"}
    still = case.part.model_copy(update={"velocity": (0.0, 0.0), "spin": 0.0})
    case = case.model_copy(update={"run": case.run.model_copy(update=settings), "part": still})
    scene, law = plates.scene(case), build_friction(case)
    assert isinstance(scene, PlateScene)
    rest = at_rest(case, scene.surface, build_part(case), law)
    squares = squares_within(scene.shapes.outline, across, rest)
    starts, n = squares.centres, len(squares.centres)
    moved, turned, fates = np.zeros((n, 2)), np.zeros(n), np.zeros(n, dtype=np.int64)
    slips = np.flatnonzero(~_never_slips(case, scene, rest, law, starts))

    def follow_from(places: FloatArray, periods: int, tell: ProgressCallback = no_progress) -> list[Trajectory]:
        run = case.run.model_copy(update={"duration": periods * period})
        return follow([PathTask(scene.surface, build_part(case, (x, y)), law, run) for x, y in places.tolist()], threads, tell)

    with progress(f"Following parts, {name}") as tell:
        paths = follow_from(starts[slips], 1, tell)
    for k, path in zip(slips.tolist(), paths, strict=True):
        fates[k] = _fate(path)
        if fates[k] == Fate.MOVES:
            moved[k] = path.position[-1] - path.position[0]
            turned[k] = 0.0 if path.heading is None else path.heading[-1] - path.heading[0]
    fates[(fates == Fate.MOVES) & (np.hypot(*moved.T) < STILL * squares.side)] = Fate.STAYS
    moved[fates == Fate.STAYS] = 0.0
    sliding = sum(path.state[-1] == State.SLIP for path in paths) / n
    field, gap, checked = Field.of(starts, squares.side, moved, fates), math.nan, (0, 0)
    if (fates == Fate.MOVES).any():
        periods = int(np.clip(round(duration / period), 1, MOST))
        with progress(f"Comparing runs, {name}"):
            gap, checked = _gap(field, starts, lambda places: follow_from(places, periods), periods)
    return DriftMap(
        name, numbers, period, field, starts, turned, float(sliding), gap, checked, scene.shapes.outline,
        scene.shapes.points,
    )  # fmt: skip


def _never_slips(case: Case, scene: PlateScene, rest: PartAtRest, law: Contact, starts: FloatArray) -> BoolArray:
    """Whether a part at rest is pulled by less than SURE of what friction holds, at each place (n,); False: not known.

    At as many moments as show the shortest stroke; not where the plate rings, or the contact is local.
    """
    if scene.has_inertia or rest.part.law.kind == LOCAL:
        return np.zeros(len(starts), dtype=np.bool_)
    period, table = case.run.duration, scene.surface.drives
    stroke = float(table.stroke_time[moving(table)].min(initial=period))
    moments = np.linspace(0.0, period, math.ceil(PER_STROKE * period / stroke) + 1)
    weaker = at_rest(case, scene.surface, build_part(case), ScaledFriction(law, SURE))
    still, states, own = np.ones(len(starts), dtype=np.bool_), np.zeros((len(starts), 1), dtype=np.int8), np.ones(1)
    resting = resting_of(weaker)
    for responses in responses_of(weaker, starts, moments)():
        find_states(responses, own, weaker.part, resting, states)
        still &= (states[:, 0] == RESTS) | (states[:, 0] == HANGS)
    return still


def _gap(
    field: Field, starts: FloatArray, follow_from: Callable[[FloatArray], list[Trajectory]], periods: int
) -> tuple[float, tuple[int, int]]:
    """The median [m] between ends of runs from places within squares that move, and those by the map; their numbers."""
    chance = np.random.default_rng(SEED)
    movers = starts[field.fates == Fate.MOVES]
    places = movers[chance.choice(len(movers), min(CHECKED, len(movers)), replace=False)]
    places = places + field.spacing * chance.uniform(-0.5, 0.5, places.shape)
    ends, fates = field.carried(places, periods)
    paths = follow_from(places)
    gaps = [
        math.inf if _fate(path) > Fate.MOVES or fate > Fate.MOVES else float(np.hypot(*(path.position[-1] - end)))
        for path, end, fate in zip(paths, ends, fates, strict=True)
        if not (_fate(path) > Fate.MOVES and fate > Fate.MOVES)
    ]
    return float(np.median(gaps)) if gaps else math.nan, (len(paths), periods)


def _fate(path: Trajectory) -> Fate:
    if path.outcome is Outcome.LEFT_PLATE:
        return Fate.LEAVES
    return Fate.MOVES if path.outcome in KEPT else Fate.COMES_OFF
