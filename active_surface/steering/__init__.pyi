from .aiming import aim as aim, plan as plan
from .following import Followed as Followed, follow_plan as follow_plan
from .objectives import Objective as Objective, objective as objective
from .read import read_route as read_route, read_task as read_task
from .result import Aimed as Aimed, Planned as Planned
from .settings import Settings as Settings
from .task import Route as Route, Task as Task

# Not public: for the packages that build on this one.
from .aiming import aim_over as aim_over
from .following import ATTEMPTS as ATTEMPTS, next_leg as next_leg, progress_of as progress_of
from .read import read_heading as read_heading, read_measured as read_measured
from .read import read_place as read_place, read_settings as read_settings
from . import report as report
from .objectives import prepared as prepared
from .probes import Unmoved as Unmoved
from .settings import AimTables as AimTables
