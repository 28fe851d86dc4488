"""Tests of access: every route is closed unless it is meant to be public."""

import re

import pytest
from starlette.websockets import WebSocketDisconnect

from app.platform.policy import ANYONE, POLICY
from app.wire.messages import SUBPROTOCOL
from tests.faults.figures import note
from tests.features.lab import Lab, error

PUBLIC = {
    (name.split()[0].lower(), name.split()[1]) for name, who in POLICY.items() if who == ANYONE
}


def routes(lab: Lab) -> list[tuple[str, str]]:
    """Return every documented (method, path)."""
    paths = lab.app.openapi()["paths"]
    return sorted((method, path) for path, methods in paths.items() for method in methods)


@pytest.mark.one_engine
def test_every_route_but_the_public_ones_needs_authentication(lab: Lab) -> None:
    """Every route but the public ones answers 401 in the common shape without authentication."""
    closed = [route for route in routes(lab) if route not in PUBLIC]
    assert len(closed) >= 24
    stranger = lab.stranger()
    for method, path in closed:
        address = re.sub(r"\{\w+\}", "x", path)
        refusal = error(stranger.request(method, address, json={}), 401, "not_signed_in")
        assert refusal["remedy"], path


@pytest.mark.one_engine
def test_every_public_route_exists(lab: Lab) -> None:
    """Every route that the policy lists as public exists."""
    assert set(routes(lab)) >= PUBLIC


def test_a_tablet_opens_no_route_of_the_console(lab: Lab) -> None:
    """A tablet's cookie opens the tablet's routes and none of the console's."""
    session_id = lab.join()["id"]
    tablet = lab.tablet(session_id)
    for method, path in routes(lab):
        if (method, path) in PUBLIC or path.startswith("/api/tablet"):
            continue
        address = path.replace("{session_id}", session_id)
        error(
            tablet.request(method, re.sub(r"\{\w+\}", "x", address), json={}), 401, "not_signed_in"
        )


@pytest.mark.one_engine
def test_a_headset_opens_only_its_own_routes(lab: Lab) -> None:
    """A headset's token opens the headset's routes and no other."""
    session_id = lab.join()["id"]
    headset = lab.stranger()
    headset.headers["authorization"] = f"Bearer {lab.headset_token(session_id)}"
    for method, path in routes(lab):
        if (method, path) in PUBLIC or path.startswith("/api/vr/"):
            continue
        address = path.replace("{session_id}", session_id)
        error(
            headset.request(method, re.sub(r"\{\w+\}", "x", address), json={}), 401, "not_signed_in"
        )


@pytest.mark.one_engine
def test_an_operator_opens_no_route_of_the_tablet(lab: Lab) -> None:
    """An operator's login does not open the tablet's routes."""
    error(lab.operator.get("/api/tablet/state"), 401, "not_signed_in")


@pytest.mark.one_engine
@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "https://elsewhere.example"},
        {"origin": "null"},
        {"origin": "http://testserver:8080"},
        {"origin": "http://testserver.elsewhere.example"},
        {"sec-fetch-site": "cross-site"},
        {"sec-fetch-site": "same-site"},
        {"origin": "http://testserver", "sec-fetch-site": "cross-site"},
    ],
)
@pytest.mark.parametrize("method", ["post", "put", "delete", "patch"])
def test_another_sites_page_cannot_change_anything(
    lab: Lab, method: str, headers: dict[str, str]
) -> None:
    """A changing request from another site is refused, even with a valid login."""
    answer = lab.operator.request(method, "/api/studies", json={}, headers=headers)
    refusal = error(answer, 403, "not_allowed")
    assert refusal["message"] == "this request comes from another site"


@pytest.mark.one_engine
@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "http://testserver", "sec-fetch-site": "same-origin"},
        {"sec-fetch-site": "none"},
        {},
    ],
)
def test_our_own_pages_and_scripts_are_accepted(lab: Lab, headers: dict[str, str]) -> None:
    """A request from our own origin, or without a browser, is accepted."""
    answer = lab.operator.post("/api/studies/check", json={"yaml": "a: 1"}, headers=headers)
    assert answer.status_code == 200


@pytest.mark.one_engine
def test_a_cross_site_read_is_accepted(lab: Lab) -> None:
    """A reading request from another site is accepted, as it changes nothing."""
    answer = lab.operator.get("/api/health", headers={"sec-fetch-site": "cross-site"})
    assert answer.status_code == 200


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("host", "status"),
    [
        ("testserver", 200),
        ("localhost:8321", 200),
        ("127.0.0.1:8321", 200),
        ("[::1]:8321", 200),
        ("192.168.1.20:8443", 200),
        ("lab-pc.local:8443", 200),
        ("rebound.example.com", 403),
        ("rebound.example.com:8321", 403),
        ("127.0.0.1.rebound.example.com", 403),
        ("local", 200),
        ("evil.notlocal", 403),
    ],
)
def test_a_public_host_name_is_refused(lab: Lab, host: str, status: int) -> None:
    """A request under a public host name is refused, against DNS rebinding."""
    assert lab.stranger().get("/api/health", headers={"host": host}).status_code == status


@pytest.mark.one_engine
def test_no_changing_route_accepts_a_foreign_page(lab: Lab) -> None:
    """No changing route accepts an operator's request from any of three kinds of foreign pages."""
    foreign = (
        {"origin": "https://elsewhere.example"},
        {"origin": "null"},
        {"sec-fetch-site": "cross-site"},
    )
    changing = [route for route in routes(lab) if route[0] != "get"]
    passes = [
        (method, path, headers)
        for method, path in changing
        for headers in foreign
        if lab.operator.request(
            method, re.sub(r"\{\w+\}", "x", path), json={}, headers=headers
        ).status_code
        != 403
    ]
    note(32, "requests of foreign pages", "changing routes asked", len(changing) * len(foreign))
    note(32, "requests of foreign pages", "passes", len(passes))
    assert passes == []


@pytest.mark.one_engine
@pytest.mark.parametrize("origin", ["https://elsewhere.example", "null", "http://testserver:99"])
def test_a_foreign_page_opens_no_socket(lab: Lab, origin: str) -> None:
    """A WebSocket from another origin is refused, even with a valid token."""
    token = lab.headset_token(lab.join()["id"])
    headers = {"origin": origin, "host": "testserver"}
    offered = [SUBPROTOCOL, f"bearer.{token}"]
    with (
        pytest.raises(WebSocketDisconnect) as refused,
        lab.operator.websocket_connect("/api/vr/stream", subprotocols=offered, headers=headers),
    ):
        pass
    assert refused.value.code == 4403
    note(32, "sockets of foreign pages", f"origin {origin}: close code", refused.value.code)
