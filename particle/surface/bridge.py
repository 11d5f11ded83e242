"""Bridges: which kinks end a span, and what stands for drives over those that do not.

The kinks of drives that hardly count in the cell need not end a span: over these such a drive is replaced by the
quintic that has its height, velocity and acceleration at both ends, so that it takes up nothing but what the third
derivative's jump does in between.
"""

from __future__ import annotations

import math
from typing import Any

from particle.drives import drive_piece
from particle.jit import bare
from particle.surface.local import (
    ACCELERATION,
    BASE,
    CELL,
    DRIVES,
    END,
    LANDED,
    LONGEST,
    ROUGH,
    SLACK,
    TIME,
    UNIT,
    UNTIL,
    VELOCITY,
    Local,
)

# A jump J of the third derivative, bridged over a time T, is off by up to these times J T^2 and J T.
OFF_VELOCITY, OFF_ACCELERATION = 0.004737, 0.0625
LONGEST_BRIDGE, SHORTEST_BRIDGE = 0.25, 0.02  # of the shortest stroke, of the longest bridge: rounding makes more of it
FINER, FINEST = 4.0, 1e-12  # steps of the roughness from which kinks end a span
PAYS = 0.9  # of the spans: how many may be left for bridges to be worth it


@bare
def allow(local: Local, velocity: float, acceleration: float) -> None:
    """By how much [m/s, m/s^2] the surface's motion may be off, from the next span on, where kinks are bridged."""
    local.frame[VELOCITY], local.frame[ACCELERATION] = velocity, acceleration


@bare
def drive_of(surface: Any, local: Local, i: int) -> int:
    """The drive that is i-th in the cell; the base's two follow the cell's."""
    beyond = i - (local.counts[DRIVES] - local.counts[BASE])
    if beyond >= 0:
        return int(surface.shape_count + beyond)
    return int(surface.cells.drive[surface.cells.first_drive[local.counts[CELL]] + i])


@bare
def find_roughness(surface: Any, local: Local, i: int) -> None:
    """How rough the i-th drive is in this cell."""
    cells, rough = surface.cells, surface.drives.rough[drive_of(surface, local, i)]
    counted = i < local.counts[DRIVES] - local.counts[BASE]
    weight = cells.weight[cells.first_drive[local.counts[CELL]] + i] if counted else math.inf
    local.clock[i, ROUGH] = weight * rough if rough > 0.0 else 0.0


@bare
def find_end(surface: Any, local: Local, end: float) -> None:
    """Where the span from frame[TIME] ends, at most at `end` [s]."""
    f, clock = local.frame, local.clock
    if f[VELOCITY] == 0.0:
        f[LANDED] = f[LONGEST] = 0.0
    elif f[LONGEST] == 0.0:
        _choose(surface, local)
    first = landed = end
    for i in range(local.counts[DRIVES]):
        first = min(first, clock[i, UNTIL])
        if clock[i, ROUGH] >= f[LANDED]:
            landed = min(landed, clock[i, UNTIL])
    f[END] = max(first, min(landed, f[TIME] + f[LONGEST]))


@bare
def _choose(surface: Any, local: Local) -> None:
    """From which roughness on kinks end a span, and how long the others may be bridged: what makes fewest spans."""
    f, clock, drives = local.frame, local.clock, surface.drives
    roughest = kinks = 0.0
    for i in range(local.counts[DRIVES]):
        kinks += _kink_rate(drives, drive_of(surface, local, i))
        if math.isfinite(clock[i, ROUGH]):
            roughest = max(roughest, clock[i, ROUGH])
    f[LANDED], f[LONGEST], fewest = 0.0, LONGEST_BRIDGE * f[UNIT], PAYS * kinks
    limit = FINER * roughest
    while limit > FINEST * roughest:
        landed = rough = 0.0
        for i in range(local.counts[DRIVES]):
            if clock[i, ROUGH] >= limit:
                landed += _kink_rate(drives, drive_of(surface, local, i))
            else:
                rough += clock[i, ROUGH]
        longest = LONGEST_BRIDGE * f[UNIT]
        if rough > 0.0:
            by_velocity = math.sqrt(f[VELOCITY] / (OFF_VELOCITY * rough))
            longest = min(longest, by_velocity, f[ACCELERATION] / (OFF_ACCELERATION * rough))
        if landed + 1 / longest < fewest:
            f[LANDED], f[LONGEST], fewest = limit, longest, landed + 1 / longest
        limit /= FINER


@bare
def _kink_rate(drives: Any, i: int) -> float:
    """Kinks a second of a drive that is running."""
    return float((drives.first[i + 1] - drives.first[i]) / drives.span[i])


@bare
def is_bridged(local: Local, i: int) -> bool:
    """Whether the i-th drive has a kink within the span."""
    f, row = local.frame, local.clock[i]
    return bool(row[UNTIL] < f[END] - row[SLACK] and f[END] - f[TIME] > SHORTEST_BRIDGE * f[LONGEST])


@bare
def bridge(surface: Any, local: Local, i: int) -> None:
    """Replace the piece of the i-th drive from frame[TIME] on by a bridge to frame[END], if it needs one."""
    if not is_bridged(local, i):
        return
    f, row, ahead = local.frame, local.clock[i], local.ahead
    drive_piece(surface.drives, drive_of(surface, local, i), f[END], f[UNIT], ahead)
    s = (f[END] - f[TIME]) / f[UNIT]
    height = ahead[0] - (row[0] + s * (row[1] + s * row[2]))
    velocity = s * (ahead[1] - (row[1] + 2 * s * row[2]))
    acceleration = s * s * (ahead[2] - row[2])
    row[3] = (10 * height - 4 * velocity + acceleration) / s**3
    row[4] = (7 * velocity - 15 * height - 2 * acceleration) / s**4
    row[5] = (6 * height - 3 * velocity + acceleration) / s**5
    row[UNTIL] = f[END]
