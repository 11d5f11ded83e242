"""The commands, by what they take."""

from active_surface.cli.commands.cases import advise, app, check, run
from active_surface.cli.commands.measured import fit, identify, influence
from active_surface.cli.commands.reference import completion, example, reproduce, schema, verify
from active_surface.cli.commands.results import animate, compare, export, plot, rerun, view
from active_surface.cli.commands.steering import aim, plan
from active_surface.cli.commands.studies import drift, feasibility, response, sweep

COMMANDS = [
    *(advise, aim, animate, app, check, compare, completion, drift, example, export, feasibility, fit, identify),
    *(influence, plan, plot, reproduce, rerun, response, run, schema, sweep, verify, view),
]
