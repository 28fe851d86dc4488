"""Tests of the real server on the lab's network: one application on three ports."""

import asyncio
import logging
import socket
import ssl
from collections.abc import Iterator
from contextlib import nullcontext

import httpx2
import pytest
import uvicorn
from starlette.types import Receive, Scope, Send
from websockets.exceptions import InvalidStatus

from app.lan.serving import Door, LabServer, SocketProtocol, bind
from tests.features.lab import STUDY, ok
from tests.lan.devices import CREDENTIALS, greeted, pair_headset
from tests.support.lan import LanServer

UPGRADE = (
    b"GET %s HTTP/1.1\r\nhost: localhost\r\nupgrade: websocket\r\nconnection: Upgrade\r\n"
    b"sec-websocket-version: 13\r\nsec-websocket-key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
)


@pytest.fixture(scope="module")
def lan(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LanServer]:
    """Yield a server with the built-in authority."""
    with LanServer(tmp_path_factory.mktemp("lan")) as server:
        yield server


def raw(port: int, request: bytes) -> bytes:
    """Send exactly these bytes over plain TCP and return the whole answer."""
    with socket.create_connection(("127.0.0.1", port), timeout=20) as connection:
        connection.sendall(request)
        answer = b""
        while chunk := connection.recv(65536):
            answer += chunk
    return answer


def test_all_ports_serve_one_application(lan: LanServer) -> None:
    """A session created over HTTP on this machine is available over HTTPS."""
    with lan.client() as here, lan.secure_client() as there:
        ok(here.post("/api/login", json=CREDENTIALS))
        ok(there.post("/api/login", json=CREDENTIALS))
        made = ok(here.post(f"/api/studies/{STUDY}/sessions", json={"kind": "test"}))
        assert ok(there.get(f"/api/sessions/{made['id']}"))["id"] == made["id"]


def test_cookies_over_https_are_bound_to_the_host(lan: LanServer) -> None:
    """HTTPS cookies are `__Host-` and Secure; each kind is accepted only on its own port."""
    with lan.client() as here, lan.secure_client() as there:
        plain = here.post("/api/login", json=CREDENTIALS).headers["set-cookie"]
        bound = there.post("/api/login", json=CREDENTIALS).headers["set-cookie"]
        assert plain.startswith("reembody_login=")
        assert "secure" not in plain.lower()
        assert bound.startswith("__Host-reembody_login=")
        assert {"secure", "path=/", "httponly", "samesite=strict"} <= {
            part.strip().lower() for part in bound.split(";")
        }
        assert "domain" not in bound.lower()
        token = bound.partition("=")[2].partition(";")[0]
    for name in ("reembody_login", "__Host-reembody_login"):
        cookie = {"cookie": f"{name}={token}"}
        with lan.client() as here, lan.secure_client() as there:
            over_http = ok(here.get("/api/me", headers=cookie))["account"]
            over_https = ok(there.get("/api/me", headers=cookie))["account"]
        assert (over_http is None, over_https is None) == (
            name.startswith("__Host-"),
            not name.startswith("__Host-"),
        )


def test_signing_out_over_https_deletes_the_cookie(lan: LanServer) -> None:
    """Signing out over HTTPS deletes the cookie with the attributes that browsers require."""
    with lan.secure_client() as client:
        ok(client.post("/api/login", json=CREDENTIALS))
        removed = client.post("/api/logout").headers["set-cookie"].lower()
        assert removed.startswith("__host-reembody_login=")
        assert "secure" in removed
        assert "path=/" in removed
        assert ok(client.get("/api/me"))["account"] is None


def test_a_refused_socket_writes_nothing_in_the_log(caplog: pytest.LogCaptureFixture) -> None:
    """A refused socket writes nothing to the log, so that refusals cannot fill the disk."""
    paths = ("/a-body", "/no-body")

    async def refusing(scope: Scope, _receive: Receive, send: Send) -> None:
        if scope["path"] == "/no-body":
            await send({"type": "websocket.close", "code": 4403})
        elif scope["type"] == "websocket":
            start, body = "websocket.http.response.start", "websocket.http.response.body"
            await send({"type": start, "status": 429, "headers": []})
            await send({"type": body, "body": b"sl", "more_body": True})
            await send({"type": body, "body": b"ow"})

    async def refused_answers() -> list[bytes]:
        sockets = bind(("127.0.0.1",), 0, "--port")
        port = sockets[0].getsockname()[1]
        config = uvicorn.Config(refusing, ws=SocketProtocol, lifespan="off", log_config=None)
        serves = asyncio.Event()

        async def meanwhile() -> None:
            serves.set()

        server = LabServer([Door(sockets, config)], meanwhile)
        serving = asyncio.create_task(server.serve())
        await serves.wait()
        answers = [await asyncio.to_thread(raw, port, UPGRADE % path.encode()) for path in paths]
        server.should_exit = True
        await serving
        return answers

    with caplog.at_level(logging.WARNING):
        body, no_body = asyncio.run(refused_answers())
    assert body.startswith(b"HTTP/1.1 429 ")
    assert body.endswith(b"\r\n\r\nslow")
    assert no_body.startswith(b"HTTP/1.1 403 ")
    assert caplog.messages == []


def test_headsets_are_served_over_wss(lan: LanServer) -> None:
    """A headset connects over wss and ws from our own origin, and is refused from a foreign one."""
    with lan.secure_client() as client:
        ok(client.post("/api/login", json=CREDENTIALS))
        _, token = pair_headset(client)
    trust = lan.trusting()
    secure = asyncio.run(greeted(lan.secure_url, token, ssl=trust, origin=lan.secure_url))
    plain = asyncio.run(greeted(lan.url, token, origin=lan.url))
    assert secure["type"] == plain["type"] == "welcome"
    for url, options in ((lan.secure_url, {"ssl": trust}), (lan.url, {})):
        with pytest.raises(InvalidStatus):
            asyncio.run(greeted(url, token, origin="https://evil.example", **options))


def test_old_tls_is_refused(lan: LanServer) -> None:
    """TLS 1.2 and 1.3 are accepted, TLS 1.1 is refused."""
    for version, works in (
        (ssl.TLSVersion.TLSv1_1, False),
        (ssl.TLSVersion.TLSv1_2, True),
        (ssl.TLSVersion.TLSv1_3, True),
    ):
        context = lan.trusting()
        with pytest.warns(DeprecationWarning, match="TLSv1_1") if not works else nullcontext():
            context.minimum_version = context.maximum_version = version
        assert _handshake(lan, context) is works


def test_a_client_that_does_not_trust_the_authority_fails(lan: LanServer) -> None:
    """A client that does not trust the lab's authority fails the handshake."""
    assert not _handshake(lan, ssl.create_default_context())


def test_no_port_sends_strict_transport_security(lan: LanServer) -> None:
    """No port sends Strict-Transport-Security, which would block the help page."""
    with lan.client() as here, lan.secure_client() as there:
        answers = [here.get("/api/health"), there.get("/api/health"), httpx2.get(lan.help_url)]
    for answer in answers:
        assert answer.status_code == 200
        assert "strict-transport-security" not in answer.headers


@pytest.mark.parametrize(
    "path",
    [
        *("/api/health", "/api/login", "/tablet", "//", "/../tls/authority.pem", "/..%2ftls"),
        *("/assets/../../data/tls/authority.pem", "http://127.0.0.1/api/health", "/%00"),
    ],
)
def test_the_help_port_serves_nothing_else(lan: LanServer, path: str) -> None:
    """The help port answers other paths, sent as exact bytes, with an error and no redirect."""
    answer = raw(
        lan.help_port,
        f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n".encode(),
    )
    status = answer.split(b"\r\n", 1)[0]
    assert b"404" in status or b"400" in status, status
    assert b"location:" not in answer.lower()
    assert b"PRIVATE" not in answer


def test_the_help_port_refuses_websockets(lan: LanServer) -> None:
    """The help port refuses WebSockets."""
    with pytest.raises(InvalidStatus):
        asyncio.run(greeted(lan.help_url, "token"))


def test_terminal_console_and_help_page_show_the_same_network(lan: LanServer) -> None:
    """Terminal, console and help page show the same addresses and fingerprint."""
    with lan.client() as client:
        ok(client.post("/api/login", json=CREDENTIALS))
        reply = ok(client.get("/api/network"))
        shown = ok(
            client.post(
                f"/api/sessions/{pair_headset(client)[0]}/pairings", json={"device": "tablet"}
            )
        )
    assert reply["mode"] == "lan"
    assert [one["url"] for one in reply["addresses"]] == [lan.secure_url]
    assert reply["help"]["url"] == lan.help_url
    fingerprint = reply["certificate"]["fingerprint"]
    assert fingerprint[:47] in lan.log
    assert fingerprint[48:] in lan.log
    assert fingerprint[:11] in httpx2.get(lan.help_url).text
    assert reply["cable"] == {
        "command": f"adb reverse tcp:{lan.port} tcp:{lan.port}",
        "url": f"http://localhost:{lan.port}/vr",
    }
    # The console was opened at localhost; the tablet must not be sent to its own localhost.
    assert shown["url"] == f"{lan.secure_url}/tablet?code={shown['code']}"
    assert shown["help_url"] == lan.help_url


def _handshake(server: LanServer, context: ssl.SSLContext) -> bool:
    try:
        with (
            socket.create_connection(("127.0.0.1", server.lan_port), timeout=20) as plain,
            context.wrap_socket(plain, server_hostname="127.0.0.1"),
        ):
            return True
    except (ssl.SSLError, ConnectionResetError):
        return False
