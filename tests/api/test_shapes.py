"""Tests of properties of all answers: the shape of errors, headers and size limits."""

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
    """Errors of the product, of validation and of the framework have the same six fields."""
    assert set(error(lab.operator.request(method, path), status, code)) == SHAPE


@pytest.mark.one_engine
@pytest.mark.parametrize("body", [b"{", b"\xff\xfe", b'"text"', b"[" * 5000, b"", b"NaN"])
def test_an_invalid_json_body_is_refused(lab: Lab, body: bytes) -> None:
    """A body that is not valid JSON is refused in the common shape."""
    headers = {"content-type": "application/json"}
    answer = lab.operator.post("/api/studies/check", content=body, headers=headers)
    assert answer.status_code in (400, 422)
    assert set(answer.json()["error"]) == SHAPE


@pytest.mark.parametrize("name", ["%00", "a%00b", "%F0%9F%92%A9", "..", "' OR 1=1 --"])
def test_unusual_names_in_a_path_are_refused(lab: Lab, name: str) -> None:
    """An unusual name in a path is answered with 404 or 422 in the common shape."""
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
def test_internal_errors_have_the_same_shape(
    lab: Lab, raised: Exception, status: int, code: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An internal error is answered in the common shape without internal details."""

    reading = Database.reading

    def fail(database: Database) -> AbstractContextManager[Session]:
        # Only for the request: a failing background task would be reported from then on.
        if threading.current_thread().name.startswith("AnyIO"):
            raise raised
        return reading(database)

    monkeypatch.setattr(Database, "reading", fail)
    client = lab.stranger()
    # The test client would otherwise raise what a server answers with a 500.
    client._transport.raise_server_exceptions = False  # type: ignore[attr-defined]  # Starlette's own
    answer = client.get("/api/health")
    refusal = error(answer, status, code)
    assert set(refusal) == SHAPE
    assert "secret" not in answer.text
    assert "INSERT" not in answer.text


@pytest.mark.one_engine
def test_a_body_declared_as_too_large_is_refused(lab: Lab) -> None:
    """A body with a declared length above 2 MiB is refused."""
    answer = lab.operator.post("/api/studies/check", json={"yaml": "x" * (2 * 1024 * 1024)})
    assert error(answer, 413, "too_large")["valid"] == "at most 2097152 bytes"


@pytest.mark.one_engine
def test_a_streamed_body_is_limited(lab: Lab) -> None:
    """A streamed body without a declared length is refused at the same limit."""

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
        ("get", "/tablet", {"sec-fetch-site": "none"}),
        ("get", "/api/nothing", {}),
        ("post", "/api/logout", {"origin": "https://elsewhere.example"}),
        ("post", "/api/studies", {"content-length": "99999999"}),
    ],
)
def test_every_answer_carries_the_security_headers(
    lab: Lab, method: str, path: str, headers: dict[str, str]
) -> None:
    """Every answer has the security headers, including refusals outside of any route."""
    answer = lab.stranger().request(method, path, headers=headers)
    assert "default-src 'self'" in answer.headers["content-security-policy"]
    assert "frame-ancestors 'none'" in answer.headers["content-security-policy"]
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert answer.headers["referrer-policy"] == "no-referrer"


@pytest.mark.one_engine
def test_answers_of_the_interface_are_not_cached(lab: Lab) -> None:
    """Answers under /api are marked `no-store`."""
    assert lab.operator.get("/api/studies").headers["cache-control"] == "no-store"


def test_health_names_the_engine(lab: Lab) -> None:
    """The health check reports the database engine."""
    health = lab.stranger().get("/api/health").json()
    assert (health["status"], health["database"]) == ("ok", lab.database.engine.dialect.name)
