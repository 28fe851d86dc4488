"""Tests of exports as files: made in a process, downloaded in parts, cancelled, expired."""

import hashlib
import io
import json
import os
import time
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import select

from app.features.results.exports.export_queue import ExportQueue
from app.features.results.exports.jobs import KEEP_FOR
from app.features.results.exports.writing.service import study_archive
from app.models import CopyMade, TelemetryChunk
from app.wire import BODY_STREAMS
from tests.api.people import sign_in
from tests.features.builders import STUDY, SessionSpec, build_session
from tests.features.lab import Json, Lab, error, ok, running_lab
from tests.features.movement_builders import moving_values, store_chunks
from tests.features.results.exports.stuck import never_done
from tests.support.sqlite import fresh_sqlite

FRAMES = 900
WITHIN_S = 240.0


@pytest.fixture
def site(database_url: str, tmp_path: Path) -> Iterator[Lab]:
    """Yield an application with two people's sessions, one with movement, on each engine."""
    with running_lab(database_url, data_dir=tmp_path) as lab:
        _fill(lab)
        yield lab


@pytest.fixture
def small_site(tmp_path: Path) -> Iterator[Lab]:
    """Yield an application with two people's sessions, on SQLite only."""
    with running_lab(fresh_sqlite(tmp_path / "reembody.sqlite"), data_dir=tmp_path) as lab:
        _fill(lab)
        yield lab


def _fill(lab: Lab) -> None:
    with lab.database.writing() as db:
        first = build_session(db, SessionSpec("P-0001"))
        build_session(db, SessionSpec("P-0002"))
        for seed, stream in enumerate(BODY_STREAMS):
            store_chunks(db, first.id, stream, range(FRAMES), moving_values(FRAMES, seed))


def _order(client: TestClient, **fields: object) -> Json:
    body = {"kind": "people", **fields}
    made: Json = ok(client.post(f"/api/studies/{STUDY}/exports", json=body))
    return made


def _until(client: TestClient, export_id: str, *states: str) -> Json:
    give_up_s = time.monotonic() + WITHIN_S
    while time.monotonic() < give_up_s:
        view: Json = ok(client.get(f"/api/exports/{export_id}"))
        if view["state"] in states:
            return view
        time.sleep(0.05)
    raise AssertionError(f"the export is still {view['state']}")


def _folder(lab: Lab) -> list[str]:
    folder = lab.context.part(ExportQueue).folder
    return sorted(path.name for path in folder.iterdir()) if folder.is_dir() else []


def _copies(lab: Lab) -> list[CopyMade]:
    with lab.database.reading() as db:
        return list(db.scalars(select(CopyMade).where(CopyMade.kind == "export")))


def test_an_export_file_is_downloaded_whole_or_in_parts(site: Lab) -> None:
    """An export file contains the same members as the stream, and can be downloaded in parts."""
    client = site.operator
    ordered = _order(client)
    done = _until(client, ordered["id"], "ready", "failed")
    assert (done["state"], done["sessions"], done["rows"]) == ("ready", 2, FRAMES), done
    assert done["file_name"] == f"reembody_{STUDY}_people_{ordered['asked_at'][:10]}.zip"
    assert not _copies(site)
    whole = client.get(f"/api/exports/{done['id']}/file")
    assert whole.headers["content-length"] == str(done["bytes"])
    assert done["file_name"] in whole.headers["content-disposition"]
    assert hashlib.sha256(whole.content).hexdigest() == done["sha256"]
    # A browser resumes an interrupted download if the file is unchanged.
    half = len(whole.content) // 2
    headers = {"range": f"bytes={half}-", "if-range": whole.headers["etag"]}
    rest = client.get(f"/api/exports/{done['id']}/file", headers=headers)
    assert (rest.status_code, rest.content) == (206, whole.content[half:])
    now = site.context.clock.utc_now()
    streamed = b"".join(study_archive(site.database, STUDY, "people", now=now))
    with (
        zipfile.ZipFile(io.BytesIO(whole.content)) as made,
        zipfile.ZipFile(io.BytesIO(streamed)) as existing,
    ):
        assert made.testzip() is None
        assert made.namelist() == existing.namelist()
        for name in set(made.namelist()) - {"README.txt"}:
            assert made.read(name) == existing.read(name), name
    # It is recorded once, however often it is downloaded.
    assert [(copy.sessions, copy.bytes) for copy in _copies(site)] == [(2, done["bytes"])]


def test_tables_without_movement_are_those_of_the_whole_export(small_site: Lab) -> None:
    """An export of the tables alone has the same tables, and leaves out what reads the frames."""
    client, files = small_site.operator, {}
    for movement in (True, False):
        done = _until(client, _order(client, movement=movement)["id"], "ready", "failed")
        data = client.get(f"/api/exports/{done['id']}/file").content
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            files[movement] = {name: archive.read(name) for name in archive.namelist()}
    left_out = {name.partition("/")[0] for name in files[True].keys() - files[False].keys()}
    assert left_out == {"samples", "receipts"}
    for name in files[False].keys() - {"README.txt"}:
        assert files[False][name] == files[True][name], name


def test_receipts_count_what_was_written_as_if_they_had_read_it(small_site: Lab) -> None:
    """The receipts of an export, damaged chunks included, are those that read every frame anew."""
    client = small_site.operator
    with small_site.database.writing() as db:
        second = select(TelemetryChunk).order_by(TelemetryChunk.seq_first.desc()).limit(1)
        damaged = db.scalars(second).one()
        damaged.data = damaged.data[:-1] + b"?"
    done = _until(client, _order(client)["id"], "ready", "failed")
    data = client.get(f"/api/exports/{done['id']}/file").content
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        names = [name for name in archive.namelist() if name.startswith("receipts/")]
        exported = {one["session_id"]: one for one in map(json.loads, map(archive.read, names))}
    assert len(exported) == 2
    for session_id, receipt in exported.items():
        assert ok(client.get(f"/api/sessions/{session_id}/receipt")) == receipt
    assert sum(one["damaged"] for it in exported.values() for one in it["streams"]) > 0


def test_an_export_of_one_session_is_visible_to_its_owner_only(small_site: Lab) -> None:
    """An export of one session contains no other session and is visible only to its owner."""
    client = small_site.operator
    sessions = ok(client.get(f"/api/studies/{STUDY}/sessions"))
    one = next(row for row in sessions if row["participant_code"] == "P-0002")
    done = _until(client, _order(client, session_id=one["id"])["id"], "ready", "failed")
    assert "_P-0002_" in done["file_name"]
    data = client.get(f"/api/exports/{done['id']}/file").content
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert b"P-0001" not in b"".join(archive.read(name) for name in archive.namelist())
        assert b"P-0002" in archive.read("sessions.csv")
    body = {"kind": "simulated", "session_id": one["id"]}
    error(client.post(f"/api/studies/{STUDY}/exports", json=body), 404, "not_found")
    # A colleague of the same study gets the error for what does not exist.
    colleague = sign_in(small_site, "admin")
    assert ok(colleague.get("/api/exports")) == []
    for method, path in (("GET", ""), ("GET", "/file"), ("DELETE", "")):
        answer = colleague.request(method, f"/api/exports/{done['id']}{path}")
        error(answer, 404, "not_found")
    # It is deleted two hours after its last download.
    job = small_site.context.part(ExportQueue).find(_account(client), done["id"])
    assert job.fetched_at is not None
    job.fetched_at -= KEEP_FOR
    assert ok(client.get("/api/exports")) == []
    assert _folder(small_site) == []


def test_a_cancelled_export_ends_immediately(
    small_site: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A cancelled export's process and file are removed, and the next one in the queue is made."""
    client = small_site.operator
    with monkeypatch.context() as patched:
        patched.setattr("app.features.results.exports.export_queue.make_archive", never_done)
        stuck = _order(client)
        # Requested again while it is being made, it is the same export.
        assert _order(client)["id"] == stuck["id"]
        pid_file = small_site.context.part(ExportQueue).folder / f"{stuck['id']}.pid"
        give_up_s = time.monotonic() + WITHIN_S
        while not pid_file.exists() and time.monotonic() < give_up_s:
            time.sleep(0.05)
    waiting = _order(client, kind="all")
    assert waiting["state"] == "queued"
    error(client.get(f"/api/exports/{stuck['id']}/file"), 409, "not_now")
    ok(client.delete(f"/api/exports/{stuck['id']}"))
    pid = int(pid_file.read_text())
    pid_file.unlink()
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)
    assert not [name for name in _folder(small_site) if name.startswith(stuck["id"])]
    error(client.get(f"/api/exports/{stuck['id']}"), 404, "not_found")
    assert _until(client, waiting["id"], "ready", "failed")["state"] == "ready"


def test_an_erasure_deletes_export_files(small_site: Lab) -> None:
    """Erasing a participant of the study deletes its export files."""
    client = small_site.operator
    done = _until(client, _order(client)["id"], "ready")
    people = ok(client.get(f"/api/studies/{STUDY}/participants"))
    path = f"/api/studies/{STUDY}/participants/{people[0]['id']}/erasure"
    ok(client.post(path, json={"confirm": people[0]["code"], "reason_code": "requested"}))
    error(client.get(f"/api/exports/{done['id']}/file"), 404, "not_found")
    assert _folder(small_site) == []


def test_an_export_fails_if_the_disk_is_nearly_full(small_site: Lab) -> None:
    """An export fails with a remedy if it would leave running sessions too little disk space."""
    small_site.context.part(ExportQueue).keep_free_bytes = 2**60
    client = small_site.operator
    failed = _until(client, _order(client)["id"], "ready", "failed")
    assert failed["state"] == "failed"
    assert "running sessions" in failed["trouble"]["message"]
    assert "Storage" in failed["trouble"]["remedy"]
    assert _folder(small_site) == []


def _account(client: TestClient) -> str:
    return str(ok(client.get("/api/me"))["account"]["id"])
