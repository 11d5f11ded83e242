from .parameters import FULL as FULL, PARAMETERS as PARAMETERS, Parameters as Parameters, QUICK as QUICK
from .reproduction import reproduce as reproduce
from .verdict import Verdict as Verdict

# Not public: for the packages that build on this one.
from .catalogue import modules_of as modules_of
from .reproduction import rounded as rounded
