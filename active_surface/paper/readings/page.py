"""Page: where each statement of the paper holds, over all readings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final, NamedTuple

from active_surface.paper.models import CLOSED, MODELS, PAPER, PLATE
from active_surface.paper.readings.reading import LAWS, Reading
from active_surface.paper.readings.sweep import Row, Sweep
from active_surface.paper.share import NEARLY_ALL

STATEMENTS: Final = {
    "5": "three strokes begin to move parts at about 200 Hz; the area grows, peaks and falls",
    "6": "the integral is largest at 300 to 400 Hz for three strokes",
    "5, 6 (range)": "300 to 1000 Hz are feasible, almost whatever the stroke",
    "11": "velocities along x and y are constant multiples",
    "12": "the path from (170.08, 170.08) um is straight",
    "13, 14": "straight decline by 20.9 m/s^2",
    "15": "from a lowest frequency, held by friction, to a highest, where it comes off",
    "VI-B": "150 um are 33 % of the wavelength",
    "16": "at 250 Hz it returns to the first actuator, at 350 to 650 Hz it goes to the neighbour",
    "17a": "at 300 Hz it converges",
    "17b": "at 600 Hz it leaves in two strokes",
    "18": "the threshold is 320 Hz, below it parts converge",
    "18 (above)": "above the threshold parts leave",
    "18 (curve)": "the threshold is a quadratic function of the stroke",
    "19": "at 250 Hz all states converge",
    "20": "it leaves the 450 Hz actuator and converges to the 300 Hz one",
    "20 (five cycles)": "that takes five oscillations",
    "21": "it leaves the 400 Hz actuator and converges to the 300 Hz one",
    "VI-C (anywhere)": "from anywhere parts converge to the low frequency",
    "22": "parts lie within 5 um",
    "22 (1 um)": "some lie within 1 um",
    "22 (two cases)": "the two stated ones lie within 1 um",
}
CHOICES_SHOWN: Final = 3


class Case(NamedTuple):
    """One reading with one choice of what a statement leaves open besides."""

    reading: Reading
    choice: str
    share: float

    @property
    def holds(self) -> bool:
        """Whether nearly all starts do what the paper says."""
        return self.share >= NEARLY_ALL


def cases_of(rows: Iterable[Row], model: str, statement: str) -> list[Case]:
    """All cases of a statement in a model."""
    return [
        Case(row.reading, choice, share)
        for row in rows
        for choice, share in row.shares.get(model, {}).get(statement, {}).items()
    ]


def where(holding: Sequence[Case], every: Sequence[Case]) -> str:
    """For which values of what is open some cases hold; what holds for all values is not named."""
    parts = []
    radii = sorted({case.reading.radius for case in holding})
    if len(radii) < len({case.reading.radius for case in every}):
        parts.append("a = " + ", ".join(f"{1e6 * radius:g}" for radius in radii))
    gravities = {case.reading.gravity for case in holding}
    if len(gravities) < len({case.reading.gravity for case in every}):
        parts.append("gravity" if holding[0].reading.gravity else "no gravity")
    laws = {case.reading.law for case in holding}
    if len(laws) < len({case.reading.law for case in every}):
        parts.append(", ".join(laws))
    choices = list(dict.fromkeys(case.choice for case in holding))
    if len(choices) < len({case.choice for case in every}):
        parts.append(" or ".join(choices[:CHOICES_SHOWN]) + (" or others" if len(choices) > CHOICES_SHOWN else ""))
    return "; ".join(parts) or "all"


def cell(cases: Sequence[Case]) -> str:
    """How often a statement holds, in a cell."""
    if not cases:
        return "-"
    holding = [case for case in cases if case.holds]
    if len(holding) == len(cases):
        return f"**everywhere** ({len(cases)})"
    if not holding:
        return f"**nowhere**, at most {100 * max(case.share for case in cases):.0f} %"
    return f"{len(holding)} of {len(cases)}"


def best_shares(row: Row, model: str) -> dict[str, float]:
    """By statement the best share over what it leaves open besides the reading."""
    return {name: max(shares.values()) for name, shares in row.shares.get(model, {}).items()}


def met(row: Row, model: str) -> list[str]:
    """The statements that hold by one reading."""
    return [name for name, share in best_shares(row, model).items() if share >= NEARLY_ALL]


def best_row(sweep: Sweep) -> Row:
    """The reading by which most statements hold in the paper's scheme, and among these in our equations."""
    return max(sweep.rows, key=lambda row: (len(met(row, PAPER)), len(met(row, CLOSED)), len(met(row, PLATE))))


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """In Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(row) + " |" for row in lines) + "\n"


def page_of_readings(sweep: Sweep, device: Mapping[str, str] | None = None) -> str:
    """The page in Markdown; device: what a real plate does, by statement."""
    best, size = best_row(sweep), sweep.size
    head = [
        "# The paper over its readings\n",
        "The paper does not state all that its figures rest on. A *reading* settles it. This page has, for each of the "
        "paper's statements, the readings by which it holds; [the paper, figure by figure](paper.md) shows one of "
        "them.\n",
        f"Written by `active-surface reproduce readings --output docs`, which took {sweep.seconds / 60:.0f} "
        "minutes of two "
        "shared cores.\n",
        _axes(sweep),
        "## Where each statement holds\n",
        _main_table(sweep, device),
        "Statements 3, 4 and 13, 14 with Table 1 need none of these choices: see [the "
        "paper](paper.md#verdicts). In 5 and "
        "6 the paper's scheme is ours, as the part rests. The plate is asked where there are two actuators; "
        "with one it "
        "does what the closed form does.\n",
        "## By radius\n",
        "The best share [%] over all else: the paper's scheme / our equations. **Bold**: it holds.\n",
        _radius_table(sweep),
        _finding(sweep),
        "## The best single reading\n",
        f"**{best.reading.name}**: {len(met(best, PAPER))} of {len(STATEMENTS)} statements hold in the paper's scheme, "
        f"{len(met(best, CLOSED))} in our equations. The next ones:\n",
        _ranking(sweep),
    ]
    assert size.starts
    return "\n".join(head).replace(" um", " µm").replace("m/s^2", "m/s²").rstrip() + "\n"


def _axes(sweep: Sweep) -> str:
    radii = sorted({row.reading.radius for row in sweep.rows})
    lines = [
        f"- the radius a of the profile: {', '.join(f'{1e6 * radius:g}' for radius in radii)} um",
        "- gravity: none, as in the paper's forces, or 9.80665 m/s^2",
        f"- what stands for the paper's 20.9 m/s^2, which Table 1 does not give: {' or '.join(LAWS)} (without "
        "pull-off; in "
        "the paper's scheme the first alone)",
        "- where the surface ends: at the profiles' rim, or flat beyond it (15, 20, 21, anywhere)",
        "- how two profiles are put together: added, or the nearest alone",
        "- strokes (5, 6, 15), cycles (16, 17b), starts (15, 16), how far a part is that has left (17b), "
        "which actuator is "
        "where (20)",
    ]
    return "\n".join([
        *lines,
        "",
        f"The share is that of {sweep.size.starts} starts that do what the paper says, at the worst frequency "
        "where there "
        f"are several; a statement holds by a reading if at least {100 * NEARLY_ALL:.0f} % do. For statements without "
        "starts (5, 6, 11 to 15, 18's curve) it is the share of what is stated. The paper's scheme takes steps of 5 µs "
        "here.\n",
    ])  # fmt: skip


def _main_table(sweep: Sweep, device: Mapping[str, str] | None) -> str:
    rows = []
    for name, text in STATEMENTS.items():
        every = {model: cases_of(sweep.rows, model, name) for model in MODELS}
        cells = [cell(cases) for cases in every.values()]
        said = []
        for model, cases in every.items():
            holding = [case for case in cases if case.holds]
            if holding and len(holding) < len(cases) and (text_of := where(holding, cases)) not in said:
                said.append(text_of if model == PAPER else f"{'ours' if model == CLOSED else 'plate'}: {text_of}")
        rows.append([name, text, *cells, ". ".join(said) or "-", *([device.get(name, "-")] if device else [])])
    return table(["figure", "the paper", *MODELS.values(), "where", *(["device"] if device else [])], rows)


def _radius_table(sweep: Sweep) -> str:
    radii = sorted({row.reading.radius for row in sweep.rows})
    rows = []
    for name in STATEMENTS:
        cells = []
        for radius in radii:
            own = [row for row in sweep.rows if row.reading.radius == radius]
            both = [_percent(cases_of(own, model, name)) for model in (PAPER, CLOSED)]
            cells.append(" / ".join(both))
        rows.append([name, *cells])
    return table(["figure", *(f"a = {1e6 * radius:g} um" for radius in radii)], rows)


def _percent(cases: Sequence[Case]) -> str:
    if not cases:
        return "-"
    best = max(cases, key=lambda case: case.share)
    text = f"{100 * best.share:.0f}"
    return f"**{text}**" if best.holds else text


def _finding(sweep: Sweep) -> str:
    radii = sorted({row.reading.radius for row in sweep.rows})
    held: dict[float, set[str]] = {}
    for radius in radii:
        own = [row for row in sweep.rows if row.reading.radius == radius]
        held[radius] = {name for name in STATEMENTS if any(case.holds for case in cases_of(own, PAPER, name))}
    anywhere = set().union(*held.values())
    full = [radius for radius in radii if held[radius] == anywhere]
    most = max(radii, key=lambda radius: len(held[radius]))
    never = [name for name in STATEMENTS if name not in anywhere]
    text = f"In the paper's scheme {len(anywhere)} of {len(STATEMENTS)} statements hold by some reading"
    text += f"; by none do {_list(never)}. " if never else ". "
    if full:
        return text + f"a = {1e6 * full[0]:g} um meets all of those.\n"
    lacking = [name for name in STATEMENTS if name in anywhere - held[most]]
    text += f"**No single radius meets them all**: at most {len(held[most])}, by a = {1e6 * most:g} um, where "
    return text + f"{_list(lacking)} fail.\n"


def _list(names: Sequence[str]) -> str:
    return "; ".join(names)


def _ranking(sweep: Sweep) -> str:
    order = sorted(sweep.rows, key=lambda row: (-len(met(row, PAPER)), -len(met(row, CLOSED))))
    rows = [
        [
            row.reading.name,
            str(len(met(row, PAPER))),
            str(len(met(row, CLOSED))),
            f"{row.thresholds.get(PAPER, float('nan')):.0f}",
        ]
        for row in order[:6]
        if PAPER in row.shares
    ]
    return table(
        ["reading", "hold, paper's scheme", "hold, our equations", "threshold of figure 18, paper's scheme, Hz"], rows
    )
