from .bench import FULL as FULL, PARAMETERS as PARAMETERS, Parameters as Parameters, QUICK as QUICK
from .reproduction import reproduce as reproduce
from .verdict import Verdict as Verdict

# Not public: for the packages that build on this one.
from .reproduction import figures_of as figures_of, rounded as rounded
