"""FrequencyResponse: how far points of the plate of a case follow its actuators, over frequency."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike

from active_surface.arrays import FloatArray
from active_surface.studies.response.functions import STILL, ComplexArray, frequency_response, range_fault
from common import draw, quantity_text, range_text
from coupling import Progress, one_blas_thread, silent, whole_file
from coupling.case import SAME_PLACE, Case, PlateCase
from coupling.scene import actuator_stiffness, build_plate, damping_of
from fem_plate import MAX_MODES, Excitation, InfluenceShapes
from meshes import Outline
from particle import interruptible

if TYPE_CHECKING:
    import xarray


COUNT: Final = 400  # frequencies, besides those around resonances
SPAN: Final = 0.05, 5.0  # of the first resonance
DEFAULTS: Final = "1/20 of the first resonance", "five times the first resonance"
AROUND: Final = np.concatenate([-np.geomspace(20, 0.05, 24), [0.0], np.geomspace(0.05, 20, 24)])  # damping ratios
NARROWEST: Final = 1e-4  # a damping ratio, for frequencies around a resonance
MARKED: Final = 1e-3  # of the largest peak of a mode: lower ones are not marked
MAX_ACTUATORS: Final = MAX_MODES // 2  # so that there are two blocks of responses to compare


@dataclass(frozen=True, eq=False)
class FrequencyResponse:
    """How far k points of a plate follow N actuators, over F frequencies."""

    case: Case
    points: FloatArray  # (k, 2) m
    frequencies: FloatArray  # (F,) Hz
    values: ComplexArray  # (k, N, F) m/m, of actuators that push with a force m/N
    resonances: FloatArray  # Hz, of the modes that answer, within the frequencies
    dampings: FloatArray  # the ratio of each
    error: float  # the largest change of a curve (point, actuator) by the last modes, over its largest
    outline: Outline
    actuators: FloatArray  # (N, 2) m

    def dataset(self) -> xarray.Dataset:
        """All of it with labels: complex `response`, its `amplitude` and its `phase` [deg], and `resonance` [Hz]."""
        import xarray

        dims = ("point", "actuator", "frequency")
        pushed = [actuator.force is not None for actuator in self.case.actuators]
        units = {"units": "m/N" if all(pushed) else "m/m, of forces m/N" if any(pushed) else "m/m"}
        return xarray.Dataset(
            {
                "response": (dims, self.values, units),
                "amplitude": (dims, np.abs(self.values), units),
                "phase": (dims, np.degrees(np.angle(self.values)), {"units": "deg", "long_name": "ahead of the drive"}),
                "damping": ("resonance", self.dampings, {"units": "1", "long_name": "damping ratio"}),
            },
            {
                "frequency": ("frequency", self.frequencies, {"units": "Hz"}),
                "resonance": ("resonance", self.resonances, {"units": "Hz"}),
                "x": ("point", self.points[:, 0], {"units": "m"}),
                "y": ("point", self.points[:, 1], {"units": "m"}),
                "actuator_x": ("actuator", self.actuators[:, 0], {"units": "m"}),
                "actuator_y": ("actuator", self.actuators[:, 1], {"units": "m"}),
            },
            {"case": self.case.source or "", "error": self.error},
        )

    def figures(self) -> dict[str, Any]:
        """The figures by name, in SI units."""
        amplitude = np.abs(self.values)
        point, actuator, at = np.unravel_index(int(np.argmax(amplitude)), amplitude.shape)
        return {
            "points": self.points.tolist(),
            "frequencies": self.frequencies[[0, -1]].tolist(),
            "resonances": self.resonances.tolist(),
            "dampings": self.dampings.tolist(),
            "largest_amplitude": float(amplitude[point, actuator, at]),
            "largest_at": {
                "point": self.points[point].tolist(),
                "actuator": int(actuator),
                "frequency": float(self.frequencies[at]),
            },
            "error": self.error,
        }

    def lines(self) -> list[tuple[str, str]]:
        """Rows (label, text) to print."""
        figures = self.figures()
        at = figures["largest_at"]
        x, y = (1e6 * c for c in at["point"])
        low, high = figures["frequencies"]
        rows = [
            ("frequency", f"{range_text(low, high, 'Hz', 4)}, {len(self.frequencies)} of them"),
            (
                "largest",
                f"{figures['largest_amplitude']:.4g} at ({x:.4g}, {y:.4g}) um, from actuator {at['actuator']} at "
                f"{quantity_text(at['frequency'], 'Hz', 4)}",
            ),
            ("accuracy", f"more modes change it by {self.error:.1e} of the largest"),
        ]
        for frequency, ratio in zip(self.resonances, self.dampings, strict=True):
            rows.append(("resonance", f"{quantity_text(frequency, 'Hz', 6)}, damping ratio {ratio:g}"))
        return rows

    def write(self, folder: Path) -> tuple[Path, ...]:
        """Writes NAME.response.nc, without the complex values, and NAME.response.png into a folder; returns them."""
        from coupling.pictures import save_picture  # here, because it loads matplotlib

        folder.mkdir(parents=True, exist_ok=True)
        data = folder / f"{self.case.name}.response.nc"
        with whole_file(data) as partial:
            partial.write_bytes(self.dataset().drop_vars("response").to_netcdf(engine="h5netcdf"))
        return data, save_picture(draw(self), folder / f"{self.case.name}.response.png")


def response(
    case: Case,
    points: ArrayLike | None = None,
    frequencies: ArrayLike | Sequence[float] | None = None,
    lowest: float | None = None,
    highest: float | None = None,
    progress: Progress = silent,
) -> FrequencyResponse:
    """The frequency responses of a case's plate, with its tension and damping, whatever its drives are.

    Parameters
    ----------
    case : Case
        A plate on actuators, with a density. The plate may be free to move as a whole (`read_case` with `may_move`).
    points : (k, 2) array_like, optional
        Points of the plate [m]; by default where the part starts.
    frequencies : (F,) array_like, optional
        [Hz]; by default from lowest to highest, closer at resonances.
    lowest, highest : float, optional
        [Hz]; by default 1/20 and five times the first resonance.
    progress : Progress, optional
        Reports the progress of a stage.

    Returns
    -------
    response : FrequencyResponse
        Amplitudes and phases, with `dataset()` as an xarray.Dataset.

    Raises
    ------
    ValueError
        The case has a platform, more than 200 actuators, or a plate that has no density or stretches; a force pushes a
        plate that is free to move as a whole; a point lies beyond the rim; or frequencies make no sense.
    """
    plate_case = _checked(case)
    given = None if frequencies is None else np.atleast_1d(np.asarray(frequencies, dtype=float))
    if given is not None and (given.ndim != 1 or not len(given) or not (np.isfinite(given) & (given > 0)).all()):
        raise ValueError(f"Input frequencies of response must be positive, in Hz; got {frequencies!r}")
    if given is not None and not (lowest is None and highest is None):
        raise ValueError("Input lowest and highest of response must not be given with frequencies")
    xy = np.atleast_2d(np.asarray([case.part.position] if points is None else points, dtype=float))
    if xy.ndim != 2 or xy.shape[1] != 2:
        raise ValueError(f"Input points of response must have shape (k, 2); got {xy.shape}")
    with one_blas_thread():
        return interruptible(_found, case, plate_case, xy, given, lowest, highest, progress)


def _checked(case: Case) -> PlateCase:
    if not isinstance(case.plate, PlateCase):
        raise ValueError("Input case of response must have a plate on actuators; got a platform")
    wrong = []
    if case.plate.density is None:
        wrong.append("plate.density of response must be given; got none")
    if case.plate.theory != "linear":
        wrong.append(f'plate.theory of response must be "linear"; got "{case.plate.theory}"')
    if len(case.actuators) > MAX_ACTUATORS:
        wrong.append(f"actuators of response must be at most {MAX_ACTUATORS}; got {len(case.actuators)}")
    if wrong:
        raise ValueError("; ".join(f"Input {text}" for text in wrong))
    return case.plate


def _check_points(xy: FloatArray, shapes: InfluenceShapes) -> None:
    beyond = shapes.outline.gap(xy) < -SAME_PLACE * shapes.size
    if beyond.any():
        places = ", ".join(f"({x * 1e6:g}, {y * 1e6:g}) um" for x, y in xy[beyond])
        raise ValueError(f"Input points of response must lie on the plate; got {places}")


def _found(
    case: Case,
    plate_case: PlateCase,
    xy: FloatArray,
    given: FloatArray | None,
    lowest: float | None,
    highest: float | None,
    progress: Progress,
) -> FrequencyResponse:
    damping = damping_of(plate_case)
    with progress("Solving the plate") as tell:
        plate = build_plate(plate_case)
        places = [actuator.position for actuator in case.actuators]
        shapes = plate.influence(places, actuator_stiffness(case), tell=tell, free_motions=True)
        assert isinstance(shapes, InfluenceShapes)
        _check_points(xy, shapes)
    with progress("Finding the modes"):
        section = plate.section
        assert section.density is not None
        excitation = Excitation(shapes, section.density * section.thickness, section.rigidity)
        for _ in range(2):
            excitation.grow()
        first = float(excitation.modes().frequencies[0])
        low = SPAN[0] * first if lowest is None else lowest
        high = SPAN[1] * first if highest is None else highest
        if given is None and (fault := range_fault("response", lowest, highest, low, high, DEFAULTS)):
            raise ValueError(fault)
        chosen = given if given is not None else np.geomspace(low, high, COUNT)
        values, modes, error = frequency_response(shapes, excitation, damping, xy, chosen)
        ratios = damping(modes.frequencies)
        peaks = np.abs(modes.functions.values(xy / shapes.size)).max(axis=0) * np.abs(modes.participation).max(axis=1)
        within = (modes.frequencies >= chosen.min()) & (modes.frequencies <= chosen.max())
        marked = within & (peaks > max(MARKED * peaks.max(), STILL * shapes.own_heights().max()))
        found = FrequencyResponse(
            case, xy, chosen, values, modes.frequencies[marked], ratios[marked], error, shapes.outline, shapes.points
        )
        if given is not None:
            return found
        near = found.resonances[:, None] * (1 + np.maximum(found.dampings, NARROWEST)[:, None] * AROUND)
        near = near[(AROUND != 0) | (found.dampings[:, None] > 0)]  # without damping it has no bound
        finer = np.unique(np.concatenate([chosen, near[(near > low) & (near < high)]]))
        values, _, error = frequency_response(shapes, excitation, damping, xy, finer)
        return replace(found, frequencies=finer, values=values, error=max(error, found.error) if error < 1 else error)
