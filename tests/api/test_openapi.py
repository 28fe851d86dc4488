"""Tests that send generated requests to every operation of the OpenAPI document.

No request may cause a server error, and every answer must fit the document.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, seed, settings
from schemathesis.checks import not_a_server_error
from schemathesis.core.result import Ok
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_headers_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from tests.faults.figures import note
from tests.features.lab import STUDY
from tests.features.movement.captures.files import walk_bvh
from tests.support.humanoid_files import humanoid_file
from tests.support.repetitions import usually
from tests.support.server import ADMIN_PASSWORD, LiveServer

pytestmark = pytest.mark.thorough

CHECKS = (
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_headers_conformance,
    response_schema_conformance,
)
EXAMPLES, MANY_EXAMPLES = usually(3, at_length=5), 400
NOT_CALLED = ("/live", "/api/logout", "/api/me/password", "/logins")
"""Endless streams, and operations that would end the login in use."""


@dataclass(frozen=True)
class Bench:
    """A running server with objects to request, and an admin's token."""

    server: LiveServer
    token: str
    session_id: str
    capture_id: str
    humanoid: str


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    """Yield a server with a session, a capture, a humanoid model and an admin's token."""
    with LiveServer(tmp_path_factory.mktemp("openapi")) as server, server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        token = client.cookies["reembody_login"]
        joined = client.post(f"/api/studies/{STUDY}/sessions", json={"kind": "test"})
        session_id = joined.raise_for_status().json()["id"]
        capture = client.post("/api/captures?name=walk.bvh", content=walk_bvh())
        capture_id = capture.raise_for_status().json()["id"]
        humanoid = client.post("/api/humanoids?name=figure.glb", content=humanoid_file())
        content_hash = humanoid.raise_for_status().json()["content_hash"]
        yield Bench(server, token, session_id, capture_id, content_hash)


def operations(bench: Bench) -> Iterator[Any]:
    """Yield every operation whose answer ends on its own."""
    schema = schemathesis.openapi.from_url(f"{bench.server.url}/api/openapi.json")
    for result in schema.get_all_operations():
        assert isinstance(result, Ok)
        operation = result.ok()
        if not operation.path.endswith(NOT_CALLED):
            yield operation


def use_existing_objects(case: Any, bench: Bench, count: int) -> None:
    """Use ids of existing objects in two of three requests, so that they are found."""
    if count % 3 and case.path_parameters:
        expected = {"key": STUDY, "session_id": bench.session_id, "number": 1}
        expected["content_hash"] = bench.humanoid
        expected["scene_key"] = "car-and-three-racks"
        if case.method != "DELETE":
            expected["capture_id"] = bench.capture_id
        if case.path.startswith("/api/instruments"):
            expected["key"] = "karas2020"
        if case.path.startswith("/api/avatars"):
            expected["key"] = "standard"
        case.path_parameters.update(
            {name: value for name, value in expected.items() if name in case.path_parameters}
        )


def run(bench: Bench, examples: int) -> Counter[str]:
    """Call every operation with generated requests; return the counts of requests and answers.

    Raises if an answer does not fit the document.
    """
    counted: Counter[str] = Counter()
    headers = {"authorization": f"Bearer {bench.token}"}
    for operation in operations(bench):
        counted["operations"] += 1

        @seed(20260302)
        @settings(
            max_examples=examples,
            deadline=None,
            database=None,
            phases=(Phase.generate,),
            suppress_health_check=list(HealthCheck),
        )
        @given(case=operation.as_strategy())
        def called(case: Any) -> None:
            counted["requests"] += 1
            use_existing_objects(case, bench, counted["requests"])
            answer = case.call_and_validate(headers=headers, checks=CHECKS, timeout=30.0)
            counted[f"answers {answer.status_code // 100}XX"] += 1

        called()
    return counted


def note_counts(counted: Counter[str]) -> None:
    """Add the counts to the table of measured figures."""
    for what, count in sorted(counted.items()):
        note(21, "made-up requests to every operation", what, count)


def test_generated_requests_get_documented_answers(bench: Bench) -> None:
    """No generated request causes a server error, and every answer fits the OpenAPI document."""
    counted = run(bench, EXAMPLES)
    note_counts(counted)
    assert counted["answers 5XX"] == 0
    assert counted["answers 2XX"] > counted["operations"] / 2


@pytest.mark.long
@pytest.mark.timeout(3600)
def test_many_generated_requests_get_documented_answers(bench: Bench, tmp_path: Path) -> None:
    """None of many generated requests causes a server error or an undocumented answer."""
    counted = run(bench, MANY_EXAMPLES)
    note_counts(counted)
    assert counted["answers 5XX"] == 0
