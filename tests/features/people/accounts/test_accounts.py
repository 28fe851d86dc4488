"""Tests of logging in and out, and of what is stored about it."""

import logging
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from fastapi.testclient import TestClient
from httpx2 import Response
from pydantic import SecretStr
from sqlalchemy import text

from app.clock import Clock
from app.errors import NotSignedIn
from app.features.people.accounts.service import issue_token
from app.main import create_app
from app.models import Account
from app.platform.tokens import account_of_token
from app.settings import Settings
from tests.features.lab import PASSWORD, STUDY, Lab, error, ok, running_lab


def log_in(client: TestClient, username: str = "admin", password: str = PASSWORD) -> Response:
    """Send a login request."""
    return client.post("/api/login", json={"username": username, "password": password})


def test_a_logins_cookie_authenticates_later_requests(lab: Lab) -> None:
    """The cookie of a login authenticates later requests."""
    client = lab.stranger()
    assert ok(log_in(client))["account"]["username"] == "admin"
    assert ok(client.get("/api/me"))["account"]["role"] == "admin"
    assert ok(client.get("/api/studies"))


@pytest.mark.one_engine
def test_a_new_client_is_not_signed_in(lab: Lab) -> None:
    """A client that has not logged in gets an empty account from `/api/me`, not an error."""
    assert ok(lab.stranger().get("/api/me")) == {"account": None}


@pytest.mark.one_engine
def test_a_wrong_password_and_an_unknown_user_get_the_same_answer(lab: Lab) -> None:
    """A wrong password and an unknown user name get the same answer, so names cannot be probed."""
    wrong = log_in(lab.stranger(), password="not this one")
    unknown = log_in(lab.stranger(), username="nobody")
    error(wrong, 401, "not_signed_in")
    assert (wrong.status_code, wrong.json()) == (unknown.status_code, unknown.json())
    assert "set-cookie" not in wrong.headers


@pytest.mark.one_engine
def test_the_cookie_is_out_of_reach_of_scripts_and_other_sites(lab: Lab) -> None:
    """The login cookie is HttpOnly and SameSite=Strict."""
    cookie = log_in(lab.stranger()).headers["set-cookie"].lower()
    assert cookie.startswith("reembody_login=")
    assert "httponly" in cookie
    assert "samesite=strict" in cookie


def test_logging_out_revokes_the_token_immediately(lab: Lab) -> None:
    """Logging out revokes the login's token immediately, also for a copy of the cookie."""
    client, thief = lab.stranger(), lab.stranger()
    log_in(client)
    thief.cookies.update(client.cookies)
    assert thief.get("/api/studies").status_code == 200
    assert client.post("/api/logout").status_code == 204
    error(thief.get("/api/studies"), 401, "not_signed_in")
    error(client.get("/api/studies"), 401, "not_signed_in")


def test_a_page_of_another_account_is_answered_nothing(lab: Lab) -> None:
    """A request of a page that shows another account than the cookie's is refused, not carried out.

    Nor is it told who else is signed in, as if it were that account's page.
    """
    client = lab.stranger()
    own = ok(log_in(client))["account"]["id"]
    sessions = "/api/studies/reembodiment-latency/sessions"
    before = ok(client.get(sessions))
    assert ok(client.get("/api/me", headers={"x-reembody-account": own}))["account"]["id"] == own
    other = {"x-reembody-account": "0" * 32}
    for answer in (
        client.get("/api/me", headers=other),
        client.get("/api/studies", headers=other),
        client.post(sessions, json={}, headers=other),
    ):
        refusal = error(answer, 409, "other_account")
        assert refusal["remedy"] == "Reload the page."
    assert ok(client.get(sessions)) == before


@pytest.mark.one_engine
def test_a_bearer_token_can_be_logged_out(lab: Lab) -> None:
    """Logging out with a bearer token revokes that token."""
    script = lab.stranger()
    script.headers["authorization"] = f"Bearer {_token(lab)}"
    assert script.get("/api/studies").status_code == 200
    script.post("/api/logout")
    error(script.get("/api/studies"), 401, "not_signed_in")


@pytest.mark.one_engine
def test_a_new_login_revokes_the_previous_one(lab: Lab) -> None:
    """Logging in again in the same browser revokes the previous login's token."""
    client, thief = lab.stranger(), lab.stranger()
    log_in(client)
    thief.cookies.update(client.cookies)
    log_in(client)
    error(thief.get("/api/studies"), 401, "not_signed_in")
    assert client.get("/api/studies").status_code == 200


def test_a_login_expires(lab: Lab) -> None:
    """A login's token is refused after its lifetime."""
    token, now = _token(lab), datetime.now(UTC)
    with lab.database.reading() as db:
        assert account_of_token(db, token, now).username == "admin"
        with pytest.raises(NotSignedIn):
            account_of_token(db, token, now + timedelta(hours=2))


def test_tokens_and_passwords_are_stored_as_hashes_only(lab: Lab) -> None:
    """The tables of accounts and logins contain hashes only, no token or password in clear text."""
    client = lab.stranger()
    log_in(client)
    with lab.database.reading() as db:
        tables = ("accounts", "login_tokens")
        stored = repr([db.execute(text(f"SELECT * FROM {table}")).all() for table in tables])  # noqa: S608 - our own tables
    assert client.cookies["reembody_login"] not in stored
    assert PASSWORD not in stored
    assert "$argon2id$" in stored


@pytest.mark.one_engine
def test_password_guessing_is_rate_limited(fresh_lab: Lab) -> None:
    """After ten wrong passwords even the right one is refused for a while."""
    client = fresh_lab.stranger()
    for _ in range(10):
        error(log_in(client, password="guess"), 401, "not_signed_in")
    refusal = error(log_in(client), 429, "too_many_attempts")
    assert refusal["remedy"].startswith("Wait ")


@pytest.mark.one_engine
def test_a_successful_login_resets_the_failed_attempts(fresh_lab: Lab) -> None:
    """A successful login resets the count of failed attempts."""
    client = fresh_lab.stranger()
    for _ in range(2):
        for _ in range(9):
            log_in(client, password="slip")
        ok(log_in(client))


@pytest.mark.one_engine
def test_a_first_start_generates_a_password_and_reports_it_once(
    database_url: str, tmp_path: Path
) -> None:
    """Without REEMBODY_ADMIN_PASSWORD the first start generates a password and reports it once."""
    reported: list[str] = []
    settings = Settings(data_dir=tmp_path, database_url=database_url, admin_password=None)
    for _ in range(2):
        with TestClient(create_app(settings, on_first_password=reported.append)) as client:
            assert len(reported) == 1
            ok(log_in(client, password=reported[0]))
    assert len(reported[0]) >= 16


@pytest.mark.one_engine
def test_a_configured_password_is_never_printed_or_logged(
    database_url: str, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """A password set by REEMBODY_ADMIN_PASSWORD is never printed or logged."""
    reported: list[str] = []
    secret = SecretStr(PASSWORD)
    settings = Settings(data_dir=tmp_path, database_url=database_url, admin_password=secret)
    with caplog.at_level(logging.DEBUG):
        app = create_app(settings, on_first_password=reported.append)
        with TestClient(app) as client:
            ok(log_in(client))
    assert reported == []
    assert PASSWORD not in caplog.text
    assert PASSWORD not in repr(settings)


def test_a_later_start_does_not_change_the_password(database_url: str, tmp_path: Path) -> None:
    """A later start with another REEMBODY_ADMIN_PASSWORD does not change the stored password."""
    with running_lab(database_url):
        pass
    other = SecretStr("another one")
    settings = Settings(data_dir=tmp_path, database_url=database_url, admin_password=other)
    with TestClient(create_app(settings)) as client:
        ok(log_in(client))
        error(log_in(client, password="another one"), 401, "not_signed_in")


def test_a_session_survives_a_restart(database_url: str) -> None:
    """A session is unchanged after the server has restarted."""
    with running_lab(database_url) as lab:
        view = lab.command(lab.join(), "start")
    with running_lab(database_url) as lab:
        after_restart = lab.view(view["id"])
    assert after_restart == view


def test_a_running_phase_is_paused_after_a_restart(database_url: str) -> None:
    """A phase that was running when the server stopped is paused when it starts again."""
    from app.features.record.sessions.engine.commands import Report
    from app.features.record.sessions.service import apply_command
    from app.platform.access import session_by_id

    with running_lab(database_url) as lab:
        view = lab.skip_to(lab.join(), "free_roam")
        lab.context.hub.headset_joined(view["id"])
        lab.command(view, "begin_phase")
        with lab.database.writing() as db:
            report = Report(what="started", phase_id=1, client_t_s=1.0, active_s=0.0)
            session = session_by_id(db, view["id"], lock=True)
            apply_command(db, lab.context, session, report, actor="headset")
    with running_lab(database_url) as lab:
        current = lab.view(view["id"])["current"]
    assert (current["status"], current["pause_reason"]) == ("paused", "server_restarted")


def test_settings_place_the_database_in_the_data_folder(tmp_path: Path) -> None:
    """Without a database URL the settings use a SQLite file in the data folder."""
    url = Settings(data_dir=tmp_path, database_url="").resolved_database_url
    assert url == f"sqlite:///{tmp_path.resolve()}/reembody.sqlite"


def test_timestamps_come_from_the_applications_clock(database_url: str) -> None:
    """Timestamps in the record come from the clock that was passed to the application."""
    then = datetime(2030, 1, 2, 3, 4, 5, tzinfo=UTC)
    with running_lab(database_url, Clock(utc_now=lambda: then)) as lab:
        assert lab.join()["created_at"] == "2030-01-02T03:04:05Z"


def _token(lab: Lab) -> str:
    with lab.database.writing() as db:
        admin = db.query(Account).filter_by(username="admin").one()
        now = datetime.now(UTC)
        return issue_token(db, admin, purpose="script", now=now, hours=1.0).token


def test_a_rehearsal_of_the_server_is_no_sign_in_of_the_person(fresh_lab: Lab) -> None:
    """Its login is neither counted nor the last one, and its actions say that it was a script."""
    lab = fresh_lab
    (before,) = ok(lab.operator.get("/api/accounts"))
    with lab.database.writing() as db:
        account = db.query(Account).filter_by(username="admin").one()
        later = Clock().utc_now() + timedelta(minutes=1)
        login = issue_token(db, account, purpose="tryout", now=later, hours=1.0)
    script = lab.stranger()
    script.headers["authorization"] = f"Bearer {login.token}"
    path = f"/api/studies/{STUDY}/sessions"
    session_id = ok(script.post(path, json={"kind": "simulated"}))["id"]
    view = ok(script.get(f"/api/sessions/{session_id}"))
    start = {
        "type": "start",
        "command_id": "the-script-starts",
        "expected_version": view["version"],
    }
    ok(script.post(f"/api/sessions/{session_id}/commands", json=start))
    (after,) = ok(lab.operator.get("/api/accounts"))
    assert (after["logins"], after["last_login_at"]) == (before["logins"], before["last_login_at"])
    assert {event["by"] for event in lab.events(session_id)} == {"script:admin"}
    ok(lab.operator.delete(f"/api/accounts/{after['id']}/logins"))
    error(script.get("/api/studies"), 401, "not_signed_in")
