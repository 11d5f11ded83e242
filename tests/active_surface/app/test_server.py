"""The server: who gets the page and its files, and who gets nothing."""

import asyncio
import json

import pytest

pytest.importorskip("tornado", reason="tornado is not installed")
from tornado.httpclient import AsyncHTTPClient, HTTPClientError, HTTPRequest  # noqa: E402
from tornado.websocket import websocket_connect  # noqa: E402

from active_surface.app import server as module  # noqa: E402
from active_surface.app.server import OWN, SHARED, Server  # noqa: E402


def served(work, monkeypatch=None):
    """What work(server, get) gives while a server runs; get(path, headers) gives the status and the response."""

    async def both():
        server = Server()
        client = AsyncHTTPClient()

        async def get(address, **headers):
            request = HTTPRequest(address, headers={key.replace("_", "-"): value for key, value in headers.items()})
            try:
                response = await client.fetch(request)
            except HTTPClientError as error:
                return error.code, error.response
            return response.code, response

        running = asyncio.create_task(server._run(lambda: None))
        await asyncio.sleep(0.05)
        try:
            return await work(server, get)
        finally:
            server._ended.set()
            await running
            client.close()

    return asyncio.run(both())


def test_the_page_and_its_files_are_there_and_load_nothing_from_elsewhere():
    async def work(server, get):
        status, page = await get(server.address)
        assert status == 200
        text = page.body.decode()
        assert "http:" not in text and "https:" not in text and "<script>" not in text and "onclick" not in text
        policy = page.headers["Content-Security-Policy"]
        assert "default-src 'none'" in policy and "script-src 'self';" in policy and "unsafe-eval" not in policy
        for name in ("plotly.js", *SHARED, *OWN):
            assert name in text
            status, file = await get(server.address + name)
            assert status == 200 and len(file.body) > 500
            assert file.headers["X-Content-Type-Options"] == "nosniff"

    served(work)


@pytest.mark.parametrize(
    "name",
    ["app.html", "../server.py", "..%2fserver.py", "%2e%2e/server.py", "a/b", "/etc/passwd", "page.css/../app.html"],
)
def test_no_other_file_is_there(name):
    async def work(server, get):
        status, response = await get(server.address + name)
        assert status == 404 and response.body == b""

    served(work)


def test_without_the_token_or_by_another_name_or_from_another_site_there_is_nothing():
    async def work(server, get):
        root = f"http://127.0.0.1:{server.port}/"
        with pytest.raises(ValueError, match=f"Input port must be a free port, .*; got {server.port}"):
            Server(port=server.port)
        assert (await get(root))[0] == 404
        assert (await get(f"{root}wrong/"))[0] == 404
        assert (await get(f"{root}wrong/app.js"))[0] == 404
        assert (await get(server.address, Host=f"evil.example:{server.port}"))[0] == 403
        for origin in ("http://evil.example", "null", f"http://127.0.0.1:{server.port + 1}"):
            status, response = await get(server.address, Origin=origin)
            assert status == 403 and response.body == b""
            assert "Access-Control-Allow-Origin" not in response.headers

    served(work)


def test_it_listens_on_the_loopback_address_only():
    server = Server()
    assert {sock.getsockname()[0] for sock in server._sockets} == {"127.0.0.1"}
    for sock in server._sockets:
        sock.close()
    assert len(server.address.split("/")[3]) >= 32


def test_only_the_page_itself_gets_a_socket():
    async def work(server, get):
        address = server.address.replace("http:", "ws:") + "socket"
        home = f"http://127.0.0.1:{server.port}"
        for headers in ({}, {"Origin": "http://evil.example"}, {"Origin": home, "Host": "evil.example"}):
            with pytest.raises(HTTPClientError) as refused:
                await websocket_connect(HTTPRequest(address, headers=headers))
            assert refused.value.code == 403
        with pytest.raises(HTTPClientError) as refused:
            wrong = f"ws://127.0.0.1:{server.port}/wrong/socket"
            await websocket_connect(HTTPRequest(wrong, headers={"Origin": home}))
        assert refused.value.code == 404
        link = await websocket_connect(HTTPRequest(address, headers={"Origin": home}))
        tab, menu = json.loads(await link.read_message()), json.loads(await link.read_message())
        assert tab["kind"] == "tab" and menu["kind"] == "menu"
        copy = await websocket_connect(HTTPRequest(f"{address}?tab={tab['tab']}", headers={"Origin": home}))
        assert json.loads(await copy.read_message())["tab"] != tab["tab"]  # a copied tab has its own case
        await link.write_message("no JSON")
        assert json.loads(await link.read_message())["kind"] == "refused"
        link.close()
        copy.close()

    served(work)


def test_it_ends_with_its_last_tab_but_not_while_that_is_loaded_again(monkeypatch):
    monkeypatch.setattr(module, "GRACE", 0.3)

    async def work():
        server = Server()
        running = asyncio.create_task(server._run(lambda: None))
        await asyncio.sleep(0.05)
        address, home = server.address.replace("http:", "ws:") + "socket", f"http://127.0.0.1:{server.port}"

        async def connect(tab=""):
            link = await websocket_connect(HTTPRequest(f"{address}?tab={tab}", headers={"Origin": home}))
            return link, json.loads(await link.read_message())["tab"]

        link, tab = await connect()
        link.close()
        await asyncio.sleep(0.1)
        again, same = await connect(tab)
        assert same == tab
        await asyncio.sleep(0.5)
        assert not running.done()
        again.close()
        await asyncio.wait_for(running, 10)

    asyncio.run(work())
