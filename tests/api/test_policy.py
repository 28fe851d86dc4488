"""The policy table and the routes are the same list."""

from app.features.policy import ANYONE, HEADSET, LAB, POLICY, TABLET
from tests.features.lab import Lab

NOT_OVER_HTTP = {"WEBSOCKET /api/vr/stream"}


def test_the_table_lists_every_route_and_nothing_else(lab: Lab) -> None:
    """Whoever adds a route must say who may call it."""
    documented = {
        f"{method.upper()} {path}"
        for path, methods in lab.app.openapi()["paths"].items()
        for method in methods
    }
    assert set(POLICY) - NOT_OVER_HTTP == documented


def test_a_route_is_for_people_or_for_one_kind_of_device() -> None:
    """Nobody is let in twice by one table row."""
    for route, who in POLICY.items():
        assert who in (ANYONE, TABLET, HEADSET) or who <= LAB, route


def test_what_changes_something_is_closed_to_analysts() -> None:
    """Analysts read: by no method but GET, and where they only try something out."""
    trying = {
        "POST /api/studies/check",
        "POST /api/studies/edit",
        "POST /api/studies/timeline",
        "POST /api/studies/{key}/diff",
        "POST /api/instruments/check",
        "POST /api/instruments/score",
        "PUT /api/me/password",
    }
    changing = {
        route for route, who in POLICY.items() if "analyst" in who and not route.startswith("GET")
    }
    assert changing == trying
