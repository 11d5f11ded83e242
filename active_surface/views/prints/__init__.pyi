from .plots import plot as plot
