"""Pictures of cases and runs, which register here how they are drawn."""

from coupling.pictures.case import draw_case
from coupling.pictures.events import APART, MARKS, draw_events
from coupling.pictures.file import save_picture
from coupling.pictures.keys import put_keys
from coupling.pictures.path import draw_path
from coupling.pictures.plate import (
    Piece,
    Relief,
    Scale,
    cut_out,
    draw_plate,
    draw_window,
    join,
    refined,
)
from coupling.pictures.portrait import (
    Portrait,
    chosen_drives,
    decisive_moment,
)
from coupling.pictures.run import draw_run, draw_surface
from coupling.pictures.ticks import map_axes, plain_ticks
from coupling.pictures.time import (
    Curves,
    draw_over_time,
    margins_over_time,
    strokes_of,
    velocities_of,
)
from coupling.pictures.window import PITCHES, is_visible, path_window
