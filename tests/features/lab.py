"""A running application in this process with a signed-in operator, for tests over HTTP."""

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
    """A running application; its client `operator` is signed in as admin by a bearer token."""

    app: FastAPI
    operator: TestClient

    @property
    def context(self) -> AppContext:
        """The context of the running application."""
        context = self.app.state.context
        assert isinstance(context, AppContext)
        return context

    @property
    def database(self) -> Database:
        """The application's database, for checks that bypass the interface."""
        return self.context.database

    def stranger(self) -> TestClient:
        """Return a client that is not signed in, with its own cookies and the same event loop."""
        client = TestClient(self.app)
        client.portal = self.operator.portal
        return client

    def try_join(self, **fields: Any) -> Response:
        """Request a new session and return the response, even if it is an error."""
        return self.operator.post(f"/api/studies/{STUDY}/sessions", json=fields)

    def join(self, **fields: Any) -> Json:
        """Create a session and return it as the cockpit shows it."""
        view: Json = ok(self.try_join(**fields))
        return view

    def view(self, session_id: str) -> Json:
        """Return the current state of a session as the cockpit shows it."""
        view: Json = ok(self.operator.get(f"/api/sessions/{session_id}"))
        return view

    def events(self, session_id: str) -> list[Json]:
        """Return the event log of a session."""
        events: list[Json] = ok(self.operator.get(f"/api/sessions/{session_id}/events"))
        return events

    def try_command(self, view: Json, kind: str, **fields: Any) -> Response:
        """Send a command that was decided on `view`; return the response, even an error."""
        body = {
            "command_id": str(uuid.uuid4()),
            "expected_version": view["version"],
            "type": kind,
            **fields,
        }
        return self.operator.post(f"/api/sessions/{view['id']}/commands", json=body)

    def command(self, view: Json, kind: str, **fields: Any) -> Json:
        """Send a command that must be accepted and return the session after it."""
        after: Json = ok(self.try_command(view, kind, **fields))
        return after

    def skip_to(self, view: Json, step_key: str) -> Json:
        """Start the session if it is planned, and skip every step before `step_key`."""
        if view["status"] == "planned":
            view = self.command(view, "start")
        while view["steps"][view["current"]["index"]]["key"] != step_key:
            view = self.command(view, "skip", reason="not in this test")
        return view

    def show_code(self, session_id: str, device: str) -> str:
        """Return a new pairing code."""
        path = f"/api/sessions/{session_id}/pairings"
        return str(ok(self.operator.post(path, json={"device": device}))["code"])

    def tablet(self, session_id: str) -> TestClient:
        """Return the client of a tablet that is paired with the session by its cookie."""
        client = self.stranger()
        ok(client.post("/api/devices/pair", json={"code": self.show_code(session_id, "tablet")}))
        return client

    def headset_token(self, session_id: str) -> str:
        """Pair a headset with the session and return its token."""
        code = self.show_code(session_id, "headset")
        return str(ok(self.stranger().post("/api/devices/pair", json={"code": code}))["token"])


def ok(response: Response) -> Any:
    """Return the JSON body of a response that must be successful."""
    assert response.is_success, response.text
    return response.json() if response.content else None


def error(response: Response, status: int, code: str) -> Json:
    """Return the error of a refused request, which must have this status and code."""
    assert response.status_code == status, response.text
    refusal: Json = response.json()["error"]
    assert refusal["code"] == code, refusal
    return refusal


@contextmanager
def running_lab(
    database_url: str, clock: Clock | None = None, data_dir: Path | None = None
) -> Iterator[Lab]:
    """Run the application on `database_url` for the duration of the block.

    Without a `data_dir` it uses a temporary data folder.
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
    """Return a new idempotency key."""
    return secrets.token_hex(16)
