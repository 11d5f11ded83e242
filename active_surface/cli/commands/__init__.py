"""The commands, a module for each or two; each adds itself to the group when it is loaded."""

from active_surface.cli.commands import (
    aim,
    animate,
    app,
    check,
    completion,
    example,
    export,
    feasibility,
    fit,
    identify,
    influence,
    plot,
    reproduce,
    rerun,
    response,
    run,
    schema,
    sweep,
    verify,
    view,
)
