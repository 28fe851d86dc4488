"""Tests of every route for every role, on own and foreign objects (fault 33).

A leak is an answer that is not refused although the table refuses it, or a foreign object that is
answered differently from one that does not exist.
"""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from fastapi.testclient import TestClient
from httpx2 import Response

from app.platform.policy import ANYONE, HEADSET, POLICY, TABLET
from tests.api.people import ROLES, Place, foreign_study, sign_in
from tests.faults.figures import note
from tests.features.lab import STUDY, Lab

ROUTES = sorted(name for name in POLICY if not name.startswith("WEBSOCKET"))
ENDLESS = "/live"
NOWHERE = Place("never-there", "0" * 32)
OTHER_IDS = "f" * 32


@dataclass(frozen=True)
class Bench:
    """People and devices, and the studies that they may or may not access."""

    lab: Lab
    people: dict[str, TestClient]
    devices: dict[str, TestClient]
    nobody: TestClient
    own: Place
    foreign: Place


@pytest.fixture(scope="module")
def bench(lab: Lab) -> Bench:
    """Return one person of each role for one study, and a tablet and a headset of its session."""
    own = Place(STUDY, lab.join()["id"])
    foreign = foreign_study(lab)
    headset = lab.stranger()
    headset.headers["authorization"] = f"Bearer {lab.headset_token(own.session_id)}"
    return Bench(
        lab,
        {role: sign_in(lab, role, studies=[STUDY]) for role in ROLES},
        {"tablet": lab.tablet(own.session_id), "headset": headset},
        lab.stranger(),
        own,
        foreign,
    )


def call(client: TestClient, route: str, place: Place) -> Response:
    """Call a route on the objects of a place, with an empty body."""
    method, template = route.split()
    path = template.replace("{session_id}", place.session_id)
    if template.startswith("/api/studies/{key}"):
        path = path.replace("{key}", place.key)
    path = path.replace("{number}", "1")
    return client.request(method, re.sub(r"\{\w+\}", OTHER_IDS, path), json={})


def of_a_study(route: str) -> bool:
    """Return whether the route's path names an object of a study."""
    return "/api/studies/{key}" in route or "{session_id}" in route


def outsiders(bench: Bench, route: str) -> Iterator[tuple[str, TestClient]]:
    """Yield an anonymous client, and the devices that may not call the route."""
    yield "nobody", bench.nobody
    for name, client in bench.devices.items():
        if POLICY[route] != {name}:
            yield name, client


@pytest.mark.one_engine
def test_every_route_follows_the_policy_table(bench: Bench) -> None:
    """Every route refuses strangers with 401, wrong roles with 403 and foreign objects with 404."""
    leaks: list[str] = []
    counts: Counter[str] = Counter()
    for route in ROUTES:
        if POLICY[route] == ANYONE:
            continue
        for name, client in outsiders(bench, route):
            counts["stranger"] += 1
            if call(client, route, bench.own).status_code != 401:
                leaks.append(f"{name}: {route}")
        for role, client in bench.people.items():
            leaks += [f"{role}: {leak}" for leak in leaks_of(bench, role, client, route, counts)]
    for what, count in sorted(counts.items()):
        note(33, "every route x role x object", f"asked: {what}", count)
    note(33, "every route x role x object", "leaks", len(leaks))
    assert leaks == []
    assert sum(counts.values()) >= 4 * len(ROUTES)


def leaks_of(
    bench: Bench, role: str, client: TestClient, route: str, counts: Counter[str]
) -> Iterator[str]:
    """Yield a description of each answer to a person that contradicts the policy table."""
    if role not in POLICY[route]:
        counts["wrong role"] += 1
        expected = 401 if POLICY[route] in (TABLET, HEADSET) else 403
        if call(client, route, bench.own).status_code != expected:
            yield f"{route} in spite of the role"
        return
    if not of_a_study(route):
        return
    counts["foreign object"] += 1
    there, never = call(client, route, bench.foreign), call(client, route, NOWHERE)
    reported = there.text.replace(bench.foreign.session_id, "?").replace(bench.foreign.key, "?")
    untold = never.text.replace(NOWHERE.session_id, "?").replace(NOWHERE.key, "?")
    if there.status_code != 404 or reported != untold:
        yield f"{route} of a foreign study: {there.status_code}"
    if not route.endswith(ENDLESS):
        counts["own object"] += 1
        if call(client, route, bench.own).status_code in (401, 403):
            yield f"{route} is refused although the table allows it"


def test_the_list_of_studies_has_own_studies_only(bench: Bench) -> None:
    """A person's list of studies has only those they may access."""
    for role, client in bench.people.items():
        listed = client.get("/api/studies").json()
        assert [study["key"] for study in listed] == [STUDY], role


@pytest.mark.one_engine
def test_an_unlisted_route_is_closed(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """A route that is not in the policy table is refused to everyone, even admins."""
    monkeypatch.delitem(POLICY, "GET /api/studies")
    assert bench.lab.operator.get("/api/studies").status_code == 403
