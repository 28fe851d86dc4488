"""People of every role, with access to one study and not to another."""

from dataclasses import dataclass

from fastapi.testclient import TestClient

from app.features.people.accounts import create_account, issue_token, set_studies
from tests.features.lab import STUDY, Json, Lab, ok

ROLES = ("admin", "experimenter", "operator", "analyst")
FOREIGN = "somebody-elses"


@dataclass(frozen=True)
class Place:
    """A study with a session in it."""

    key: str
    session_id: str


def sign_in(lab: Lab, role: str, *, studies: list[str] | None = None, name: str = "") -> TestClient:
    """Create a person with that role, for these studies or all, and return their client."""
    now = lab.context.clock.utc_now()
    with lab.database.writing() as db:
        name = name or f"{role}-{len(ok(lab.operator.get('/api/accounts')))}"
        account = create_account(db, username=name, password="a long password", role=role, now=now)
        set_studies(db, account, studies)
        token = issue_token(db, account, purpose="script", now=now, hours=1.0).token
    client = lab.stranger()
    client.headers["authorization"] = f"Bearer {token}"
    return client


def foreign_study(lab: Lab) -> Place:
    """Create a second study with a session, both unknown to the people of the first study."""
    request = {"key": FOREIGN}
    ok(lab.operator.post(f"/api/studies/{STUDY}/duplicate", json=request))
    view: Json = ok(lab.operator.post(f"/api/studies/{FOREIGN}/sessions", json={}))
    return Place(FOREIGN, view["id"])
