"""Mistakes: which key or value somebody meant, and what is wrong in the words of the file."""

from coupling.case.mistakes.layout import Location, home_of_keys, models_in, table_at, value_at
from coupling.case.mistakes.meaning import meaning_of
from coupling.case.mistakes.messages import (
    RULES,
    InputError,
    Mistake,
    in_double_brackets,
    in_file,
    input_error,
    location_text,
    message_of,
    misspelt_in,
    mistakes_in,
    one_of,
    why_wrong,
)
