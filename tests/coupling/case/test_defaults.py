"""The case file's defaults are those of the contact itself, which it does not import for the sake of a quick start."""

from coupling.case import KogutEtsionCase
from particle import KogutEtsion


def test_defaults_of_the_case_file_are_those_of_the_contact():
    assert KogutEtsion(**KogutEtsionCase().model_dump(exclude={"model", "preset"})) == KogutEtsion()


def test_preset_of_the_case_file_is_that_of_the_contact():
    read = KogutEtsionCase(preset="paper")
    assert KogutEtsion(**read.model_dump(exclude={"model", "preset"})) == KogutEtsion.paper()
