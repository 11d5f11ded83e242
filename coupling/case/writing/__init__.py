"""Writing: a case as text, edited in place, and the template and JSON schema of files."""

from coupling.case.writing.edit import write_edited
from coupling.case.writing.template import json_schema, template
from coupling.case.writing.text import Difference, differences, write_case
