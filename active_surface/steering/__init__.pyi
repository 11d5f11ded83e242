from .aimed import Aimed as Aimed
from .aiming import aim as aim
from .planned import Planned as Planned
from .planning import plan as plan
from .read import read_route as read_route, read_task as read_task
from .route import Route as Route
from .tables import Settings as Settings
from .task import Task as Task

# Not public: for the packages that build on this one.
from .places import read_place as read_place
from .read import read_settings as read_settings
from . import report as report
from .tables import AimTables as AimTables
