"""Server: the page on the loopback address of this machine, for whoever has the token in its address."""

from __future__ import annotations

import asyncio
import errno
import hmac
import json
import secrets
import socket
from collections.abc import Callable
from contextlib import suppress
from html import escape
from pathlib import Path
from string import Template
from typing import Any, Final

from tornado.httpserver import HTTPServer
from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from active_surface.app.answers import Lanes
from active_surface.app.opened import Opened
from active_surface.app.session import Session
from active_surface.views import PARTS, part

HERE: Final = Path(__file__).parent / "page"
LOOPBACK: Final = "127.0.0.1"
GRACE: Final = 10.0  # s that a tab may be gone, as while it is loaded again
MAX_MESSAGE: Final = 1_000_000  # bytes from the page
SHARED: Final = ("page.css", "common.js", "plan.js", "surface.js", "curves.js", "run.js")
OWN: Final = ("app.css", "map.js", "knobs.js", "app.js")
TYPES: Final = {".js": "text/javascript", ".css": "text/css"}
HEADERS: Final = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-store",
}


class Server:
    """Serves a case, or the menu of examples, until the last tab is closed.

    Parameters
    ----------
    open_case : callable
        Opens the case anew for each tab; None: the tab shows the menu.
    port : int
        Where it listens; 0: anywhere free.
    """

    def __init__(self, open_case: Callable[[], Opened] | None = None, port: int = 0) -> None:
        self._open_case, self._token, self._lanes = open_case, secrets.token_urlsafe(24), Lanes()
        try:
            self._sockets = [socket.create_server((LOOPBACK, port))]
        except OSError as error:
            if error.errno != errno.EADDRINUSE:
                raise
            raise ValueError(f"Input port must be a free port, or 0 for any free one; got {port}") from None
        self._sockets[0].setblocking(False)
        self.port = int(self._sockets[0].getsockname()[1])
        self._tabs: dict[str, Session] = {}
        self._connected: dict[str, Socket] = {}
        self._leaving: dict[str, asyncio.TimerHandle] = {}
        self._ended: asyncio.Event | None = None

    @property
    def address(self) -> str:
        """Where the page is."""
        return f"http://{LOOPBACK}:{self.port}/{self._token}/"

    def run(self, ready: Callable[[], object] = lambda: None) -> None:
        """Serve until the last tab is closed; ready: is called once the page can be loaded."""
        asyncio.run(self._run(ready))

    async def _run(self, ready: Callable[[], object]) -> None:
        self._ended = asyncio.Event()
        server = HTTPServer(
            Application(
                [(r"/([^/]*)/", Page, {"server": self}), (r"/([^/]*)/socket", Socket, {"server": self}),
                 (r"/([^/]*)/([\w.-]+)", File, {"server": self}), (r".*", Nothing, {"server": self})],
                websocket_max_message_size=MAX_MESSAGE, compress_response=False, log_function=lambda handler: None,
            )
        )  # fmt: skip
        server.add_sockets(self._sockets)
        try:
            ready()
            await self._ended.wait()
        finally:
            server.stop()
            self._lanes.close()

    def check(self, handler: RequestHandler, token: str = "") -> None:
        """Raise HTTPError unless a request is of this machine and has the token: other sites get nothing."""
        hosts = {f"{LOOPBACK}:{self.port}", f"localhost:{self.port}"}
        if handler.request.host not in hosts:  # another name that leads here
            raise HTTPError(403)
        origin = handler.request.headers.get("Origin")
        if origin is not None and origin not in {f"http://{host}" for host in hosts}:
            raise HTTPError(403)
        if not hmac.compare_digest(token.encode(), self._token.encode()):
            raise HTTPError(404)

    def connect(self, tab: str, connection: Socket) -> tuple[str, Session]:
        """The session of a tab, which may have been loaded again; another one where the tab is a copy."""
        if not tab or tab in self._connected or tab not in self._tabs:
            tab = secrets.token_urlsafe(12)
            self._tabs[tab] = Session(self._lanes, self._open_case() if self._open_case else None)
        if waiting := self._leaving.pop(tab, None):
            waiting.cancel()
        self._connected[tab] = connection
        return tab, self._tabs[tab]

    def disconnect(self, tab: str) -> None:
        """A tab is gone; for good if it is not back soon."""
        self._connected.pop(tab, None)
        self._tabs[tab].disconnect()
        self._leaving[tab] = asyncio.get_running_loop().call_later(GRACE, self._forget, tab)

    def _forget(self, tab: str) -> None:
        self._leaving.pop(tab, None)
        self._tabs.pop(tab).close()
        if not self._tabs and self._ended is not None:
            self._ended.set()


class _Handler(RequestHandler):
    """What all answers have."""

    def initialize(self, server: Server) -> None:
        self._server = server

    def set_default_headers(self) -> None:
        self.clear_header("Server")
        for name, value in HEADERS.items():
            self.set_header(name, value)

    def write_error(self, status_code: int, **_: Any) -> None:
        self.finish()


class Nothing(_Handler):
    """Any other address."""

    def prepare(self) -> None:
        raise HTTPError(404)


class Page(_Handler):
    """The page itself."""

    def get(self, token: str) -> None:
        self._server.check(self, token)
        scripts = "\n".join(f'<script src="{name}" defer></script>' for name in ("plotly.js", *SHARED[1:], *OWN[1:]))
        text = (HERE / "app.html").read_text(encoding="utf-8")
        self.finish(
            Template(text).substitute(views=part("views.html"), scripts=scripts, title=escape("active-surface"))
        )


class File(_Handler):
    """A program or style of the page, or the plotting library: no other file."""

    def get(self, token: str, name: str) -> None:
        self._server.check(self, token)
        if name == "plotly.js":
            from plotly.offline import get_plotlyjs

            text = get_plotlyjs()
        elif name in SHARED:
            text = (PARTS / name).read_text(encoding="utf-8")
        elif name in OWN:
            text = (HERE / name).read_text(encoding="utf-8")
        else:
            raise HTTPError(404)
        self.set_header("Content-Type", f"{TYPES[Path(name).suffix]}; charset=utf-8")
        self.finish(text)


class Socket(WebSocketHandler):
    """The messages of a tab."""

    def initialize(self, server: Server) -> None:
        self._server = server
        self._tab = ""

    def check_origin(self, origin: str) -> bool:
        return True  # `check` has looked at it

    def prepare(self) -> None:
        self._server.check(self, self.path_args[0])
        if "Origin" not in self.request.headers:  # a browser always says who asks
            raise HTTPError(403)

    def write_error(self, status_code: int, **_: Any) -> None:
        self.finish()

    def open(self, *_: str, **__: str) -> None:
        self.set_nodelay(True)
        self._tab, self._session = self._server.connect(self.get_query_argument("tab", ""), self)
        self._send({"kind": "tab", "tab": self._tab})
        self._session.connect(self._send)

    def on_message(self, message: str | bytes) -> None:
        try:
            told = json.loads(message)
        except ValueError:
            told = None
        self._session.take(told)

    def on_close(self) -> None:
        if self._tab:
            self._server.disconnect(self._tab)

    def _send(self, message: dict[str, Any]) -> None:
        with suppress(WebSocketClosedError):
            self.write_message(json.dumps(message, allow_nan=False))
