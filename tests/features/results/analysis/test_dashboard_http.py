"""Tests of the dashboard over HTTP."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from pydantic import SecretStr

from app.features.results.analysis import Drawings
from app.main import create_app
from app.platform.context import AppContext
from app.settings import Settings
from tests.features.builders import STUDY, SessionSpec, build_session
from tests.features.results.analysis.workers import InlineWorker
from tests.support.sqlite import fresh_sqlite


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[TestClient]:
    """Yield a signed-in client of an application with two simulated sessions, for a module."""
    with _signed_in(tmp_path_factory.mktemp("dashboard")) as client:
        yield client


@pytest.fixture
def own_client(tmp_path: Path) -> Iterator[TestClient]:
    """Yield a signed-in client of an application with two simulated sessions, for one test."""
    with _signed_in(tmp_path) as client:
        yield client


@contextmanager
def _signed_in(folder: Path) -> Iterator[TestClient]:
    secret = SecretStr("secret-words")
    settings = Settings(
        data_dir=folder, database_url=fresh_sqlite(folder / "a.sqlite"), admin_password=secret
    )
    app = create_app(settings)
    with TestClient(app) as client:
        with app.state.context.database.writing() as db:
            build_session(db, SessionSpec("SIM-0001", kind="simulated"))
            build_session(db, SessionSpec("SIM-0002", kind="simulated"))
        login = {"username": "admin", "password": "secret-words"}
        assert client.post("/api/login", json=login).status_code == 200
        yield client


def test_a_dashboard_has_the_documented_fields(client: TestClient) -> None:
    """A dashboard has exactly the documented fields, each figure with a plot or a sentence."""
    view = client.get(f"/api/studies/{STUDY}/dashboard", params={"kind": "simulated"}).json()
    about = {"kind", "simulated", "n_sessions", "n_running", "n_completed", "n_not_valid"}
    assert set(view) == about | {"avatar", "drawn_at", "current", "figures", "filter", "choices"}
    assert (view["kind"], view["simulated"], view["n_completed"]) == ("simulated", True, 2)
    for entry in view["figures"]:
        words = {"key", "title", "caption", "empty", "n", "group", "wide", "measure"}
        assert set(entry) == words | {"figure"}
        assert (entry["figure"] is None) != (entry["empty"] is None)
        assert entry["figure"] is None or set(entry["figure"]) == {"data", "layout"}


def test_filtered_figures_rows_and_statistics_over_http(client: TestClient) -> None:
    """Filtered figures, their rows as CSV and the statistics can be requested over HTTP.

    Rows are recorded as a copy, and repeated requests get the cached drawing.
    """
    path = f"/api/studies/{STUDY}/dashboard"
    query = {"kind": "simulated", "participant": ["SIM-0002"], "limb": "hand"}
    view = client.get(path, params=query).json()
    assert (view["n_sessions"], view["filter"]["participant"]) == (1, ["SIM-0002"])
    assert client.get(path, params=query).json()["drawn_at"] == view["drawn_at"]
    assert client.get(path, params={"limbs": "hand"}).status_code == 422
    assert client.get(path, params={"since": "yesterday"}).status_code == 422

    rows = client.get(f"{path}/completions/rows", params=query)
    assert rows.headers["content-type"] == "text/csv; charset=utf-8"
    assert "_completions_simulated_" in rows.headers["content-disposition"]
    assert b"SIMULATED DATA" in rows.content
    assert b"SIM-0002" in rows.content
    assert b"SIM-0001" not in rows.content
    copies = client.get(f"/api/studies/{STUDY}/copies").json()
    assert any("rows of the figure completions" in copy["place"] for copy in copies)
    refused = client.get(f"{path}/nothing/rows", params=query)
    assert refused.status_code == 404
    assert "completions" in refused.text

    tested = f"/api/studies/{STUDY}/statistics"
    found = client.get(tested, params={"kind": "simulated"}).json()
    assert (found["simulated"], found["n_completed"], found["declared"]) == (True, 2, False)
    assert {"karas2020_agency", "contact_time"} <= {one["key"] for one in found["measures"]}
    assert client.get(tested, params={"kind": "simulated"}).json()["drawn_at"] == found["drawn_at"]


def test_one_group_of_figures_can_be_requested(client: TestClient) -> None:
    """One group of figures can be requested; an unknown group is refused."""
    path = f"/api/studies/{STUDY}/dashboard"
    query = {"kind": "simulated", "group": "tasks"}
    view = client.get(path, params=query).json()
    assert {one["group"] for one in view["figures"]} == {"tasks"}
    assert (view["n_sessions"], view["filter"]["limb"]) == (2, None)
    assert view["choices"]["limbs"] == ["hand", "foot"]
    assert client.get(path, params={**query, "group": "colours"}).status_code == 422


def test_a_dashboard_shows_people_unless_another_kind_is_requested(client: TestClient) -> None:
    """A dashboard shows sessions of people by default and refuses all kinds together."""
    path = f"/api/studies/{STUDY}/dashboard"
    assert client.get(path).json()["n_sessions"] == 0
    assert client.get(path, params={"kind": "all"}).status_code == 422


def test_a_dashboard_needs_a_login(client: TestClient) -> None:
    """A dashboard needs a login, and is not found for an unknown study."""
    assert client.get("/api/studies/nothing/dashboard").status_code == 404
    stranger = TestClient(client.app)
    stranger.portal = client.portal
    assert stranger.get(f"/api/studies/{STUDY}/dashboard").status_code == 401


def _context(client: TestClient) -> AppContext:
    """Return the context of the application that a client talks to."""
    assert isinstance(client.app, FastAPI)
    context: AppContext = client.app.state.context
    return context


def test_the_previous_figures_are_sent_while_new_ones_are_drawn(own_client: TestClient) -> None:
    """While new data are drawn, requests get the previous figures, marked as not current."""
    path, people = f"/api/studies/{STUDY}/dashboard", {"kind": "people"}
    assert own_client.get(path, params=people).json()["current"] is True
    with _context(own_client).database.writing() as db:
        build_session(db, SessionSpec("P-0001"))
    older = own_client.get(path, params=people).json()
    deadline = time.monotonic() + 60.0
    while not (view := own_client.get(path, params=people).json())["current"]:
        assert time.monotonic() < deadline
        time.sleep(0.05)
    assert (older["current"], older["n_sessions"]) in ((False, 0), (True, 1))
    assert view["n_sessions"] == 1


def test_figures_forget_an_erased_participant(own_client: TestClient) -> None:
    """After an erasure no cached figures contain the participant, not even outdated ones."""
    drawings = _context(own_client).part(Drawings)
    drawings._worker = InlineWorker()
    path, query = f"/api/studies/{STUDY}/dashboard", {"kind": "simulated", "group": "progress"}
    assert b"SIM-0002" in own_client.get(path, params=query).content
    people = own_client.get(f"/api/studies/{STUDY}/participants").json()
    [id_] = [one["id"] for one in people if one["code"] == "SIM-0002"]
    body = {"confirm": "SIM-0002", "reason_code": "withdrawn"}
    erased = own_client.post(f"/api/studies/{STUDY}/participants/{id_}/erasure", json=body)
    assert erased.status_code == 201
    found = own_client.get(path, params=query)
    assert found.json()["current"] is True
    assert b"SIM-0002" not in found.content
