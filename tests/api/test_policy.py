"""The policy table and the routes are the same list."""

import pytest

from app.platform.policy import ANYONE, HEADSET, LAB, POLICY, TABLET
from tests.features.lab import Lab

NOT_OVER_HTTP = {"WEBSOCKET /api/vr/stream", "WEBSOCKET /api/sessions/{session_id}/pose"}


@pytest.mark.one_engine
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
        "POST /api/walking/paths",
        "POST /api/walking/models/{model_id}/prediction",
        "POST /api/walking/models/{model_id}/slice",
    }
    watching = {"WEBSOCKET /api/sessions/{session_id}/pose"}
    # A file of their own to take away, which the server makes and removes.
    taking = {"POST /api/studies/{key}/exports", "DELETE /api/exports/{export_id}"}
    changing = (
        {route for route, who in POLICY.items() if "analyst" in who and not route.startswith("GET")}
        - watching
        - taking
    )
    assert changing == trying


@pytest.mark.one_engine
def test_no_two_shapes_share_a_name(lab: Lab) -> None:
    """A second one would rename the first for every generated client."""
    shapes = lab.app.openapi()["components"]["schemas"]
    assert [name for name in shapes if "__" in name] == []
