from .drawing import (
    Axes as Axes,
    Drawing as Drawing,
    Figure as Figure,
    SIZE as SIZE,
    STEPS as STEPS,
    axes_or_new as axes_or_new,
    draw_rim as draw_rim,
    figure_of as figure_of,
    label_axis as label_axis,
    label_places as label_places,
    legend_below as legend_below,
)
from .hdf5 import (
    DEADLY as DEADLY,
    UNREADABLE as UNREADABLE,
    check_hdf5 as check_hdf5,
    lacking as lacking,
    survives as survives,
)
from .plotting import draw as draw, notebook_html as notebook_html
from .wording import (
    NOTHING as NOTHING,
    Unit as Unit,
    count as count,
    joined as joined,
    percent as percent,
    quantity as quantity,
    quantity_text as quantity_text,
    range_text as range_text,
    unit_for as unit_for,
)
