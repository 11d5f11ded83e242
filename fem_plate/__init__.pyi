from . import analytic as analytic
from .anisotropic import AnisotropicSection as AnisotropicSection
from .arrays.patched import PatchedShapes as PatchedShapes, PlateShapes as PlateShapes
from .deflection import Deflection as Deflection
from .export import neighbour_coupling as neighbour_coupling, save_influence as save_influence
from .large_deflection.backbone import backbone as backbone
from .large_deflection import DeflectedPlate as DeflectedPlate, LargeDeflection as LargeDeflection
from .influence import InfluenceShapes as InfluenceShapes
from .optics import (
    InfluenceFit as InfluenceFit,
    MeasuredInfluence as MeasuredInfluence,
    fit_influence as fit_influence,
    read_influence as read_influence,
)
from .plate import Plate as Plate
from .sections import PlateSection as PlateSection
from .shapes import Shapes as Shapes
from .sections import VaryingSection as VaryingSection
from .modes import Modes as Modes

# Not public: for the packages that build on this one.
from .analytic import DiscShapes as DiscShapes
from .pictures import (
    distance_drawn as distance_drawn,
    draw_supports as draw_supports,
    extent as extent,
    frame_around as frame_around,
    mark_actuators as mark_actuators,
    marked as marked,
    marker_size as marker_size,
    pitch as pitch,
)
from .modes import MAX_MODES as MAX_MODES, ExcitedModes as ExcitedModes, Excitation as Excitation
from .moving_shapes import (
    HeldShapes as HeldShapes,
    MovingShapes as MovingShapes,
    StretchedShapes as StretchedShapes,
)
from .plate import TRUNCATION as TRUNCATION
from . import verification as verification
from .verification import Check as Check
