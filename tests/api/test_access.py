"""Who gets in: every route is closed unless it is meant to be open."""

import re

import pytest

from app.features.policy import ANYONE, POLICY
from tests.features.lab import Lab, error

PUBLIC = {
    (name.split()[0].lower(), name.split()[1]) for name, who in POLICY.items() if who == ANYONE
}


def routes(lab: Lab) -> list[tuple[str, str]]:
    """Every documented (method, path)."""
    paths = lab.app.openapi()["paths"]
    return sorted((method, path) for path, methods in paths.items() for method in methods)


def test_every_route_but_the_public_ones_asks_who_is_there(lab: Lab) -> None:
    """Without login, pairing or token each one answers 401 in the common shape."""
    closed = [route for route in routes(lab) if route not in PUBLIC]
    assert len(closed) >= 24
    stranger = lab.stranger()
    for method, path in closed:
        address = re.sub(r"\{\w+\}", "x", path)
        refusal = error(stranger.request(method, address, json={}), 401, "not_signed_in")
        assert refusal["remedy"], path


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


def test_a_headset_is_neither_operator_nor_tablet(lab: Lab) -> None:
    """A headset's token opens no HTTP route at all."""
    session_id = lab.join()["id"]
    headset = lab.stranger()
    headset.headers["authorization"] = f"Bearer {lab.headset_token(session_id)}"
    for method, path in routes(lab):
        if (method, path) in PUBLIC:
            continue
        address = path.replace("{session_id}", session_id)
        error(
            headset.request(method, re.sub(r"\{\w+\}", "x", address), json={}), 401, "not_signed_in"
        )


def test_an_operator_is_no_tablet(lab: Lab) -> None:
    """A login does not answer a participant's form."""
    error(lab.operator.get("/api/tablet/state"), 401, "not_signed_in")


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


def test_reading_is_left_to_the_browsers_own_rules(lab: Lab) -> None:
    """A link from another site may open a page; it changes nothing."""
    answer = lab.operator.get("/api/health", headers={"sec-fetch-site": "cross-site"})
    assert answer.status_code == 200
