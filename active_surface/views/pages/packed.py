"""Arrays of numbers as text that a page unpacks: base64 of little-endian numbers."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

INT16 = 32767


def packed(values: ArrayLike, kind: str) -> dict[str, str]:
    """Numbers as `kind`, such as f4, f8, u1, u2, i2, u4: their rows follow each other."""
    data = np.ascontiguousarray(values, dtype=f"<{kind}")
    return {"kind": kind, "bytes": base64.b64encode(data.tobytes()).decode()}


def packed_rows(values: ArrayLike, exact: bool = False) -> dict[str, Any]:
    """Rows (r, n) as 16-bit integers with a scale each, good to 1.6e-5 of a row's largest number.

    exact: as 32-bit numbers, in which small ones are as good as large ones.
    """
    rows = np.asarray(values, dtype=np.float64)
    if exact:
        return {"rows": packed(rows, "f4"), "scales": [1.0] * len(rows)}
    scales = np.abs(rows).max(axis=1, initial=0.0) / INT16
    integers = np.rint(rows / np.where(scales > 0, scales, 1.0)[:, None])
    return {"rows": packed(integers, "i2"), "scales": scales.tolist()}
