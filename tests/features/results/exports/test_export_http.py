"""Tests of exports and the codebook over HTTP."""

import io
import re
import zipfile

import pytest
from fastapi.testclient import TestClient

from app.features.results.analysis.codebook import CODEBOOK
from tests.features.builders import STUDY, SessionSpec, build_session
from tests.features.lab import Lab


@pytest.fixture(scope="module")
def client(lab: Lab) -> TestClient:
    """Return the operator of an application with two people's sessions and a simulated one."""
    with lab.database.writing() as db:
        build_session(db, SessionSpec("P-0001"))
        build_session(db, SessionSpec("P-0002"))
        build_session(db, SessionSpec("SIM-0001", kind="simulated"))
    return lab.operator


def test_the_export_is_a_zip_of_csv(client: TestClient) -> None:
    """An export is a ZIP of CSV files of people's sessions, with a generated file name."""
    answer = client.get(f"/api/studies/{STUDY}/export")
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "application/zip"
    name = rf"reembody_{STUDY}_people_\d{{4}}-\d\d-\d\d\.zip"
    disposition = answer.headers["content-disposition"]
    assert re.fullmatch(f'attachment; filename="{name}"', disposition)
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        assert archive.testzip() is None
        assert archive.read("sessions.csv").count(b"\n") == 3
        assert b"SIM-0001" not in archive.read("events.csv")


@pytest.mark.one_engine
def test_a_kind_can_be_requested(client: TestClient) -> None:
    """An export of simulated sessions contains no other sessions."""
    answer = client.get(f"/api/studies/{STUDY}/export", params={"kind": "simulated"})
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        assert b"P-0001" not in archive.read("sessions.csv")
        assert b"SIM-0001" in archive.read("sessions.csv")


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("path", "status"),
    [
        ("/api/studies/nothing/export", 404),
        ("/api/studies/..%2F..%2Fetc/export", 404),
        ("/api/studies/..%5C../export", 404),
        (f"/api/studies/{STUDY}/export?kind=../../etc", 422),
    ],
)
def test_unknown_studies_and_kinds_are_refused(client: TestClient, path: str, status: int) -> None:
    """An unknown study or kind in an export's address is refused, as is a path in it."""
    answer = client.get(path)
    assert answer.status_code == status
    assert answer.json()["error"]["message"]


@pytest.mark.one_engine
@pytest.mark.parametrize("what", ["export", "codebook"])
def test_export_and_codebook_need_a_login(lab: Lab, what: str) -> None:
    """The export and the codebook need a login."""
    assert lab.stranger().get(f"/api/studies/{STUDY}/{what}").status_code == 401


@pytest.mark.one_engine
def test_the_codebook_describes_every_column(client: TestClient) -> None:
    """The codebook over HTTP has every column; the codebook of an unknown study is not found."""
    answer = client.get(f"/api/studies/{STUDY}/codebook")
    assert [(row["table"], row["column"]) for row in answer.json()] == [
        (column.table, column.name) for column in CODEBOOK
    ]
    assert client.get("/api/studies/nothing/codebook").status_code == 404
