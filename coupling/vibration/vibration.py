"""Vibration: a plate that has mass, under the drives of one run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from coupling.drives import fastest_acceleration, stroke_heights
from coupling.surface import ActuatedSurface, PressureShape, surface_motion
from coupling.vibration.choice import ChosenModes, Damping, choose_modes, motion_of
from coupling.vibration.motion import ModalMotion
from fem_plate import AnisotropicSection, Excitation, InfluenceShapes, MovingShapes, PlateSection
from particle import AnyDrive
from particle.drives import QuinticDrive

FloatArray = NDArray[np.float64]

PIECES = 3e-5  # of the largest acceleration of an actuator or a mode: what pieces in time may be off by
TALLEST = 1e4  # how much less exact the shapes of modes may be that hardly move


@dataclass(frozen=True, eq=False)
class VibrationModel:
    """The modes that a plate's actuators excite; good for drives like those that it was made for.

    damping: the ratios (n,) of natural frequencies (n,) [Hz].  steady: whether runs begin in the steady state.
    end: s, of the longest run.  pressed: the shape of a constant pressure, which excites no mode; None: there is none.
    """

    shapes: MovingShapes
    chosen: ChosenModes
    damping: Damping
    steady: bool
    end: float
    pressed: PressureShape | None = None

    @property
    def kept(self) -> tuple[QuinticDrive, ...]:
        """The drives of shapes that stay what they are."""
        return () if self.pressed is None else (self.pressed.drive,)

    def motion(self, drives: Sequence[AnyDrive]) -> ModalMotion:
        """How the modes move; raises ValueError when one without damping resonates."""
        return motion_of(self.chosen.modes, self.damping, drives, self.end, self.steady)

    def modal_drives(self, drives: Sequence[AnyDrive]) -> list[QuinticDrive]:
        """The drives of the modes; raises ValueError likewise, or where they take too many pieces."""
        own, motion = self.shapes.own_heights(), self.motion(drives)
        fastest = max(height * fastest_acceleration(drive) for height, drive in zip(own, drives, strict=False))
        return motion.modal_drives(PIECES * max(fastest, motion.largest_acceleration()))


@dataclass(frozen=True, eq=False)
class Vibration:
    """A plate that vibrates under N drives."""

    model: VibrationModel
    drives: Sequence[AnyDrive]
    modal_drives: Sequence[QuinticDrive]

    @staticmethod
    def under(model: VibrationModel, drives: Sequence[AnyDrive]) -> Vibration:
        """The plate under drives."""
        return Vibration(model, drives, model.modal_drives(drives))

    @property
    def shapes(self) -> MovingShapes:
        """Shapes of the actuators, then modes, then that of a pressure."""
        return self.model.shapes

    @property
    def moving_drives(self) -> list[AnyDrive]:
        """The drive of each of these."""
        return [*self.drives, *self.modal_drives, *self.model.kept]

    def surface(self, tolerance: float, half_thickness: float) -> ActuatedSurface:
        """The moving surface."""
        surface = surface_motion(self.shapes, self.moving_drives, tolerance, half_thickness)
        return ActuatedSurface.of(surface, kept=self.model.kept)


def make_vibration_model(
    shapes: InfluenceShapes,
    section: PlateSection | AnisotropicSection,
    damping: Damping,
    sets: Sequence[Sequence[AnyDrive]],
    end: float,
    steady: bool,
    tell: Callable[[int, int], None] = lambda done, of: None,
    pressure: float = 0.0,
) -> VibrationModel:
    """The model of a plate with mass for several sets of drives and a constant pressure [Pa], up to an end [s].

    Raises ValueError when a mode without damping resonates.
    """
    assert section.density is not None
    excitation = Excitation(shapes, section.density * section.thickness, section.rigidity)
    chosen = choose_modes(shapes, excitation, damping, sets, end, steady, tell)
    pressed = PressureShape.of(shapes, pressure) if pressure else None
    moving = _moving_shapes(shapes, chosen, damping, sets, end, steady, pressed)
    return VibrationModel(moving, chosen, damping, steady, end, pressed)


def _moving_shapes(
    shapes: InfluenceShapes,
    chosen: ChosenModes,
    damping: Damping,
    sets: Sequence[Sequence[AnyDrive]],
    end: float,
    steady: bool,
    pressed: PressureShape | None,
) -> MovingShapes:
    """The shapes of actuators and modes; those of modes that move less are fitted less closely."""
    times = np.linspace(0.0, end, 1001)
    own = shapes.own_heights()
    most = np.zeros(len(chosen.modes.omega))
    for drives in sets:
        rung = motion_of(chosen.modes, damping, drives, end, steady).evaluate(times)
        for order in (0, 2):
            carried = np.abs(stroke_heights(drives, times, order) * own).max()
            if carried > 0:
                most = np.maximum(most, np.abs(rung[order]).max(axis=0) / carried)
    scales = np.concatenate([own, 1 / np.clip(most, 1 / TALLEST, None)])
    modes = chosen.modes.functions
    held = np.flatnonzero(shapes.springs > 0)
    forces = np.zeros((len(shapes.points), len(most)))
    forces[held] = modes.forces
    further = replace(modes, sources=shapes.functions.sources, forces=forces)
    if pressed is not None:
        further, scales = further.beside(pressed.functions), np.append(scales, 1.0)
    return MovingShapes.beside(shapes, further, scales)
