"""Fixed steps in time, for comparison."""

from particle.fixed.samples import between
from particle.fixed.steps import MOREAU, MOST_ROWS, PAPER, default_step, march_fixed, shortest_stroke, step_count
