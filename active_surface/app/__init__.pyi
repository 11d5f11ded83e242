from .answers import Lanes as Lanes
from .opened import Opened as Opened, open_case as open_case
from .server import Server as Server
from .session import Session as Session
