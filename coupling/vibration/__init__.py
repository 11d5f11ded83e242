"""A plate that has mass: the modes that its actuators excite, and how they ring over time."""

from coupling.vibration.choice import ChosenModes, Damping, choose_modes, motion_of
from coupling.vibration.motion import ModalMotion, modal_motion
from coupling.vibration.oscillators import Oscillators, enter_jump
from coupling.vibration.steady import always_running
from coupling.vibration.vibration import PIECES, Vibration, VibrationModel, make_vibration_model
