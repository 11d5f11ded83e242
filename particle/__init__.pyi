from .air import Air as Air
from .batch import Interrupted as Interrupted, processors as processors, simulate_many as simulate_many
from .drives.drive import Drive as Drive, Segment as Segment, SegmentDrive as SegmentDrive
from .drives.points import HermiteDrive as HermiteDrive, TableDrive as TableDrive
from .drives.table import AnyDrive as AnyDrive
from .friction.contact import ConstantFriction as ConstantFriction, CoulombAdhesion as CoulombAdhesion
from .friction.kogut_etsion import KogutEtsion as KogutEtsion
from .friction.face import FaceLaw as FaceLaw
from .friction.local import LocalContact as LocalContact
from .friction.table import FrictionTable as FrictionTable
from .body.body import Body as Body
from .film import Film as Film
from .footprint import Footprint as Footprint
from .simulation import Micropart as Micropart, part_record as part_record, simulate as simulate
from .modes import EventKind as EventKind, Outcome as Outcome, State as State
from .surface.moving_surface import SurfaceMotion as SurfaceMotion, SurfaceState as SurfaceState
from .surface.simple_surfaces import platform_surface as platform_surface, polynomial_surface as polynomial_surface
from .samples import (
    ContactSamples as ContactSamples,
    Event as Event,
    Samples as Samples,
    dataset_of as dataset_of,
    table_of as table_of,
)
from .trajectory import Energy as Energy, FilmEnergy as FilmEnergy, Trajectory as Trajectory

# Not public: for the packages that build on this one.
from .film import assumed_contact as assumed_contact
from .friction_input import (
    KogutEtsionInput as KogutEtsionInput,
    MIN_POINTS as MIN_POINTS,
    PAPER_PLASTICITY_INDEX as PAPER_PLASTICITY_INDEX,
    point_mistakes as point_mistakes,
)
from .interrupt import (
    Stopped as Stopped,
    interruptible as interruptible,
    is_held_back as is_held_back,
    side_by_side as side_by_side,
    stoppable as stoppable,
    unbroken as unbroken,
    wait as wait,
)
from .group import grouped as grouped
from .jit import (
    kernel as kernel,
    kernel_device as kernel_device,
    kernel_device_no_arrays as kernel_device_no_arrays,
    kernel_inlined as kernel_inlined,
    kernel_no_arrays as kernel_no_arrays,
)
from .kernel_cache import compilation_heard as compilation_heard, source_digest as source_digest
from .path import under_way as under_way
from .rest import (
    Extreme as Extreme,
    PartAtRest as PartAtRest,
    largest as largest,
    part_at_rest as part_at_rest,
    pull_ratios as pull_ratios,
    sample_times as sample_times,
)
from .pictures import (
    HALO as HALO,
    PATH_COLOUR as PATH_COLOUR,
    PLACE as PLACE,
    RING as RING,
    Rows as Rows,
    SHADES as SHADES,
    STICK_COLOUR as STICK_COLOUR,
    draw_line as draw_line,
    shade as shade,
    shade_keys as shade_keys,
    stretches as stretches,
)
