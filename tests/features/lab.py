"""A running application in this process, with an operator signed in, for tests over HTTP."""

import secrets
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fastapi import FastAPI
from fastapi.testclient import TestClient
from httpx2 import Response
from pydantic import SecretStr

from app.clock import Clock
from app.database import Database
from app.features.people.accounts import issue_token
from app.main import create_app
from app.models import Account
from app.platform.context import AppContext
from app.settings import Settings

STUDY = "reembodiment-latency"
PASSWORD = "correct horse battery"
Json = dict[str, Any]


@dataclass(frozen=True)
class Lab:
    """The application and its operator's calls. `operator` is signed in by a bearer token."""

    app: FastAPI
    operator: TestClient

    @property
    def context(self) -> AppContext:
        """The parts of the running application."""
        context = self.app.state.context
        assert isinstance(context, AppContext)
        return context

    @property
    def database(self) -> Database:
        """Its database, for looking behind the interface."""
        return self.context.database

    def stranger(self) -> TestClient:
        """A client with cookies of its own, not signed in, on the same event loop."""
        client = TestClient(self.app)
        client.portal = self.operator.portal
        return client

    def try_join(self, **fields: Any) -> Response:
        """Ask for a session."""
        return self.operator.post(f"/api/studies/{STUDY}/sessions", json=fields)

    def join(self, **fields: Any) -> Json:
        """A new session, as the cockpit shows it."""
        view: Json = ok(self.try_join(**fields))
        return view

    def view(self, session_id: str) -> Json:
        """The session now."""
        view: Json = ok(self.operator.get(f"/api/sessions/{session_id}"))
        return view

    def events(self, session_id: str) -> list[Json]:
        """The event log."""
        events: list[Json] = ok(self.operator.get(f"/api/sessions/{session_id}/events"))
        return events

    def try_command(self, view: Json, kind: str, **fields: Any) -> Response:
        """Send a command decided on `view`."""
        body = {
            "command_id": str(uuid.uuid4()),
            "expected_version": view["version"],
            "type": kind,
            **fields,
        }
        return self.operator.post(f"/api/sessions/{view['id']}/commands", json=body)

    def command(self, view: Json, kind: str, **fields: Any) -> Json:
        """Send a command that is accepted; the session after it."""
        after: Json = ok(self.try_command(view, kind, **fields))
        return after

    def skip_to(self, view: Json, step_key: str) -> Json:
        """Start the session if need be, and skip every step before `step_key`."""
        if view["status"] == "planned":
            view = self.command(view, "start")
        while view["steps"][view["current"]["index"]]["key"] != step_key:
            view = self.command(view, "skip", reason="not in this test")
        return view

    def show_code(self, session_id: str, device: str) -> str:
        """A fresh pairing code."""
        path = f"/api/sessions/{session_id}/pairings"
        return str(ok(self.operator.post(path, json={"device": device}))["code"])

    def tablet(self, session_id: str) -> TestClient:
        """A tablet that is paired with the session; its client holds the cookie."""
        client = self.stranger()
        ok(client.post("/api/devices/pair", json={"code": self.show_code(session_id, "tablet")}))
        return client

    def headset_token(self, session_id: str) -> str:
        """The token of a headset that is paired with the session."""
        code = self.show_code(session_id, "headset")
        return str(ok(self.stranger().post("/api/devices/pair", json={"code": code}))["token"])


def ok(response: Response) -> Any:
    """What a successful answer holds."""
    assert response.is_success, response.text
    return response.json() if response.content else None


def error(response: Response, status: int, code: str) -> Json:
    """The error of a refused request, which must have this status and code."""
    assert response.status_code == status, response.text
    refusal: Json = response.json()["error"]
    assert refusal["code"] == code, refusal
    return refusal


@contextmanager
def running_lab(
    database_url: str, clock: Clock | None = None, data_dir: Path | None = None
) -> Iterator[Lab]:
    """Start the application on `database_url` and stop it afterwards.

    Without a `data_dir` its data folder is one of its own, which goes with it.
    """
    with TemporaryDirectory(prefix="reembody-lab-") as own_folder:
        settings = Settings(
            database_url=database_url,
            data_dir=data_dir or Path(own_folder),
            admin_password=SecretStr(PASSWORD),
        )
        with _running(create_app(settings, clock=clock)) as lab:
            yield lab


@contextmanager
def _running(app: FastAPI) -> Iterator[Lab]:
    with TestClient(app) as operator:
        lab = Lab(app, operator)
        now = lab.context.clock.utc_now()
        with lab.database.writing() as db:
            admin = db.query(Account).filter_by(username="admin").one()
            login = issue_token(db, admin, purpose="script", now=now, hours=1.0)
        operator.headers["authorization"] = f"Bearer {login.token}"
        yield lab


def key() -> str:
    """A fresh idempotency key."""
    return secrets.token_hex(16)
