"""Logging in and out, and what is kept of it."""

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
from tests.features.lab import PASSWORD, Lab, error, ok, running_lab


def log_in(client: TestClient, username: str = "admin", password: str = PASSWORD) -> Response:
    """Try to log in."""
    return client.post("/api/login", json={"username": username, "password": password})


def test_a_login_opens_the_console(lab: Lab) -> None:
    """The cookie of a login is enough from then on."""
    client = lab.stranger()
    assert ok(log_in(client))["account"]["username"] == "admin"
    assert ok(client.get("/api/me"))["account"]["role"] == "admin"
    assert ok(client.get("/api/studies"))


@pytest.mark.one_engine
def test_nobody_is_signed_in_at_first(lab: Lab) -> None:
    """Asking who is there is no error."""
    assert ok(lab.stranger().get("/api/me")) == {"account": None}


@pytest.mark.one_engine
def test_a_wrong_password_and_an_unknown_user_get_the_same_answer(lab: Lab) -> None:
    """Nobody can find out which names exist."""
    wrong = log_in(lab.stranger(), password="not this one")
    unknown = log_in(lab.stranger(), username="nobody")
    error(wrong, 401, "not_signed_in")
    assert (wrong.status_code, wrong.json()) == (unknown.status_code, unknown.json())
    assert "set-cookie" not in wrong.headers


@pytest.mark.one_engine
def test_the_cookie_is_out_of_reach_of_scripts_and_other_sites(lab: Lab) -> None:
    """HttpOnly and SameSite=Strict."""
    cookie = log_in(lab.stranger()).headers["set-cookie"].lower()
    assert cookie.startswith("reembody_login=")
    assert "httponly" in cookie
    assert "samesite=strict" in cookie


def test_logging_out_ends_the_login_at_once(lab: Lab) -> None:
    """The token is worth nothing any more, also to who kept a copy."""
    client, thief = lab.stranger(), lab.stranger()
    log_in(client)
    thief.cookies.update(client.cookies)
    assert thief.get("/api/studies").status_code == 200
    assert client.post("/api/logout").status_code == 204
    error(thief.get("/api/studies"), 401, "not_signed_in")
    error(client.get("/api/studies"), 401, "not_signed_in")


@pytest.mark.one_engine
def test_a_script_can_log_its_token_out(lab: Lab) -> None:
    """A bearer token is revoked like a cookie."""
    script = lab.stranger()
    script.headers["authorization"] = f"Bearer {_token(lab)}"
    assert script.get("/api/studies").status_code == 200
    script.post("/api/logout")
    error(script.get("/api/studies"), 401, "not_signed_in")


@pytest.mark.one_engine
def test_a_new_login_ends_the_one_before(lab: Lab) -> None:
    """Logging in again on the same browser makes a new token and revokes the old."""
    client, thief = lab.stranger(), lab.stranger()
    log_in(client)
    thief.cookies.update(client.cookies)
    log_in(client)
    error(thief.get("/api/studies"), 401, "not_signed_in")
    assert client.get("/api/studies").status_code == 200


def test_a_login_expires(lab: Lab) -> None:
    """After its hours a token opens nothing."""
    token, now = _token(lab), datetime.now(UTC)
    with lab.database.reading() as db:
        assert account_of_token(db, token, now).username == "admin"
        with pytest.raises(NotSignedIn):
            account_of_token(db, token, now + timedelta(hours=2))


def test_no_token_and_no_password_is_stored_in_clear(lab: Lab) -> None:
    """The tables of accounts hold hashes only."""
    client = lab.stranger()
    log_in(client)
    with lab.database.reading() as db:
        tables = ("accounts", "login_tokens")
        stored = repr([db.execute(text(f"SELECT * FROM {table}")).all() for table in tables])  # noqa: S608 - our own tables
    assert client.cookies["reembody_login"] not in stored
    assert PASSWORD not in stored
    assert "$argon2id$" in stored


@pytest.mark.one_engine
def test_guessing_is_slowed_down(fresh_lab: Lab) -> None:
    """After ten wrong passwords even the right one has to wait."""
    client = fresh_lab.stranger()
    for _ in range(10):
        error(log_in(client, password="guess"), 401, "not_signed_in")
    refusal = error(log_in(client), 429, "too_many_attempts")
    assert refusal["remedy"].startswith("Wait ")


@pytest.mark.one_engine
def test_getting_it_right_forgets_the_wrong_ones(fresh_lab: Lab) -> None:
    """Nine slips, a login, and nine slips more do not shut anybody out."""
    client = fresh_lab.stranger()
    for _ in range(2):
        for _ in range(9):
            log_in(client, password="slip")
        ok(log_in(client))


@pytest.mark.one_engine
def test_a_first_start_makes_a_random_password_and_tells_it_once(
    database_url: str, tmp_path: Path
) -> None:
    """Without REEMBODY_ADMIN_PASSWORD each installation gets its own."""
    told: list[str] = []
    settings = Settings(data_dir=tmp_path, database_url=database_url, admin_password=None)
    for _ in range(2):
        with TestClient(create_app(settings, on_first_password=told.append)) as client:
            assert len(told) == 1
            ok(log_in(client, password=told[0]))
    assert len(told[0]) >= 16


@pytest.mark.one_engine
def test_a_given_password_is_not_told(
    database_url: str, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """With REEMBODY_ADMIN_PASSWORD nothing is printed or logged."""
    told: list[str] = []
    secret = SecretStr(PASSWORD)
    settings = Settings(data_dir=tmp_path, database_url=database_url, admin_password=secret)
    with caplog.at_level(logging.DEBUG):
        app = create_app(settings, on_first_password=told.append)
        with TestClient(app) as client:
            ok(log_in(client))
    assert told == []
    assert PASSWORD not in caplog.text
    assert PASSWORD not in repr(settings)


def test_a_later_start_does_not_change_the_password(database_url: str, tmp_path: Path) -> None:
    """The variable makes the first account; it never overwrites one."""
    with running_lab(database_url):
        pass
    other = SecretStr("another one")
    settings = Settings(data_dir=tmp_path, database_url=database_url, admin_password=other)
    with TestClient(create_app(settings)) as client:
        ok(log_in(client))
        error(log_in(client, password="another one"), 401, "not_signed_in")


def test_the_record_survives_a_restart(database_url: str) -> None:
    """Sessions are there again after the server was started anew."""
    with running_lab(database_url) as lab:
        view = lab.command(lab.join(), "start")
    with running_lab(database_url) as lab:
        again = lab.view(view["id"])
    assert again == view


def test_a_running_clock_is_paused_when_the_server_was_away(database_url: str) -> None:
    """A phase that ran when the server died is paused at its start, and says why."""
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
    """Without an address the embedded database is used."""
    url = Settings(data_dir=tmp_path, database_url="").resolved_database_url
    assert url == f"sqlite:///{tmp_path.resolve()}/reembody.sqlite"


def test_time_is_the_applications_own(database_url: str) -> None:
    """A clock that is handed in is what the record is stamped with."""
    then = datetime(2030, 1, 2, 3, 4, 5, tzinfo=UTC)
    with running_lab(database_url, Clock(utc_now=lambda: then)) as lab:
        assert lab.join()["created_at"] == "2030-01-02T03:04:05Z"


def _token(lab: Lab) -> str:
    with lab.database.writing() as db:
        admin = db.query(Account).filter_by(username="admin").one()
        now = datetime.now(UTC)
        return issue_token(db, admin, purpose="script", now=now, hours=1.0).token
