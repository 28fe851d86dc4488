"""Tests that the policy table and the routes agree."""

import pytest

from app.platform.policy import ANYONE, HEADSET, LAB, POLICY, TABLET
from tests.features.lab import Lab

NOT_OVER_HTTP = {
    "WEBSOCKET /api/vr/stream",
    "WEBSOCKET /api/vr/road",
    "WEBSOCKET /api/vr/trackers",
    "WEBSOCKET /api/vr/companion",
    "WEBSOCKET /api/vr/self-tests/storage",
    "WEBSOCKET /api/sessions/{session_id}/pose",
    "WEBSOCKET /api/trackers/performers/watch",
}


@pytest.mark.one_engine
def test_the_table_lists_every_route_and_nothing_else(lab: Lab) -> None:
    """The policy table lists exactly the routes that exist."""
    documented = {
        f"{method.upper()} {path}"
        for path, methods in lab.app.openapi()["paths"].items()
        for method in methods
    }
    assert set(POLICY) - NOT_OVER_HTTP == documented


def test_a_route_is_for_people_or_for_one_kind_of_device() -> None:
    """Every route is for anyone, for people of the lab, or for one kind of device."""
    for route, who in POLICY.items():
        assert who in (ANYONE, TABLET, HEADSET) or who <= LAB, route


def test_analysts_cannot_change_anything() -> None:
    """Analysts can call only routes that read, check, compute, export or set their own password."""
    trying = {
        "POST /api/avatars/model",
        "POST /api/studies/check",
        "POST /api/studies/edit",
        "POST /api/studies/timeline",
        "POST /api/studies/{key}/diff",
        "POST /api/instruments/check",
        "POST /api/instruments/score",
        "PUT /api/me/password",
        "POST /api/avatar-tunings/{tuning_id}/comparison",
        "POST /api/avatar-tunings/{tuning_id}/configuration",
        "POST /api/walking/paths",
        "POST /api/walking/models/{model_id}/prediction",
        "POST /api/walking/models/{model_id}/slice",
    }
    watching = {
        "WEBSOCKET /api/sessions/{session_id}/pose",
        "WEBSOCKET /api/trackers/performers/watch",
    }
    # A file for their own download, which the server creates and deletes.
    taking = {"POST /api/studies/{key}/exports", "DELETE /api/exports/{export_id}"}
    changing = (
        {route for route, who in POLICY.items() if "analyst" in who and not route.startswith("GET")}
        - watching
        - taking
    )
    assert changing == trying


@pytest.mark.one_engine
def test_schema_names_are_unique(lab: Lab) -> None:
    """No two schemas share a name, as a duplicate would rename both in generated clients."""
    shapes = lab.app.openapi()["components"]["schemas"]
    assert [name for name in shapes if "__" in name] == []
