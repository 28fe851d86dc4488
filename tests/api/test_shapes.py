"""Answers of every kind: one shape of errors, the same headers, limits on size."""

import threading
from collections.abc import Iterator
from contextlib import AbstractContextManager
from json import JSONDecodeError

import pytest
from sqlalchemy.exc import DataError, IntegrityError, OperationalError
from sqlalchemy.orm import Session

from app.database import Database
from app.errors import DamagedValue, ReembodyError
from tests.features.lab import STUDY, Lab, error

SHAPE = {"code", "message", "value", "valid", "remedy", "details"}


@pytest.mark.parametrize(
    ("method", "path", "status", "code"),
    [
        ("get", "/api/nothing/here", 404, "not_found"),
        ("get", "/api/sessions/nobody", 404, "not_found"),
        ("get", f"/api/studies/{STUDY}/ledger?kind=martians", 422, "invalid_input"),
        ("delete", "/api/health", 405, "http"),
        ("post", "/api/login", 422, "invalid_input"),
    ],
)
def test_every_error_has_the_same_shape(
    lab: Lab, method: str, path: str, status: int, code: str
) -> None:
    """Ours, validation's and the framework's errors carry the same six fields."""
    assert set(error(lab.operator.request(method, path), status, code)) == SHAPE


@pytest.mark.one_engine
@pytest.mark.parametrize("body", [b"{", b"\xff\xfe", b'"text"', b"[" * 5000, b"", b"NaN"])
def test_a_body_that_is_no_json_is_refused(lab: Lab, body: bytes) -> None:
    """Broken JSON is the sender's fault and is told so."""
    headers = {"content-type": "application/json"}
    answer = lab.operator.post("/api/studies/check", content=body, headers=headers)
    assert answer.status_code in (400, 422)
    assert set(answer.json()["error"]) == SHAPE


@pytest.mark.parametrize("name", ["%00", "a%00b", "%F0%9F%92%A9", "..", "' OR 1=1 --"])
def test_odd_names_are_not_found(lab: Lab, name: str) -> None:
    """A name that no database could hold is just not there."""
    answer = lab.operator.get(f"/api/studies/{name}/ledger")
    assert answer.status_code in (404, 422)
    assert set(answer.json()["error"]) == SHAPE


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("raised", "status", "code"),
    [
        (OperationalError("INSERT", {}, Exception("disk full")), 503, "not_durable"),
        (JSONDecodeError("a secret", "INSERT", 0), 503, "not_durable"),
        (UnicodeDecodeError("utf-8", b"INSERT", 0, 1, "a secret"), 503, "not_durable"),
        (DamagedValue("INSERT a secret"), 503, "not_durable"),
        (DataError("INSERT", {}, Exception("too long")), 422, "invalid_input"),
        (IntegrityError("INSERT", {}, Exception("unique")), 409, "conflict"),
        (RuntimeError("a secret of the server"), 500, "error"),
        (ReembodyError("nan and bytes", value=[float("nan"), b"x"]), 500, "error"),
    ],
)
def test_what_breaks_inside_is_told_in_the_same_shape(
    lab: Lab, raised: Exception, status: int, code: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The answer is JSON with a remedy's place, and tells nothing of the inside."""

    reading = Database.reading

    def fail(database: Database) -> AbstractContextManager[Session]:
        # Only for the request: what runs in the background would count as failed from then on.
        if threading.current_thread().name.startswith("AnyIO"):
            raise raised
        return reading(database)

    monkeypatch.setattr(Database, "reading", fail)
    client = lab.stranger()
    # The test client would raise what a server answers with a 500.
    client._transport.raise_server_exceptions = False  # type: ignore[attr-defined]  # Starlette's own
    answer = client.get("/api/health")
    refusal = error(answer, status, code)
    assert set(refusal) == SHAPE
    assert "secret" not in answer.text
    assert "INSERT" not in answer.text


@pytest.mark.one_engine
def test_a_body_that_says_it_is_too_large_is_refused(lab: Lab) -> None:
    """More than 2 MiB are not even read."""
    answer = lab.operator.post("/api/studies/check", json={"yaml": "x" * (2 * 1024 * 1024)})
    assert error(answer, 413, "too_large")["valid"] == "at most 2097152 bytes"


@pytest.mark.one_engine
def test_a_body_that_does_not_say_its_length_is_counted(lab: Lab) -> None:
    """A stream is cut off at the same limit with the same answer."""

    def endless() -> Iterator[bytes]:
        for _ in range(64):
            yield b"x" * 65_536

    answer = lab.operator.post(
        "/api/studies/check", content=endless(), headers={"content-type": "application/json"}
    )
    error(answer, 413, "too_large")


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("method", "path", "headers"),
    [
        ("get", "/api/health", {}),
        ("get", "/", {}),
        ("get", "/tablet", {}),
        ("get", "/api/nothing", {}),
        ("post", "/api/logout", {"origin": "https://elsewhere.example"}),
        ("post", "/api/studies", {"content-length": "99999999"}),
    ],
)
def test_every_answer_carries_the_security_headers(
    lab: Lab, method: str, path: str, headers: dict[str, str]
) -> None:
    """Pages, data and refusals alike, also those that no route has seen."""
    answer = lab.stranger().request(method, path, headers=headers)
    assert "default-src 'self'" in answer.headers["content-security-policy"]
    assert "frame-ancestors 'none'" in answer.headers["content-security-policy"]
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert answer.headers["referrer-policy"] == "no-referrer"


@pytest.mark.one_engine
def test_nothing_of_the_interface_is_kept_by_caches(lab: Lab) -> None:
    """Answers under /api are no-store."""
    assert lab.operator.get("/api/studies").headers["cache-control"] == "no-store"


def test_health_names_the_engine(lab: Lab) -> None:
    """A monitor sees that the database answers, and which one it is."""
    health = lab.stranger().get("/api/health").json()
    assert (health["status"], health["database"]) == ("ok", lab.database.engine.dialect.name)
