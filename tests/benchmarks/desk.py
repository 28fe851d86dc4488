"""Measure the calls of every console page for a study of a thousand participants.

The calls are read from the policy table, so a new one is measured automatically; those about
uploaded files, exports and imports are not, as the study has none. Limits: 100 ms at
the 95th percentile for each call, 300 ms for a login.
"""

import re
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx2
import numpy as np

from app.features.movement.avatar import SHIPPED
from app.platform.policy import POLICY
from tests.benchmarks.report import Figure, Report
from tests.benchmarks.thousand import fill_thousand, shipped_database
from tests.features.builders import STUDY
from tests.support.server import ADMIN_PASSWORD, LiveServer

PARTS = ("login", "pages")
PARTICIPANTS = 1000
REPEATS, LOGINS = 25, 20
CALL_LIMIT_MS, LOGIN_LIMIT_MS = 100.0, 300.0
NO_PAGE = (
    *("/live", "/export", "/access", "/rows", "/preflight", "/preregistration/report"),
    "/avatar-choices",
)
"""Streams and files, whose duration depends on their size, and what these sessions lack."""
KEYS = {"avatars": SHIPPED, "instruments": "karas2020", "studies": STUDY}
"""What `{key}` stands for, by the kind of thing."""
QUERIES = {
    "diff": {"from": "1", "to": "1"},
    "model": {"stature_m": "1.75"},
    "verification": {"avatars": "175cm"},
}
"""The parameters that a call needs, by the end of its path."""


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts on a real server."""
    report = Report("desk")
    with tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch:
        server = LiveServer(Path(scratch))
        session_ids = _fill(server)
        with server, server.client() as client:
            if "login" in parts:
                report.add(*_login(client))
            else:
                _log_in(client)
            if "pages" in parts:
                for name, call in _calls(client, session_ids):
                    report.add(*_timed(name, call))
    return report


def _fill(server: LiveServer) -> list[str]:
    database = shipped_database(server.data_dir)
    session_ids = fill_thousand(database, PARTICIPANTS)
    database.close()
    return session_ids


def _log_in(client: httpx2.Client) -> None:
    credentials = {"username": "admin", "password": ADMIN_PASSWORD}
    client.post("/api/login", json=credentials).raise_for_status()


def _login(client: httpx2.Client) -> Iterator[Figure]:
    times_ms = [_took_ms(lambda: _log_in(client)) for _ in range(LOGINS)]
    yield Figure("login", "p95", _p95(times_ms), "ms", "limit", LOGIN_LIMIT_MS)


def _calls(
    client: httpx2.Client, session_ids: list[str]
) -> Iterator[tuple[str, Callable[[], None]]]:
    """Return every call that reads, each on another session every time, and the editor's calls."""
    turn = iter(range(10**9))

    def get(template: str) -> Callable[[], None]:
        kind, end = template.split("/")[2], template.rsplit("/", 1)[-1]
        fixed = template.replace("{key}", KEYS.get(kind, "")).replace("{number}", "1")

        def call() -> None:
            path = fixed.replace("{session_id}", session_ids[next(turn) % len(session_ids)])
            client.get(path, params=QUERIES.get(end)).raise_for_status()

        return call

    yaml = client.get(f"/api/studies/{STUDY}").raise_for_status().json()["yaml"]

    def post(path: str, body: dict[str, object]) -> Callable[[], None]:
        def call() -> None:
            client.post(path, json=body).raise_for_status()

        return call

    for name, who in sorted(POLICY.items()):
        method, template = name.split()
        if method == "GET" and "admin" in who and _is_measured(template):
            yield template.removeprefix("/api"), get(template)
    yield "editor: check", post("/api/studies/check", {"yaml": yaml})
    yield "editor: timeline", post("/api/studies/timeline", {"yaml": yaml})


def _is_measured(template: str) -> bool:
    places = set(re.findall(r"{(\w+)}", template))
    return places <= {"key", "number", "session_id"} and not template.endswith(NO_PAGE)


def _timed(name: str, call: Callable[[], None]) -> Iterator[Figure]:
    first_ms = _took_ms(call)
    call()
    times_ms = [_took_ms(call) for _ in range(REPEATS)]
    yield Figure("pages", f"{name} p95", _p95(times_ms), "ms", "limit", CALL_LIMIT_MS)
    if first_ms > CALL_LIMIT_MS:
        yield Figure("pages", f"{name} the first time", first_ms, "ms")


def _took_ms(call: Callable[[], None]) -> float:
    began_s = time.perf_counter()
    call()
    return 1000.0 * (time.perf_counter() - began_s)


def _p95(times_ms: list[float]) -> float:
    return float(np.percentile(times_ms, 95))
