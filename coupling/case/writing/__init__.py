"""Writing: a case as text, templates and the JSON schema of files."""

from coupling.case.writing.edit import write_edited
from coupling.case.writing.schema import json_schema
from coupling.case.writing.templates import template
from coupling.case.writing.text import write_case
