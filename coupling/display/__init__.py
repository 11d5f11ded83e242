"""The surface as result files and pictures hold it: a triangle mesh with its deflections and curvatures."""

from coupling.display.frames import frame_times
from coupling.display.mesh import display_mesh
from coupling.display.surface import (
    DisplaySurface,
    display_surface,
    most_deflected,
    moving_heights,
    onto_plate,
    onto_surface,
)
