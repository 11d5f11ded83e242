from .accuracy import (
    BAND as BAND,
    FINE as FINE,
    distances as distances,
    named_distances as named_distances,
    within as within,
)
from .coming_off import paragraph as paragraph
from .convergence import (
    ANY as ANY,
    HIGH as HIGH,
    LOW as LOW,
    converge as converge,
    from_start as from_start,
    from_states as from_states,
)
from .deceleration import slows_as_stated as slows_as_stated
from .feasible_area import (
    LOWEST_AREA as LOWEST_AREA,
    areas as areas,
    begins as begins,
    hills as hills,
    in_range as in_range,
    peaks_of_integrals as peaks_of_integrals,
)
from .handover import (
    HANDOVERS as HANDOVERS,
    Handover as Handover,
    LATE as LATE,
    OSCILLATIONS as OSCILLATIONS,
    anywhere as anywhere,
    arrives as arrives,
    cycles_until_there as cycles_until_there,
)
from .neighbours import (
    SIXTEEN as SIXTEEN,
    is_third as is_third,
    settled as settled,
    trend_of as trend_of,
    wave_shares as wave_shares,
)
from .radial import RADIAL_STARTS as RADIAL_STARTS, one_cycle as one_cycle, radial_errors as radial_errors
from .threshold import (
    STATED_STROKE as STATED_STROKE,
    STATED_THRESHOLD as STATED_THRESHOLD,
    THRESHOLD_WITHIN as THRESHOLD_WITHIN,
    curve_answer as curve_answer,
    ends_of as ends_of,
    loss_from as loss_from,
    shares_around as shares_around,
)
from .translocation import checks_of as checks_of, one_cycle_ends as one_cycle_ends
