from .actuated import ActuatedSurface as ActuatedSurface, Pressed as Pressed, PressureShape as PressureShape
from .file import check_surface as check_surface, is_surface as is_surface, write_surface as write_surface
from .motion import FLOOR as FLOOR, surface_motion as surface_motion
