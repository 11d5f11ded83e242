"""The table of the paper's statements: what it says, what we answer from measured numbers, and when that is met.

Numbers are those of one model, by the names that the computations of the figures give them, in SI units.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite
from typing import Final

from active_surface.paper.verdict import HARDLY_ANY, NEARLY_ALL, Numbers, Share, Statement

SLIP, STICK, WITHIN = 2.41, 2.87, 0.02  # s, figure 4, and how near counts
BEGINS, LARGEST, RANGE = (150.0, 250.0), (300.0, 400.0), (300.0, 1000.0)  # Hz, figures 5 ("about 200") and 6
NEAR: Final = 1.25  # ratio up to which ends of that range are the same
RADIAL: Final = 1e-9  # relative, figures 11 and 12
SLOWS, AS_STATED, STRAIGHT = 20.9, 0.05, 0.99  # m/s^2, half of its last digit, share of the variance on a line
GROWS: Final = 0.9  # share of the neighbouring frequencies between which the distance grows, figure 15
THIRD: Final = 0.33  # of the wavelength, that the pitch is
THRESHOLD, THRESHOLD_STROKE, THRESHOLD_WITHIN = 320.0, 150e-6, 20.0  # Hz, m, Hz: figure 18, and how near counts
BAND, FINE = 5e-6, 1e-6  # m, figure 22


def _hertz(values: Iterable[float]) -> str:
    return ", ".join(f"{value:.0f}" for value in values)


def _percents(shares: Iterable[Share]) -> str:
    return ", ".join(f"{100 * share.value:.0f}" for share in shares) + " %"


def _rates(n: Numbers) -> str:
    return " and ".join(f"{rate:.2f}" for rate in n["rate"]) + " m/s^2"


def _slides(n: Numbers) -> str:
    pause = n["again"] - n["sticks"]
    text = f"slips {n['slips']:.3f}, sticks {n['sticks']:.3f} s" + (f" for {pause:.2f} s" if pause > 0 else "")
    return text + ("" if n["turns"] else ", goes on the same way")


def _in_range(n: Numbers) -> list[bool]:
    ends = list(zip(*n["halves"], strict=True))
    same = [all(1 / NEAR <= f / stated <= NEAR for f in end) for end, stated in zip(ends, RANGE, strict=True)]
    return [*same, all(max(end) / min(end) <= NEAR for end in ends)]


def contrast(n: Numbers) -> float:
    """Whether few reach the neighbour at the low frequency, and most at every other: figure 16."""
    low, *high = (share.met for share in n["reach"])
    return 0.0 if low == 1 or min(high) == 0 else 1.0 if low == 0 and min(high) == 1 else 0.5


def _zones(n: Numbers) -> str:
    text = f"at least {100 * NEARLY_ALL:.0f} % of the starts at every pitch up to {1e6 * n['widest_served']:.0f} um"
    text = f"{text}, there {n['there']}" if n["widest_served"] else "at no pitch looked at"
    alone = [pitch for pitch, share in zip(n["pitch"], n["touches_two"], strict=True) if share < HARDLY_ANY]
    text += f"; without an active surface fewer than {100 * HARDLY_ANY:.0f} % of the places touch two actuators or "
    return text + (f"more from {1e6 * min(alone):.0f} um on" if alone else "more at no pitch looked at")


STATEMENTS: Final[tuple[Statement, ...]] = (
    Statement(
        "3",
        "Friction equals the load along the surface up to its limit, and stays there while the part slides.",
        lambda n: f"to {n['largest_difference']:.0e} of the limit",
        lambda n: [n["largest_difference"] < 1e-2],
        how="On a platform whose acceleration grows steadily; to 1 % of the limit.",
    ),
    Statement(
        "4",
        "The part slips at 2.41 s, sticks for a moment at 2.87 s, then slides the other way.",
        _slides,
        lambda n: [
            abs(n["slips"] - SLIP) < WITHIN,
            abs(n["sticks"] - STICK) < WITHIN,
            n["again"] - n["sticks"] < WITHIN,
            n["turns"],
        ],
        how="To within 0.02 s. A reversal without rest counts as sticking for a moment. The first platform's motion "
        "and friction were chosen for both times.",
    ),
    Statement(
        "4 (reversals)",
        "The relative velocity is zero at every reversal of the platform.",
        lambda n: f"{'once' if n['after'] else 'not once'} after each, {'and' if n['there'] else 'not'} at it",
        lambda n: [n["after"], n["there"]],
        how="Zero once after every reversal and before the next; at that moment, to 1 % of the largest speed.",
    ),
    Statement(
        "5",
        "At three strokes alike nothing moves below about 200 Hz; the area grows with frequency, peaks, and falls as "
        "the part comes off.",
        lambda n: f"from {_hertz(n['onset'])} Hz, peaks at {_hertz(n['peaks'])} Hz",
        lambda n: [*(BEGINS[0] <= f <= BEGINS[1] for f in n["onset"]), n["grows"], n["falls"]],
        how="Strokes of 80, 95 and 110 um, chosen so, as larger ones begin lower; from 150 to 250 Hz. Growing and "
        "falling are judged to 5 %; with places where the part comes off later the area hardly falls.",
    ),
    Statement(
        "6",
        "The time integral peaks at 300 to 400 Hz, for all strokes.",
        lambda n: f"at {_hertz(n['largest'])} Hz",
        lambda n: [LARGEST[0] <= f <= LARGEST[1] for f in n["largest"]],
        how="As 5. Strokes that meet this are about twice as large.",
    ),
    Statement(
        "5, 6 (range)",
        "300 to 1000 Hz are feasible, almost whatever the stroke.",
        lambda n: ", ".join(f"{low:.0f} to {high:.0f}" for low, high in n["halves"]) + " Hz",
        _in_range,
        how="Frequencies at which the time integral is at least half of its peak; ends within a factor of 1.25 are "
        "the same.",
    ),
    Statement(
        "11",
        "Velocities along x and y stay proportional.",
        lambda n: f"constant to {n['ratio']:.0e}",
        lambda n: [n["ratio"] < RADIAL],
        how="One cycle from (170.08, 170.08) and (200, 100) um, the worst of both; to 1e-9.",
    ),
    Statement(
        "12",
        "The path from (170.08, 170.08) um runs straight through the actuator.",
        lambda n: f"straight to {n['bend']:.0e} of its length",
        lambda n: [n["bend"] < RADIAL],
        how="Distance from the line through start and actuator over the way gone, the worst of both starts; to 1e-9.",
    ),
    Statement(
        "13, 14",
        "After the stroke the part slows by a constant 20.9 m/s^2, from both starts.",
        _rates,
        lambda n: [
            min(n["straight"]) > STRAIGHT,
            abs(n["rate"][0] - n["rate"][1]) < AS_STATED,
            all(abs(rate - SLOWS) < AS_STATED for rate in n["rate"]),
        ],
        how="99 % of the variance on a line; rates that agree with each other and with 20.9 to 0.05 m/s^2.",
    ),
    Statement(
        "13, 14 (Table 1)",
        "Equations (3) to (5) with Table 1 give these 20.9 m/s^2.",
        lambda n: f"{n['at_zero_load']:.0f} m/s^2, {'moves' if any(n['distance']) else 'the part does not move'}",
        lambda n: [abs(n["at_zero_load"] - SLOWS) < AS_STATED],
        how="At zero load, without a surface; to 0.05 m/s^2.",
    ),
    Statement(
        "15",
        "At each stroke the part moves between a lowest frequency, set by friction, and a highest, where it comes off; "
        "the distance grows in between.",
        lambda n: (
            f"{n['first'][0]:.0f} to {n['last'][0]:.0f} Hz (least), "
            f"{n['first'][-1]:.0f} to {n['last'][-1]:.0f} Hz (largest stroke)"
        ),
        lambda n: [
            all(map(isfinite, n["first"])),
            all(how == "detached" for how in n["beyond_the_last"]),
            n["grows"] >= GROWS,
        ],
        how="Strokes of 60 to 100 um from (100, 100) um. Grows: between 90 % of neighbouring frequencies.",
    ),
    Statement(
        "VI-B",
        "150 um between actuators is about 33 % of the deformation's wavelength.",
        lambda n: ", ".join(f"{100 * share:.0f} % of {name}" for name, share in n.items()),
        lambda n: [any(abs(share - THIRD) <= 0.01 for share in n.values())],
        how="32 to 34 % of either length, as the paper does not say which is the wavelength.",
    ),
    Statement(
        "16",
        "At 250 Hz the part crosses the first actuator and returns to it; above, up to 650 Hz, it goes to the "
        "neighbour.",
        lambda n: f"{100 * n['returns'].value:.0f} % return, {_percents(n['reach'])} go over",
        lambda n: [n["returns"], contrast(n)],
        how="At 250, 350, 450, 550 and 650 Hz. Returns: gets beyond the first actuator and ends within half a pitch "
        "of it. Goes over: comes within half a pitch of the neighbour.",
    ),
    Statement(
        "17a",
        "From rest at (100, 100) um the part converges to the actuator at 300 Hz.",
        how="Converged: on the surface after 30 cycles, within 30 um of the actuator for the last five.",
    ),
    Statement(
        "17b",
        "From the same start at 600 Hz it leaves the actuator's region in two strokes.",
        lambda n: f"{n['share']} leave, {n['share_in_two']} in two",
        lambda n: [n["share"], n["share_in_two"]],
        how="Left: 200 um away or over the rim, and not come off before. Strokes are taken as cycles.",
    ),
    Statement(
        "19",
        "At 250 Hz parts converge from various places and velocities.",
        how="As 17a, from places within 150 um and velocities up to 0.02 m/s, as no states are listed.",
    ),
    Statement(
        "18",
        "At 150 um parts converge below a threshold of 320 Hz.",
        lambda n: f"{n['threshold']:.0f} Hz, below {n['below']} converge",
        lambda n: [abs(n["threshold"] - THRESHOLD) <= THRESHOLD_WITHIN, n["below"].met == 1],
        how="The lowest frequency, less half a step, at which more than 10 % of parts at rest 40 to 160 um from the "
        "actuator leave or come off; to 20 Hz. Parts that never move do not count.",
    ),
    Statement(
        "18 (above)",
        "Above the threshold parts leave the actuator's region.",
        lambda n: str(n["above"]),
        lambda n: [n["above"]],
        how="The same parts, up to 520 Hz. The others converge or go to and fro.",
    ),
    Statement(
        "18 (curve)",
        "The threshold is quadratic in the stroke from 100 to 200 um.",
        lambda n: f"off by {n['misfit']:.0f} Hz",
        lambda n: [n["misfit"] <= n["step"] / 2],
        how="The misfit, root of the summed squares over the numbers left free, is no more than half the step between "
        "frequencies.",
    ),
    Statement(
        "20",
        "From (100, 0) um, on the line through both, the part leaves the 450 Hz actuator and converges to the 300 Hz "
        "one, 150 um away.",
        how="Converged as 17a. The faster actuator is the one next to the start, at (150, 0) um.",
    ),
    Statement(
        "20 (five cycles)",
        "After five oscillations of the fast actuator it is in the slow one's region.",
        how="First nearer than half a pitch to the slow actuator, give or take one cycle.",
    ),
    Statement(
        "21",
        "From (-50, 15) um the part leaves the 400 Hz actuator and converges to the 300 Hz one at (150, 0) um.",
        how="Converged as 17a.",
    ),
    Statement(
        "VI-C (anywhere)",
        "From anywhere on the workcell a part leaves the high frequency and converges to the low one.",
        how="At rest, up to 100 um beyond both actuators, with the frequencies of 20. Parts that never move do not "
        "arrive.",
    ),
    Statement(
        "22",
        "Parts end within 5 um of the actuator, for 240 to 320 Hz and a set of states.",
        lambda n: (
            f"{n['share']}, by frequency {100 * min(n['by_frequency']).value:.0f} to "
            f"{100 * max(n['by_frequency']).value:.0f} %"
        ),
        lambda n: n["by_frequency"],
        how="Five states, 30 cycles; judged at each of 9 frequencies.",
    ),
    Statement(
        "22 (1 um)",
        "For certain combinations of parameters, within 1 um.",
        lambda n: f"{n['combinations']} of {n['of']} combinations",
        lambda n: [n["combinations"] > 0],
        how="Combinations of state and frequency; one is enough.",
    ),
    Statement(
        "22 (two cases)",
        "Within 1 um from (80, 80) um at 250 Hz, and from (100, 100) um with (0.01, 0.01) m/s at 300 Hz.",
        lambda n: " and ".join(map(str, n["shares"])),
        lambda n: n["shares"],
        how="Where a single part stops is chance to the last micrometre of its start.",
    ),
    Statement(
        "beyond: dead zones",
        "There are no dead zones (the paper gives no number): parts reach their nearest actuator from all around.",
        _zones,
        lambda n: [0.0],
        beyond=True,
        how="The nearest actuator alone brings the part within 10 um of it: strokes of 50, 100 and 150 um, 150 to 900 "
        "Hz, 30 cycles. That is less than handing it on, which is what touching two is for.",
    ),
)
