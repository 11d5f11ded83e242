from .case import draw_case as draw_case
from .keys import put_keys as put_keys
from .events import APART as APART, MARKS as MARKS, draw_events as draw_events
from .file import save_picture as save_picture
from .path import draw_path as draw_path
from .plate import (
    Piece as Piece,
    Relief as Relief,
    Scale as Scale,
    cut_out as cut_out,
    draw_plate as draw_plate,
    draw_window as draw_window,
    join as join,
    refined as refined,
)
from .portrait import (
    Portrait as Portrait,
    chosen_drives as chosen_drives,
    decisive_moment as decisive_moment,
)
from .run import draw_run as draw_run, draw_surface as draw_surface, plot_run as plot_run
from .ticks import map_axes as map_axes, plain_ticks as plain_ticks
from .time import (
    Curves as Curves,
    draw_over_time as draw_over_time,
    margins_over_time as margins_over_time,
    strokes_of as strokes_of,
    velocities_of as velocities_of,
)
from .window import PITCHES as PITCHES, is_visible as is_visible, path_window as path_window
