"""Excitation: the modes that actuators excite, of a plate that they hold still.

Under strokes h the plate is w = sum_i h_i phi_i + sum_n eta_n psi_n, where phi_i are the influence shapes and psi_n the
modes with the actuators held. Each mode obeys

    eta_n'' + 2 zeta omega_n eta_n' + omega_n^2 eta_n = -sum_i m_ni h_i'',  m_ni = (phi_i, psi_n) / (psi_n, psi_n).

Modes that have no share in the influence shapes never move. So the modes are sought among the plate's own responses:
the static response to the inertia of the shapes, then to the inertia of that response, and so on (Wilson, Yuan and
Dickens, 1982). The lowest modes converge first; those left at the end stand for all the others.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.linalg import eigh

from fem_plate.elements import PlateFunctions, PlateModel
from fem_plate.types import BoolArray, FloatArray
from fem_plate.vibration import HeldPlate

MAX_MODES = 400  # so many responses are enough
ROUNDING = 1e-10  # of a response: less of it that is new counts as nothing
ASYMMETRY = 1e-6  # of a stiffness: what rounding may leave
DEPENDENT = 1e-13  # of the longest of a block, squared


class WithModel(Protocol):
    """The influence shapes of N actuators, and the plate's model on whose cells they are."""

    model: PlateModel
    functions: PlateFunctions
    points: FloatArray  # (N, 2) m
    springs: FloatArray  # (N,) N/m
    size: float  # m


@dataclass(frozen=True, eq=False)
class ExcitedModes:
    """Modes that N actuators excite, each 1 at most over the mesh's points."""

    omega: FloatArray  # (n,) rad/s, ascending
    functions: PlateFunctions  # n
    participation: FloatArray  # (n, N), m_ni

    @property
    def frequencies(self) -> FloatArray:
        """Natural frequencies (n,) [Hz]."""
        return self.omega / (2 * np.pi)

    def chosen(self, rows: BoolArray) -> ExcitedModes:
        """Some of the modes (n,)."""
        functions = self.functions.weighted(np.eye(len(rows))[:, rows])
        return ExcitedModes(self.omega[rows], functions, self.participation[rows])


class Excitation:
    """The plate's responses to the inertia of its influence shapes, in blocks of N at most.

    shapes: of the actuators.  inertia: kg/m^2, mass per area.  rigidity: N m.
    """

    def __init__(self, shapes: WithModel, inertia: float, rigidity: float) -> None:
        size, held = shapes.size, shapes.springs > 0
        self._unit = rigidity / (inertia * size**4)  # rad^2/s^2
        self._plate = HeldPlate(shapes.model, shapes.points[held], rigidity / size**2 / shapes.springs[held])
        self._load = self._plate.inertia_of(shapes.functions)  # (phi_i, q)
        none = np.zeros((len(self._load), 0))
        self._basis, self._stiff, self._heavy = none, none, none  # V, K V and M V, V orthonormal in M
        self.blocks = [0]  # how many responses there are after each block
        self.grow()

    @property
    def exhausted(self) -> bool:
        """Whether the last block brought nothing new, or there are as many responses as are ever taken."""
        return self.blocks[-1] >= MAX_MODES or (len(self.blocks) > 1 and self.blocks[-1] == self.blocks[-2])

    def grow(self) -> None:
        """Add a block: the responses to the inertia of the last one."""
        load = self._load if len(self.blocks) == 1 else self._heavy[:, self.blocks[-2] :]
        response, stiff = self._plate.solve(load), load
        scale = np.sqrt(np.einsum("uk,uk->k", response, self._plate.with_mass(response)))
        response, stiff = response / scale, stiff / scale
        for _ in range(2):  # once leaves rounding behind
            shares = self._heavy.T @ response
            response, stiff = response - self._basis @ shares, stiff - self._stiff @ shares
        heavy = self._plate.with_mass(response)
        combine = _orthonormalising(response.T @ heavy)
        basis = np.concatenate([self._basis, response @ combine], axis=1)
        stiffness = np.concatenate([self._stiff, stiff @ combine], axis=1)
        if _is_symmetric(basis.T @ stiffness):
            self._basis, self._stiff = basis, stiffness
            self._heavy = np.concatenate([self._heavy, heavy @ combine], axis=1)
        self.blocks.append(self._basis.shape[1])

    def modes(self, blocks: int | None = None) -> ExcitedModes:
        """The modes among the responses of all blocks, or of the first few."""
        count = self.blocks[-1 if blocks is None else blocks]
        basis, heavy, stiff = (part[:, :count] for part in (self._basis, self._heavy, self._stiff))
        stiffness, mass = basis.T @ stiff, basis.T @ heavy
        squares, turned = eigh((stiffness + stiffness.T) / 2, (mass + mass.T) / 2)
        vectors = basis @ turned
        functions, largest = self._plate.functions(vectors)
        participation = largest[:, None] * (vectors.T @ self._load)
        return ExcitedModes(np.sqrt(squares * self._unit), functions, participation)


def _is_symmetric(stiffness: FloatArray) -> bool:
    """Whether rounding, which grows from block to block, leaves a matrix (k, k) symmetric and positive."""
    own = np.diag(stiffness)
    if not (own > 0).all():
        return False
    return bool((np.abs(stiffness - stiffness.T) <= ASYMMETRY * np.sqrt(own * own[:, None])).all())


def _orthonormalising(gram: FloatArray) -> FloatArray:
    """The combinations (k, l) of k vectors that are orthonormal, without what is rounding of vectors of length 1."""
    squares, turned = np.linalg.eigh((gram + gram.T) / 2)
    kept = squares > max(ROUNDING**2, DEPENDENT * squares[-1])
    return np.asarray(turned[:, kept] / np.sqrt(squares[kept]))
