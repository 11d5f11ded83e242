from .findings import Findings as Findings, read_findings as read_findings
from .heat import COLOURS as COLOURS, edges as edges, outline as outline
from .map import (
    Panel as Panel,
    about as about,
    draw_sweep as draw_sweep,
    outcome_panel as outcome_panel,
    panels as panels,
    value_panel as value_panel,
)
from .selection import Scale as Scale, Selection as Selection
