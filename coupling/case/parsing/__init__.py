"""Parsing: a TOML file as plain tables with their lines; repair of what is not quite TOML."""

from coupling.case.parsing.toml_file import CaseError, Problem, parse, table_opened, unfit_name
