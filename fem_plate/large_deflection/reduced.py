"""ReducedPlate: the energy of a plate that stretches, in the actuators' strokes and a few correction shapes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fem_plate.types import FloatArray

ASYMMETRY = 1e-10  # of a matrix' largest entry: more is a mistake, not rounding


class Forms(NamedTuple):
    """The model as kernels read it: S = R + M quadratic forms C, those of the membrane first."""

    stiffness: FloatArray  # (n, n)
    load: FloatArray  # (n,)
    constant: FloatArray  # (S,)
    drives: FloatArray  # (S, N, N), the forms of the drives
    mixed: FloatArray  # (S, N, n), of drives and corrections
    corrections: FloatArray  # (n, S * n), C_cc of all forms side by side
    flat: FloatArray  # (S, n * n), the same, one form after the other
    membranes: int  # R


@dataclass(frozen=True, eq=False, repr=False)
class ReducedPlate:
    """A von Karman plate in N drives d (strokes or forces) and n corrections c, b = (d, c).

    Its energy, except for what depends on d alone, and the in-plane motions that follow are

        E(c; d) = 1/2 c'K c + p'c + 1/2 sum_r f_r^2,   f_r = 1/2 b'A_r b + a_r,   r < R
        g_m = 1/2 b'B_m b + e_m,                                                  m < M

    The corrections are orthogonal to the linear shapes in the energy of bending, so d and c meet in A alone. A stress
    function in R terms, each of unit membrane energy, leads to this form.

    Units are free if they agree: with c in m, K in N/m and p in N, A is in N^(1/2) m^(-3/2), and a in (N m)^(1/2).

    Parameters
    ----------
    stiffness : array (n, n)
        K, symmetric and positive definite.
    membrane : array (R, N+n, N+n)
        A, symmetric in the last two.
    prestress : array (R,), optional
        a; 0 by default.
    load : array (n,), optional
        p, minus the work of a pressure on the corrections; 0 by default.
    in_plane : array (M, N+n, N+n), optional
        B, symmetric in the last two; none by default.
    in_plane_offset : array (M,), optional
        e; 0 by default.

    Raises
    ------
    ValueError
        An array is wrong; names each.
    """

    stiffness: FloatArray
    membrane: FloatArray
    prestress: FloatArray = None  # type: ignore[assignment]  # an array as soon as it is made
    load: FloatArray = None  # type: ignore[assignment]  # an array as soon as it is made
    in_plane: FloatArray = None  # type: ignore[assignment]  # an array as soon as it is made
    in_plane_offset: FloatArray = None  # type: ignore[assignment]  # an array as soon as it is made
    drive_count: int = field(init=False)  # N

    def __post_init__(self) -> None:
        stiffness, membrane = _array(self.stiffness), _array(self.membrane)
        n, size = len(stiffness) if stiffness.ndim else 0, membrane.shape[-1] if membrane.ndim else 0
        in_plane = np.zeros((0, size, size)) if self.in_plane is None else _array(self.in_plane)
        arrays = {
            "stiffness": (stiffness, (n, n)),
            "membrane": (membrane, (len(membrane) if membrane.ndim else 0, size, size)),
            "prestress": (_row(self.prestress, len(membrane) if membrane.ndim else 0), membrane.shape[:1]),
            "load": (_row(self.load, n), (n,)),
            "in_plane": (in_plane, (len(in_plane) if in_plane.ndim else 0, size, size)),
            "in_plane_offset": (_row(self.in_plane_offset, len(in_plane) if in_plane.ndim else 0), in_plane.shape[:1]),
        }
        wrong = [fault for name, (array, shape) in arrays.items() if (fault := _fault(name, array, shape))]
        if not wrong and (n == 0 or size <= n):
            wrong.append(
                f"Input membrane of ReducedPlate must be over one drive or more, and {n} corrections; got {size}"
            )
        if not wrong and not _positive_definite(stiffness):
            wrong.append("Input stiffness of ReducedPlate must be positive definite; got a matrix that is not")
        if wrong:
            raise ValueError("; ".join(wrong))
        for name, (array, _) in arrays.items():
            object.__setattr__(self, name, array)
        object.__setattr__(self, "drive_count", size - n)

    def __repr__(self) -> str:
        n, forms = len(self.stiffness), (len(self.membrane), len(self.forms.constant) - len(self.membrane))
        return f"<ReducedPlate: drives {self.drive_count}, corrections {n}, membrane {forms[0]}, in-plane {forms[1]}>"

    @cached_property
    def forms(self) -> Forms:
        """The model for kernels."""
        count, both = self.drive_count, np.concatenate([self.membrane, self.in_plane])
        own = both[:, count:, count:]
        return Forms(
            stiffness=self.stiffness,
            load=self.load,
            constant=np.concatenate([self.prestress, self.in_plane_offset]),
            drives=np.ascontiguousarray(both[:, :count, :count]),
            mixed=np.ascontiguousarray(both[:, :count, count:]),
            corrections=own.transpose(1, 0, 2).reshape(len(self.load), -1),
            flat=own.reshape(len(both), -1),
            membranes=len(self.membrane),
        )

    def forms_of(self, groups: Sequence[int]) -> Forms:
        """The same where actuators move alike; groups (N,): which of the drives 0, 1, ... each has."""
        forms, index = self.forms, np.asarray(groups)
        if np.array_equal(index, np.arange(self.drive_count)):
            return forms
        order = np.argsort(index, kind="stable")
        first = np.flatnonzero(np.diff(index[order], prepend=-1))
        rows = np.add.reduceat(forms.drives[:, order], first, axis=1)
        return forms._replace(
            drives=np.add.reduceat(rows[:, :, order], first, axis=2),
            mixed=np.add.reduceat(forms.mixed[:, order], first, axis=1),
        )


def _array(values: ArrayLike) -> FloatArray:
    """A copy that cannot be changed."""
    array = np.array(values, dtype=float, order="C")
    array.setflags(write=False)
    return array


def _row(values: ArrayLike | None, count: int) -> FloatArray:
    return _array(np.zeros(count) if values is None else values)


def _fault(name: str, array: FloatArray, shape: tuple[int, ...]) -> str | None:
    """What is wrong with an array, whose last two axes are symmetric if there are two."""
    must = f"Input {name} of ReducedPlate must"
    if array.shape != shape:
        return f"{must} have the shape {shape}; got {array.shape}"
    if not np.isfinite(array).all():
        return f"{must} be finite; got {array[~np.isfinite(array)][0]}"
    if array.ndim > 1:
        off = np.abs(array - array.swapaxes(-1, -2)).max(initial=0.0)
        if off > ASYMMETRY * np.abs(array).max(initial=0.0):
            return f"{must} be symmetric; got entries that differ by {off:.1e} from those across the diagonal"
    return None


def _positive_definite(matrix: FloatArray) -> bool:
    try:
        np.linalg.cholesky(matrix)
    except np.linalg.LinAlgError:
        return False
    return True
