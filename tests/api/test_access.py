"""Who gets in: every route is closed unless it is meant to be open."""

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
    """Every documented (method, path)."""
    paths = lab.app.openapi()["paths"]
    return sorted((method, path) for path, methods in paths.items() for method in methods)


@pytest.mark.one_engine
def test_every_route_but_the_public_ones_asks_who_is_there(lab: Lab) -> None:
    """Without login, pairing or token each one answers 401 in the common shape."""
    closed = [route for route in routes(lab) if route not in PUBLIC]
    assert len(closed) >= 24
    stranger = lab.stranger()
    for method, path in closed:
        address = re.sub(r"\{\w+\}", "x", path)
        refusal = error(stranger.request(method, address, json={}), 401, "not_signed_in")
        assert refusal["remedy"], path


@pytest.mark.one_engine
def test_what_is_meant_to_be_public_exists(lab: Lab) -> None:
    """The list of open routes has no name that went away."""
    assert set(routes(lab)) >= PUBLIC


def test_a_tablet_is_no_operator(lab: Lab) -> None:
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
def test_a_headset_is_neither_operator_nor_tablet(lab: Lab) -> None:
    """A headset's token opens the headset's route and no other."""
    session_id = lab.join()["id"]
    headset = lab.stranger()
    headset.headers["authorization"] = f"Bearer {lab.headset_token(session_id)}"
    for method, path in routes(lab):
        if (method, path) in PUBLIC or path == "/api/vr/avatar":
            continue
        address = path.replace("{session_id}", session_id)
        error(
            headset.request(method, re.sub(r"\{\w+\}", "x", address), json={}), 401, "not_signed_in"
        )


@pytest.mark.one_engine
def test_an_operator_is_no_tablet(lab: Lab) -> None:
    """A login does not answer a participant's form."""
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
    """A request that another site made is refused, signed in or not."""
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
def test_our_own_pages_and_scripts_get_through(lab: Lab, headers: dict[str, str]) -> None:
    """The same request from our origin, or without a browser, is looked at."""
    answer = lab.operator.post("/api/studies/check", json={"yaml": "a: 1"}, headers=headers)
    assert answer.status_code == 200


@pytest.mark.one_engine
def test_reading_is_left_to_the_browsers_own_rules(lab: Lab) -> None:
    """A link from another site may open a page; it changes nothing."""
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
def test_a_name_of_the_internet_does_not_lead_here(lab: Lab, host: str, status: int) -> None:
    """A hostile page that makes its name lead to this address gets nothing (DNS rebinding)."""
    assert lab.stranger().get("/api/health", headers={"host": host}).status_code == status


@pytest.mark.one_engine
def test_no_foreign_page_gets_anything_changed_anywhere(lab: Lab) -> None:
    """Every changing route, with an operator's login, asked by three kinds of foreign pages."""
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
    """A WebSocket's handshake from another origin is refused, whatever token it brings."""
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
