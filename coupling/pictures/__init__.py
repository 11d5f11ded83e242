"""Pictures of cases and runs, which register here how they are drawn."""

from coupling.pictures.case import draw_case
from coupling.pictures.events import APART, MARKS, draw_events
from coupling.pictures.figure import map_axes, plain_ticks, put_keys, put_title, save_picture
from coupling.pictures.labels import clear_labels, put_label
from coupling.pictures.path import PITCHES, draw_path, is_visible, path_window
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
    cycles_of,
    decisive_moment,
)
from coupling.pictures.run import draw_run, draw_surface
from coupling.pictures.time import (
    Curves,
    draw_over_time,
    margins_over_time,
    strokes_of,
    velocities_of,
)
