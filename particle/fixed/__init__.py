"""Fixed steps in time, for comparison."""

from particle.fixed.samples import between
from particle.fixed.steps import (
    MAX_ROWS,
    MOREAU,
    PAPER,
    default_step,
    march_fixed,
    new_fixed_memory,
    shortest_stroke,
    step_count,
)
