"""Kicks in a measured motion: where a jump of a derivative explains the samples significantly better than none.

An impact is a jump of velocity. Jumps of acceleration and jerk, as at the ends of strokes, are sought beside it, so
that they are not taken for impacts.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coupling.measured.series import NO_KICKS, ORDER, Series, pass_over
from particle import kernel

FloatArray = NDArray[np.float64]

SIGNIFICANCE = 0.01  # the probability that a smooth motion gets any jump
SHARES, FINE_SHARES = np.arange(4) / 4, np.arange(32) / 32  # of a step, at which a jump is sought between two samples
ROUGHNESS = np.arange(-16.0, 8.0, 1.0)  # decimal logarithms of those that a window may have
HALF_WINDOW = (30, 1000)  # samples
WIDER = 4  # times that half, to tell jumps of velocity and of jerk apart
LENIENCE = 8.0  # by which jumps of jerk may stay below the threshold at first: together they may exceed it
FELT = 12.0  # half a window, over the time that a sample is felt
NEAR = 1e-3  # of a step: nearer to a sample a jump is at the sample
LEAST_KNOWN = 1e-3  # information on a jump, in noises and steps: less is no test
MAX_ROUNDS = 200
VELOCITY = 1
KINDS = (VELOCITY, 2, 3)  # derivatives that may jump
PREFERENCE = 4.0  # for a kick of the next higher derivative
WIDE_PREFERENCE = 3.0  # and in a wider window


def threshold(count: int, significance: float = SIGNIFICANCE) -> float:
    """What a jump among so many samples must exceed: twice the logarithm of the ratio of likelihoods."""
    from scipy.stats import chi2

    return float(chi2.isf(significance / (2 * count), 1))


def find_kicks(series: Series, roughness: float, significance: float = SIGNIFICANCE) -> FloatArray:
    """The kicks (k, 2) of a series: when, in its units, and which derivative jumps.

    One is accepted where it raises the likelihood of the samples around it by more than the threshold, whatever the
    roughness of the motion there, with the kick and without. The surest in its surroundings comes first. In the end
    each must still do so beside all others.

    roughness: of the smooth motion, which says how far a sample is felt.
    """
    least = threshold(len(series.time), significance)
    half = int(np.clip(FELT * roughness ** (-1 / (2 * ORDER)), *HALF_WINDOW))
    sought = _sought(series, NO_KICKS, half, least, LENIENCE)
    kicks = _proven(series, sought, half, least)
    if len(kicks) < len(sought):
        kicks = _proven(series, _sought(series, kicks, half, least, 0.0), half, least)
    return _told_apart(series, kicks, half, least)


def _sought(series: Series, kicks: FloatArray, half: int, least: float, lenience: float) -> FloatArray:
    """These kicks and all others that exceed the threshold; jumps of jerk may stay below it by the lenience."""
    count = len(series.time)
    middles = range(half, max(count - half, half) + half, half)
    found = [_best(series, middle, half, kicks, SHARES) for middle in middles]
    for _ in range(MAX_ROUNDS):
        new: list[float] = []
        for ratio, time, kind in sorted(found, reverse=True):
            enough = ratio > least - (lenience if kind == KINDS[-1] else 0.0)
            if enough and all(abs(time - other) > 2 * half for other in new):
                new.append(time)
        if not new:
            break
        settled = np.array([_settled(series, time, half, kicks)[1:] for time in new])
        kicks = _sorted(np.concatenate([kicks, settled]))
        for k, middle in enumerate(middles):
            if np.abs(series.time[min(middle, count - 1)] - np.array(new)).min() < 4 * half:
                found[k] = _best(series, middle, half, kicks, SHARES)
    return kicks


def _sorted(kicks: FloatArray) -> FloatArray:
    return kicks[np.argsort(kicks[:, 0])]


def _proven(series: Series, kicks: FloatArray, half: int, least: float) -> FloatArray:
    """The kicks that are significant beside all others, each at its likeliest time; the least goes first."""

    def settled(k: int) -> tuple[float, float, float]:
        reach = half if kicks[k, 1] == VELOCITY else WIDER * half
        return _settled(series, kicks[k, 0], reach, np.delete(kicks, k, 0))

    table = np.array([settled(k) for k in range(len(kicks))])
    while len(kicks) and table[worst := int(np.argmin(table[:, 0])), 0] <= least:
        gone, kicks, table = kicks[worst, 0], np.delete(kicks, worst, 0), np.delete(table, worst, 0)
        for k in np.flatnonzero(np.abs(kicks[:, 0] - gone) < WIDER * half).tolist():
            table[k] = settled(k)
    return _sorted(table[:, 1:]) if len(kicks) else kicks


def _told_apart(series: Series, kicks: FloatArray, half: int, least: float) -> FloatArray:
    """The kicks; a jump of velocity stays one if it is the likeliest in a wider window, where jumps of jerk differ."""
    while len(impacts := np.flatnonzero(kicks[:, 1] == VELOCITY)):
        beside = [np.delete(kicks, k, 0) for k in impacts]
        wide = np.array(
            [
                _settled(series, kicks[k, 0], WIDER * half, others, WIDE_PREFERENCE)
                for k, others in zip(impacts, beside, strict=True)
            ]
        )
        doubtful = np.flatnonzero(wide[:, 2] != VELOCITY)
        if not len(doubtful):
            break
        worst = doubtful[np.argmin(wide[doubtful, 0])]
        kicks = beside[worst]
        if wide[worst, 0] > least:
            kicks = _sorted(np.concatenate([kicks, wide[[worst], 1:]]))
    return kicks


def _settled(
    series: Series, time: float, half: int, others: FloatArray, preference: float = PREFERENCE
) -> tuple[float, float, float]:
    """The ratio of a kick, its likeliest time within two steps of the one given, and its kind."""
    middle = int(np.searchsorted(series.time, time))
    return _best(series, middle, half, others, FINE_SHARES, (time - 2.0, time + 2.0), preference)


def _best(
    series: Series,
    middle: int,
    half: int,
    kicks: FloatArray,
    shares: FloatArray,
    between: tuple[float, float] = (-np.inf, np.inf),
    preference: float = PREFERENCE,
) -> tuple[float, float, float]:
    """The surest further kick in the window around a sample, between two times: its ratio, time and kind."""
    part = series.window(max(middle - half, 0), middle + half)
    inside = kicks[(kicks[:, 0] > part.time[0]) & (kicks[:, 0] < part.time[-1])]
    ratio, place = ratios(part, inside, shares)
    ratio = np.where((place > between[0]) & (place < between[1]), ratio, -np.inf)
    best = ratio.max(axis=1) + preference * np.arange(len(KINDS))
    kind = int(np.argmax(best))
    k = int(np.argmax(ratio[kind]))
    return float(ratio[kind, k]), float(place[kind, k]), float(KINDS[kind])


def ratios(series: Series, kicks: FloatArray, shares: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Twice the logarithm of the ratio of likelihoods of a further kick of each kind in each step, and when: (3, N)."""
    nodes, _ = series.nodes(kicks)
    best, place = np.full((2, len(KINDS), len(nodes.time)), -np.inf)
    smooth_best = -np.inf
    for logarithm in ROUGHNESS:
        out, squares, logarithms = pass_over(series, nodes, 10.0**logarithm)
        fits = -squares - logarithms
        smooth_best = max(smooth_best, fits)
        seek(nodes.time, out.score, out.information, shares, fits, best, place)
    return best - smooth_best, place


@kernel
def seek(
    time: FloatArray,
    score: FloatArray,
    information: FloatArray,
    shares: FloatArray,
    fits: float,
    best: FloatArray,
    place: FloatArray,
) -> None:
    """Note where a kick, a share of a step before a node, raises a likelihood `fits` above the best so far (3, N)."""
    shock = np.zeros(len(best) + 1)
    for k in range(1, len(time)):
        length, r, n = time[k] - time[k - 1], score[k], information[k]
        for i in range(len(shares) + 1):
            lever, rows = shares[min(i, len(shares) - 1)] * length, len(best)
            if i == len(shares):
                # Where in the step a jump of velocity is likeliest.
                height, velocity = n[1, 1] * r[0] - n[0, 1] * r[1], n[0, 0] * r[1] - n[0, 1] * r[0]
                lever, rows = height / velocity if velocity != 0.0 else 0.0, 1
                if not NEAR * length < lever < (1 - NEAR) * length:
                    continue
            for row in range(rows):
                # What a kick of the derivative row + 1 makes of the state at the node.
                factor = 1.0
                for j in range(row + 1, -1, -1):
                    shock[j] = factor
                    factor *= lever / (row + 2 - j)
                top = bottom = 0.0
                for j in range(row + 2):
                    top += shock[j] * r[j]
                    for m in range(row + 2):
                        bottom += shock[j] * shock[m] * n[j, m]
                gain = fits + top * top / bottom if bottom > LEAST_KNOWN else fits
                if gain > best[row, k]:
                    best[row, k], place[row, k] = gain, time[k] - lever
