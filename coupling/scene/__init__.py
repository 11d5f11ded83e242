"""What a part moves over: a plate on actuators or a platform, as drives and a moving surface."""

from coupling.scene.plate import (
    PlateScene,
    actuator_stiffness,
    build_plate,
    damping_of,
    lifts_of,
    plate_scene,
    section_of,
    stretch_model,
    vibration_model,
)
from coupling.scene.platform import PlatformScene, platform_scene

Scene = PlateScene | PlatformScene
