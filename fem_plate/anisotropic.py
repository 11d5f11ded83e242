"""A plate whose stiffness depends on direction: wood, printed circuit boards, crystals."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_plate.inputs import not_positive
from fem_plate.types import FloatArray

# The primary flat of a wafer, x, and its normal, z, in the crystal's axes.
WAFERS = {"100": ((1, 1, 0), (0, 0, 1)), "110": ((1, -1, 0), (1, 1, 0)), "111": ((1, -1, 0), (1, 1, 1))}
MEAN = np.array([3, 0, 1, 0, 1, 0, 1, 0, 3]).reshape(3, 3) / 8  # of a law: l_00 averaged over directions
PLANE = ([0, 1, 5], [0, 1, 5])  # xx, yy and xy of a compliance (6, 6) in Voigt's order


@dataclass(frozen=True)
class AnisotropicSection:
    """A homogeneous plate of constant thickness whose stiffness depends on direction.

    Parameters
    ----------
    stiffness : (3, 3) array_like
        Of plane stress, Q: stresses (xx, yy, xy) are Q times strains (xx, yy, 2 xy) [Pa]. Symmetric, positive definite.
    thickness : float
        Thickness [m].
    density : float, optional
        Mass per volume [kg/m^3]; only frequencies need it.

    Raises
    ------
    ValueError
        Names every field that is out of range.
    """

    stiffness: tuple[tuple[float, ...], ...]  # Pa
    thickness: float  # m
    density: float | None = None  # kg/m^3; only frequencies need it

    def __post_init__(self) -> None:
        mistakes = not_positive("AnisotropicSection", thickness=self.thickness, density=self.density)
        own = np.asarray(self.stiffness, dtype=float)
        if own.shape != (3, 3) or not np.isfinite(own).all() or np.abs(own - own.T).max() > 1e-9 * np.abs(own).max():
            mistakes.append(f"Input stiffness of AnisotropicSection must be a symmetric (3, 3) matrix; got {own}")
        elif np.linalg.eigvalsh(own)[0] <= 0:
            mistakes.append(f"Input stiffness of AnisotropicSection must be positive definite; got {own}")
        if mistakes:
            raise ValueError("; ".join(mistakes))
        object.__setattr__(self, "stiffness", tuple(map(tuple, ((own + own.T) / 2).tolist())))

    @staticmethod
    def orthotropic(
        youngs_moduli: tuple[float, float],
        poisson_ratio: float,
        shear_modulus: float,
        thickness: float,
        density: float | None = None,
        angle: float = 0.0,
    ) -> AnisotropicSection:
        """A plate with two directions of its own, as wood along and across its grain or a printed circuit board.

        Parameters
        ----------
        youngs_moduli : (float, float)
            Along the first direction and across it [Pa].
        poisson_ratio : float
            The contraction across the first direction over the strain along it, in a pull along it.
        shear_modulus : float
            In the plate's plane [Pa].
        thickness, density
            As for `AnisotropicSection`.
        angle : float
            From x to the first direction, counter-clockwise [rad].

        Raises
        ------
        ValueError
            Names every modulus that is not positive; or Poisson's ratio is beyond what these moduli allow.
        """
        first, second = youngs_moduli
        moduli = {"youngs_moduli[0]": first, "youngs_moduli[1]": second, "shear_modulus": shear_modulus}
        mistakes = not_positive("AnisotropicSection.orthotropic", **moduli)
        if not mistakes and not poisson_ratio**2 < first / second:
            limit = math.sqrt(first / second)
            name = "Input poisson_ratio of AnisotropicSection.orthotropic"
            mistakes = [f"{name} must be between -{limit:.4g} and {limit:.4g} for these moduli; got {poisson_ratio!r}"]
        if mistakes:
            raise ValueError("; ".join(mistakes))
        coupling = -poisson_ratio / first
        compliance = np.array([[1 / first, coupling, 0], [coupling, 1 / second, 0], [0, 0, 1 / shear_modulus]])
        return AnisotropicSection(_turned(np.linalg.inv(compliance), angle), thickness, density)

    @staticmethod
    def cubic(
        elastic_constants: tuple[float, float, float],
        thickness: float,
        density: float | None = None,
        wafer: str = "100",
        angle: float = 0.0,
    ) -> AnisotropicSection:
        """A plate cut from a cubic crystal, such as a silicon wafer.

        Parameters
        ----------
        elastic_constants : (float, float, float)
            c11, c12 and c44 [Pa]; of silicon 165.7e9, 63.9e9 and 79.6e9 (Hopcroft, Nix and Kenny, 2010).
        thickness, density
            As for `AnisotropicSection`.
        wafer : str
            The plane of the cut, "100", "110" or "111".
        angle : float
            From x to a direction <110> in that plane, as the primary flat of a (100) wafer has it [rad].

        Raises
        ------
        ValueError
            The wafer is unknown, or the constants are of no stable crystal.
        """
        if wafer not in WAFERS:
            name = "Input wafer of AnisotropicSection.cubic"
            raise ValueError(f"{name} must be one of {', '.join(map(repr, WAFERS))}; got {wafer!r}")
        c11, c12, c44 = elastic_constants
        if not (c44 > 0 and c11 > abs(c12) and c11 + 2 * c12 > 0):
            name = "Input elastic_constants of AnisotropicSection.cubic"
            raise ValueError(f"{name} must have c44 > 0, c11 > |c12| and c11 + 2 c12 > 0; got {elastic_constants!r}")
        x, z = (np.array(direction) / np.linalg.norm(direction) for direction in WAFERS[wafer])
        compliance = np.linalg.inv(_voigt(_cubic_tensor(c11, c12, c44, np.stack([x, np.cross(z, x), z]))))
        in_plane = compliance[np.ix_(*PLANE)]  # the stresses out of the plane are 0
        return AnisotropicSection(_turned(np.linalg.inv(in_plane), angle), thickness, density)

    def mirrored(self, line: tuple[float, float]) -> AnisotropicSection:
        """The plate seen in a mirror along a line, given by its direction."""
        twice = 2 * math.atan2(line[1], line[0])
        flip = np.diag([1.0, 1.0, -1.0])  # of strains, in a mirror along x
        turned = np.array(_turned(flip @ np.array(self.stiffness) @ flip, twice))
        return AnisotropicSection(tuple(map(tuple, turned.tolist())), self.thickness, self.density)

    @property
    def membrane_stiffness(self) -> FloatArray:
        """Forces per length (xx, yy, xy) from strains (xx, yy, 2 xy) of the mid-plane, (3, 3) [N/m]."""
        return np.array(self.stiffness) * self.thickness

    @property
    def rigidity(self) -> float:
        """Flexural rigidity of narrow waves, the mean over all directions of the plane [N m]."""
        return float((self._bending * MEAN).sum())

    @cached_property
    def _bending(self) -> FloatArray:
        """The matrix (3, 3) of M(v):H(q) [N m], in the second derivatives (xx, xy, yy)."""
        order, twice = [0, 2, 1], np.array([1, 2, 1])
        return np.array(self.stiffness)[np.ix_(order, order)] * np.outer(twice, twice) * self.thickness**3 / 12

    @property
    def law(self) -> FloatArray:
        """The matrix (3, 3) of M(v):H(q) over the rigidity, in the second derivatives (xx, xy, yy)."""
        return self._bending / self.rigidity

    @property
    def poisson_ratio(self) -> float:
        """Poisson's ratio of the isotropic part of the stiffness."""
        own = self.law
        return float((own[0, 0] + own[2, 2] + 6 * own[0, 2] - own[1, 1]) / 8)


def _turned(stiffness: FloatArray, angle: float) -> tuple[tuple[float, ...], ...]:
    """A stiffness (3, 3) of plane stress in axes turned back by an angle [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    # Strains (xx, yy, 2 xy) along the material's axes from those along x and y.
    to_own = np.array([[c**2, s**2, c * s], [s**2, c**2, -c * s], [-2 * c * s, 2 * c * s, c**2 - s**2]])
    return tuple(map(tuple, (to_own.T @ stiffness @ to_own).tolist()))


def _cubic_tensor(c11: float, c12: float, c44: float, axes: FloatArray) -> FloatArray:
    """The stiffness (3, 3, 3, 3) of a cubic crystal in axes (3, 3), rows in the crystal's own."""
    own = np.eye(3)
    pairs = np.einsum("ij,kl->ijkl", own, own)
    swapped = np.einsum("ik,jl->ijkl", own, own) + np.einsum("il,jk->ijkl", own, own)
    cubes = np.einsum("ia,ja,ka,la->ijkl", own, own, own, own)
    tensor = c12 * pairs + c44 * swapped + (c11 - c12 - 2 * c44) * cubes
    return np.einsum("pi,qj,rk,sl,ijkl->pqrs", axes, axes, axes, axes, tensor)


def _voigt(tensor: FloatArray) -> FloatArray:
    """A stiffness (3, 3, 3, 3) as a matrix (6, 6) in the order xx, yy, zz, yz, xz, xy."""
    first, second = np.array([[0, 0], [1, 1], [2, 2], [1, 2], [0, 2], [0, 1]]).T
    return tensor[first[:, None], second[:, None], first, second]
