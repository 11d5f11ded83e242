"""The infinite plate with the law of bending at each force: what is known of a plate whose law varies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from fem_plate.elements import AnisotropicPlate, InfinitePlate, Radial, is_isotropic
from fem_plate.types import FloatArray


@dataclass(frozen=True, eq=False)
class LocalPlate(InfinitePlate):
    """Infinite plates, each with the law at its force. They do not know what else the plate's energy has.

    laws: of bending (n, 3, 3) at places (n, 2).
    """

    laws: Callable[[FloatArray], FloatArray]
    known: dict[bytes, list[tuple[InfinitePlate, float, FloatArray]]] = field(default_factory=dict)  # by sources

    def point_load(self, xy: FloatArray, sources: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        n = len(xy)
        value, gradient, hessian = (
            np.zeros((n, len(sources))),
            np.zeros((n, len(sources), 2)),
            np.zeros((n, len(sources), 2, 2)),
        )
        for k, (plate, factor, source) in enumerate(self._plates(sources)):
            for result, part in zip((value, gradient, hessian), plate.point_load(xy, source[None]), strict=True):
                result[:, k] = factor * part[:, 0]
        return value, gradient, hessian

    def point_value(self, xy: FloatArray, sources: FloatArray) -> FloatArray:
        value = np.zeros((len(xy), len(sources)))
        for k, (plate, factor, source) in enumerate(self._plates(sources)):
            value[:, k] = factor * plate.point_value(xy, source[None])[:, 0]
        return value

    def point_laplacian(self, xy: FloatArray, sources: FloatArray, floor: float) -> FloatArray:
        laplacian = np.zeros((len(xy), len(sources)))
        for k, (plate, factor, source) in enumerate(self._plates(sources)):
            laplacian[:, k] = factor * plate.point_laplacian(xy, source[None], floor)[:, 0]
        return laplacian

    def point_derivatives(self, xy: FloatArray, source: FloatArray) -> list[FloatArray]:
        ((plate, factor, _),) = self._plates(source[None])
        return [factor * order for order in plate.point_derivatives(xy, source)]

    def radial(self, xy: FloatArray, source: FloatArray) -> Radial:
        ((plate, factor, _),) = self._plates(source[None])
        own = plate.radial(xy, source)
        return Radial(factor * own.value, factor * own.square)

    def logarithms(self, sources: FloatArray) -> FloatArray:
        parts = [factor * plate.logarithms(source[None])[0] for plate, factor, source in self._plates(sources)]
        return np.array(parts)

    def pressure_derivatives(self, xy: FloatArray) -> list[FloatArray]:
        """0: elements follow all of a pressure's deflection."""
        return [np.zeros((order + 1, *xy.shape[:-1])) for order in range(4)]

    def _plates(self, sources: FloatArray) -> list[tuple[InfinitePlate, float, FloatArray]]:
        """For each source the plate, what its response is multiplied by, and the source."""
        key = sources.tobytes()
        if key not in self.known:
            laws = self.laws(sources) if len(sources) else np.empty((0, 3, 3))
            rigidities = laws[:, 0, 0].tolist()
            self.known[key] = [
                (InfinitePlate(), 1 / rigidity, source)
                if is_isotropic(law / rigidity)
                else (AnisotropicPlate(law), 1.0, source)
                for law, rigidity, source in zip(laws, rigidities, sources, strict=True)
            ]
        return self.known[key]
