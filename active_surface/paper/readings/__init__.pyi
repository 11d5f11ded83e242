from .cases import best_row as best_row
from .page import page_of_readings as page_of_readings
from .reading import READINGS as READINGS, Reading as Reading, SweepSize as SweepSize
from .reproduction import reproduce_readings as reproduce_readings
from .sweep import Row as Row, Sweep as Sweep, row_of as row_of, sweep_readings as sweep_readings
