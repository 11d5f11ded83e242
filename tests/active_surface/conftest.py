"""Tests of this folder run without advice."""

from without_advice import pytest_runtest_setup as pytest_runtest_setup
from without_advice import pytest_runtest_teardown as pytest_runtest_teardown
