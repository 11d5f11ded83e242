"""How many processors there are to work on."""

import os


def processors() -> int:
    """Those that this process may use, or all where the system does not tell, as macOS."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
