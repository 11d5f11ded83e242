"""Pictures of cases and runs, which register here how they are drawn."""

from coupling.pictures.case import draw_case
from coupling.pictures.comparison import draw_comparison
from coupling.pictures.figure import (
    clear_labels,
    map_axes,
    plain_ticks,
    put_keys,
    put_label,
    put_title,
    save_picture,
)
from coupling.pictures.parts import PARTS_COLOURS, draw_parts
from coupling.pictures.plate import (
    PITCHES,
    PlateView,
    Scale,
    draw_maps,
    draw_path,
    draw_plate,
    draw_window,
    is_visible,
    path_window,
)
from coupling.pictures.portrait import Portrait, chosen_drives, portrait_of, samples_of
from coupling.pictures.run import draw_run, draw_way
from coupling.pictures.time import MARKS, all_curves_of, curves_of, draw_events, draw_over_time
