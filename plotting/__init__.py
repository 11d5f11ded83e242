"""Plotting: figures that notebooks show, over matplotlib alone; imported when something is drawn."""
