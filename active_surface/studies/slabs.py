"""Slabs: the boxes of an array that a run of its elements, counted with the last index fastest, is made of."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

Slab = tuple[slice, ...]


def slabs(shape: Sequence[int], start: int, stop: int) -> Iterator[tuple[Slab, int]]:
    """Yield the boxes, in order, that elements start to stop - 1 of an array make up, each with its number of them."""
    if start >= stop:
        return
    if len(shape) == 1:
        yield (slice(start, stop),), stop - start
        return
    inner = math.prod(shape[1:])
    first, last = start // inner, (stop - 1) // inner
    if first == last:
        yield from _within(first, slabs(shape[1:], start - first * inner, stop - first * inner))
        return
    whole_from, whole_to = -(-start // inner), stop // inner
    if start % inner:
        yield from _within(first, slabs(shape[1:], start % inner, inner))
    if whole_to > whole_from:
        rest = tuple(slice(0, n) for n in shape[1:])
        yield (slice(whole_from, whole_to), *rest), (whole_to - whole_from) * inner
    if stop % inner:
        yield from _within(last, slabs(shape[1:], 0, stop % inner))


def _within(index: int, inner: Iterator[tuple[Slab, int]]) -> Iterator[tuple[Slab, int]]:
    for slab, count in inner:
        yield (slice(index, index + 1), *slab), count
