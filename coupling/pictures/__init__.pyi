from .case import draw_case as draw_case
from .path import PATH_COLOUR as PATH_COLOUR, STICK_COLOUR as STICK_COLOUR, draw_path as draw_path
from .plate import (
    Patch as Patch,
    Relief as Relief,
    Scale as Scale,
    cut_out as cut_out,
    divided as divided,
    draw_plate as draw_plate,
    draw_window as draw_window,
    marker_size as marker_size,
    relief_of as relief_of,
)
from .portrait import FloatArray as FloatArray, Portrait as Portrait
from .prefixes import NOTHING as NOTHING, STEPS as STEPS, Unit as Unit, plain_ticks as plain_ticks, readable as readable
from .run import draw_run as draw_run, draw_surface as draw_surface, label_places as label_places, plot_run as plot_run
from .time import (
    Curves as Curves,
    SHADES as SHADES,
    curves_of as curves_of,
    draw_over_time as draw_over_time,
    stretches as stretches,
)
from .window import (
    PITCHES as PITCHES,
    extent as extent,
    is_visible as is_visible,
    path_window as path_window,
    pitch as pitch,
)
