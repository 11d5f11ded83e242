from .opened import Opened as Opened, open_case as open_case
from .server import Server as Server
