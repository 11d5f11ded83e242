from .charts import COLOURS as COLOURS, edges as edges, outline as outline
from .panels import (
    Panel as Panel,
    about as about,
    draw_sweep as draw_sweep,
    outcome_panel as outcome_panel,
    panels as panels,
    value_panel as value_panel,
)
from .selection import Findings as Findings, Scale as Scale, Selection as Selection, read_findings as read_findings
