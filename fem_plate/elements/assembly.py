"""Assembly of element matrices into a sparse matrix, by blocks between entities: points, edges and triangles.

Sorting pairs of entities rather than pairs of unknowns makes this several times cheaper than summing triplets.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_matrix

from fem_plate.elements.argyris import CORNER, Reference
from fem_plate.types import FloatArray, IntArray
from meshes import edge_numbers, sides

CHUNK = 20_000  # triangles scattered at a time, to bound memory


def number_entities(points: IntArray, corners: IntArray, functions: Reference) -> tuple[IntArray, IntArray]:
    """The entities of each triangle (m, 7), its corners, edges and itself, and the first unknown of each entity.

    points: (m, 3), the mesh points of each triangle, which identify its edges.  corners: (m, 3), numbered from 0.
    """
    edges, edge = np.unique(edge_numbers(sides(points), points.max() + 1), return_inverse=True)
    count, own = int(corners.max()) + 1, np.arange(len(corners))[:, None]
    entities = np.concatenate([corners, count + edge.reshape(-1, 3), count + len(edges) + own], axis=1)
    sizes = np.repeat([CORNER, functions.on_edge, functions.own], [count, len(edges), len(corners)])
    return entities, np.concatenate([[0], np.cumsum(sizes)])


def numbered(entities: IntArray, first: IntArray) -> tuple[IntArray, IntArray]:
    """The entity of each of a triangle's unknowns, among its own, and the place of the unknown in there, (n,) each."""
    sizes = np.diff(first)[entities[0]]
    return np.repeat(np.arange(len(sizes)), sizes), np.concatenate([np.arange(size) for size in sizes.tolist()])


def sum_up(matrices: FloatArray, entities: IntArray, first: IntArray) -> csc_matrix:
    """The sum of element matrices (m, n, n) whose rows and columns belong to entities (m, e), alike in all triangles.

    first: (entities + 1,), the first unknown of each entity.
    """
    count, sizes = len(first) - 1, np.diff(first)
    keys = (entities[:, None, :] * count + entities[:, :, None]).reshape(-1)  # [row, column], sorted by column
    blocks, block_of = np.unique(keys, return_inverse=True)
    block_of = block_of.reshape(len(entities), *[entities.shape[1]] * 2)
    local, within = numbered(entities, first)
    column, row = blocks // count, blocks % count
    height = np.bincount(column, sizes[row], minlength=count).astype(np.int64)  # of an entity's columns
    above = np.cumsum(sizes[row]) - sizes[row]
    above -= (np.cumsum(height) - height)[column]  # where a block starts in its columns
    start = np.concatenate([[0], np.cumsum(height * sizes)])
    length = np.repeat(height, sizes)
    pointers = np.concatenate([[0], np.cumsum(length)])
    data = np.zeros(start[-1])
    for begin in range(0, len(matrices), CHUNK):
        part = slice(begin, begin + CHUNK)
        base = above[block_of[part]] + start[entities[part]][:, None, :]
        place = base[:, local[:, None], local] + within[:, None]
        place += (height[entities[part]][:, local] * within)[:, None, :]
        data += np.bincount(place.reshape(-1), matrices[part].reshape(-1), minlength=len(data))
    return csc_matrix((data, _rows(row, column, sizes, first, height), pointers), shape=(first[-1], first[-1]))


def _rows(row: IntArray, column: IntArray, sizes: IntArray, first: IntArray, height: IntArray) -> IntArray:
    """The row of every stored number: all columns of an entity list the same rows."""
    lengths = sizes[row]
    ends = np.cumsum(lengths)
    listed = np.arange(ends[-1]) + np.repeat(first[row] - (ends - lengths), lengths)  # once for each column entity
    begin = np.cumsum(height) - height
    repeated = np.repeat(begin, sizes)  # once for each column
    spans = np.repeat(height, sizes)
    offsets = np.cumsum(spans) - spans
    return listed[np.arange(spans.sum()) + np.repeat(repeated - offsets, spans)]
