"""Tests of storing and listing self-tests, and of the body and the socket that they use."""

import json
import re
import time
from collections.abc import Callable
from contextlib import ExitStack
from datetime import timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from httpx2 import Response
from sqlalchemy import func, select

from app.features.record.self_tests.storage import BURST_BYTES, BYTES_PER_S, PLANNED_S, Allowance
from app.features.record.self_tests.verdicts import RULES
from app.features.record.telemetry import (
    NO_SESSION,
    Arrival,
    TelemetryWriter,
    TrialContent,
    TrialEnd,
    stop_running_clocks,
)
from app.features.record.telemetry.writer import ServerSender
from app.features.results.exports.writing import export_study
from app.models import HeadsetTest, HeadsetTestBatch, SessionEvent, TelemetryBatch, TelemetryStream
from app.wire import BODY_STREAMS, StreamName, decode_batch
from tests.api.people import sign_in
from tests.features.lab import STUDY, Json, Lab, error, ok
from tests.features.movement.avatar.test_avatars import CAST, new
from tests.features.movement.avatar.test_studies import KEY, study
from tests.features.record.self_tests.reports import TRACKED, report
from tests.features.results.exports.whole import rows_of
from tests.wire.samples import RATE_HZ, message, standing

PATH = "/api/vr/self-tests"
SOCKET = f"{PATH}/storage"
PER_BATCH = 9
PATIENCE_S = 60.0
TARGET = BODY_STREAMS[0]
FRONTEND = Path(__file__).parents[4] / "frontend"


def bearer(token: str) -> dict[str, str]:
    """Return the header with a headset's token."""
    return {"authorization": f"Bearer {token}"}


def send(lab: Lab, token: str, body: Json) -> Response:
    """Send the report of a self-test as a paired headset."""
    return lab.stranger().post(PATH, json=body, headers=bearer(token))


def batch(index: int, stream: StreamName = TARGET, **fields: Any) -> bytes:
    """Return the batch of this number, of nine frames."""
    numbers = {"epoch": 1, "phase_id": 0, "seq_first": index * PER_BATCH, **fields}
    times_s = (index * PER_BATCH + np.arange(PER_BATCH)) / RATE_HZ
    return message(standing(PER_BATCH), stream=stream, times_s=times_s, **numbers)


def socket_of(lab: Lab, token: str) -> Any:
    """Open the socket on which a self-test sends batches."""
    offered = ["reembody.v1", f"bearer.{token}"]
    return lab.stranger().websocket_connect(SOCKET, subprotocols=offered)


def kept(lab: Lab) -> int:
    """Return how many batches of self-tests are in the database."""
    with lab.database.reading() as db:
        return db.scalar(select(func.count()).select_from(HeadsetTestBatch)) or 0


def lost(share: float, longest_s: float) -> Json:
    """Return the figures of a goal that was lost for a share of the time, `longest_s` at once."""
    return {**TRACKED, "tracked": 1.0 - share, "lost": share, "longest_loss_s": longest_s}


def test_a_report_is_judged_stored_once_and_listed_newest_first(fresh_lab: Lab) -> None:
    """A report gets its verdicts; sent again it gets the same answer and is stored once."""
    token = fresh_lab.headset_token(fresh_lab.join()["id"])
    body = report(physics__real_time_factor=1.2)
    first = ok(send(fresh_lab, token, body))
    assert (first["status"], first["worn"], first["id"]) == ("warn", True, body["id"])
    (speed,) = (one for one in first["verdicts"] if one["code"] == "physics_speed")
    assert speed == {
        "code": "physics_speed",
        "status": "warn",
        "value": 1.2,
        "unit": "",
        "limit": 1.5,
        "at_least": True,
    }
    assert ok(send(fresh_lab, token, body)) == first
    refusal = error(send(fresh_lab, token, {**body, "duration_s": 60.0}), 409, "conflict")
    assert refusal["value"] == body["id"]
    later = ok(send(fresh_lab, token, report(started_at="2026-03-02T11:00:00+01:00")))
    newest = ok(send(fresh_lab, token, report(started_at="2026-03-03T08:00:00Z")))
    listed = ok(fresh_lab.operator.get("/api/headset-tests"))
    assert [one["id"] for one in listed] == [newest["id"], later["id"], first["id"]]
    assert listed[-1] == first
    assert {float(value) for value in body["rendering"].values() if not isinstance(value, str)} == {
        float(value)
        for value in listed[-1]["report"]["rendering"].values()
        if not isinstance(value, str)
    }


def test_nothing_of_a_self_test_belongs_to_the_session(fresh_lab: Lab) -> None:
    """The body, the batches and the report of a self-test add nothing to the session."""
    view = fresh_lab.join()
    token = fresh_lab.headset_token(view["id"])
    before = fresh_lab.events(view["id"])
    avatar = ok(fresh_lab.stranger().get(f"{PATH}/avatar", headers=bearer(token)))
    assert (avatar["stature_m"], avatar["body"]) == (1.75, None)
    with socket_of(fresh_lab, token) as socket:
        socket.send_bytes(batch(0))
        assert json.loads(socket.receive_text())["type"] == "ack"
    ok(send(fresh_lab, token, report()))
    assert fresh_lab.events(view["id"]) == before
    with fresh_lab.database.reading() as db:
        assert db.scalar(select(func.count()).select_from(TelemetryBatch)) == 0
        assert db.scalar(select(func.count()).select_from(TelemetryStream)) == 0
        stored = json.dumps(db.scalars(select(HeadsetTest)).one().report)
        assert db.scalar(select(func.count()).select_from(SessionEvent)) == len(before)
    assert view["id"] not in stored


def test_the_body_of_a_self_test_is_that_of_the_session(fresh_lab: Lab) -> None:
    """The body is the one that the session builds at 1.75 m, of which nothing is recorded.

    If the session shows a delayed copy, it is the newest standard body.
    """
    new(fresh_lab, "soft", CAST)
    ok(fresh_lab.operator.post("/api/studies", json={"yaml": study("{key: soft, version: 1}")}))
    view = ok(fresh_lab.operator.post(f"/api/studies/{KEY}/sessions", json={"kind": "test"}))
    headers = bearer(fresh_lab.headset_token(view["id"]))
    tested = ok(fresh_lab.stranger().get(f"{PATH}/avatar", headers=headers))
    wish = {"stature_m": 1.75}
    assert ok(fresh_lab.stranger().post("/api/vr/avatar", json=wish, headers=headers)) == tested

    copied = fresh_lab.headset_token(fresh_lab.join()["id"])
    standard = ok(fresh_lab.stranger().get(f"{PATH}/avatar", headers=bearer(copied)))
    hashes = {
        one["number"]: one["content_hash"]
        for one in ok(fresh_lab.operator.get("/api/avatars/standard"))["versions"]
    }
    assert standard["configuration_hash"] == hashes[max(hashes)] != tested["configuration_hash"]


def test_batches_are_acknowledged_from_the_disk_and_not_kept(fresh_lab: Lab) -> None:
    """Every batch is acknowledged; the database has at most the last commit's, then none."""
    token = fresh_lab.headset_token(fresh_lab.join()["id"])
    acknowledged = {str(stream): 0 for stream in BODY_STREAMS}
    most_kept = 0
    with socket_of(fresh_lab, token) as socket:
        for index in range(12):
            for stream in BODY_STREAMS:
                socket.send_bytes(batch(index, stream))
            if index % 4 == 3:
                while set(acknowledged.values()) != {(index + 1) * PER_BATCH}:
                    ack = json.loads(socket.receive_text())
                    for position in ack["positions"]:
                        assert position["epoch"] == 1
                        acknowledged[position["stream"]] = position["next_seq"]
                most_kept = max(most_kept, kept(fresh_lab))
    assert 0 < most_kept <= 8
    await_empty(fresh_lab)


def test_the_cockpit_hears_of_a_running_self_test_and_what_is_left_of_it(fresh_lab: Lab) -> None:
    """A headset's self-test is shown from its socket to its end, counted from its first batch."""
    session_id = fresh_lab.join()["id"]
    token = fresh_lab.headset_token(session_id)

    def shown() -> Json | None:
        (device,) = fresh_lab.view(session_id)["devices"]
        found: Json | None = device["self_test"]
        return found

    def until(expected: Callable[[Json | None], bool]) -> None:
        patience = time.monotonic() + PATIENCE_S
        while not expected(shown()):
            assert time.monotonic() < patience, shown()

    assert shown() is None
    with socket_of(fresh_lab, token) as socket:
        until(lambda test: test == {"left_s": None})
        socket.send_bytes(batch(0))
        socket.receive_text()
        test = shown()
        assert test is not None
        assert 0.0 < test["left_s"] <= PLANNED_S
    until(lambda test: test is None)


def test_a_self_test_lasts_as_long_as_the_page_plans_it() -> None:
    """What is left is counted down from the sum of the steps of the page's plan."""
    plan = (FRONTEND / "src/vr/selftest/plan.ts").read_text()
    assert sum(map(float, re.findall(r"durationS: (\d+) }", plan))) == PLANNED_S


def await_empty(lab: Lab) -> None:
    """Wait until the writer has deleted the last batches of a self-test that was closed."""
    patience = time.monotonic() + PATIENCE_S
    while kept(lab) and time.monotonic() < patience:
        time.sleep(0.02)
    assert kept(lab) == 0


@pytest.mark.parametrize(
    ("sent", "code"),
    [
        (batch(1), "invalid_input"),
        (batch(0, epoch=2), "invalid_input"),
        (batch(0, phase_id=1), "invalid_input"),
        (b"RMB1 no batch", "invalid_input"),
        ('{"type": "hello", "protocol": 1, "client": "x"}', "invalid_input"),
    ],
    ids=["gap", "epoch", "phase", "malformed", "text"],
)
@pytest.mark.one_engine
def test_what_no_self_test_sends_closes_its_socket(
    fresh_lab: Lab, sent: bytes | str, code: str
) -> None:
    """A batch of another epoch or phase, a gap, and a text are refused with the reason."""
    token = fresh_lab.headset_token(fresh_lab.join()["id"])
    with socket_of(fresh_lab, token) as socket:
        socket.send(
            {"type": "websocket.receive", "bytes" if isinstance(sent, bytes) else "text": sent}
        )
        failure = json.loads(socket.receive_text())
        assert (failure["type"], failure["code"]) == ("error", code)
        assert socket.receive()["code"] == 4400


@pytest.mark.one_engine
def test_a_self_test_sends_no_more_than_its_limit(
    fresh_lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Beyond the greatest number of batches the socket closes, and nothing is kept."""
    monkeypatch.setattr("app.features.record.self_tests.storage.MAX_BATCHES", 3)
    token = fresh_lab.headset_token(fresh_lab.join()["id"])
    with socket_of(fresh_lab, token) as socket:
        for index in range(4):
            socket.send_bytes(batch(index))
        heard: Json = {"type": "ack"}
        while heard["type"] == "ack":
            heard = json.loads(socket.receive_text())
        assert (heard["type"], heard["code"]) == ("error", "too_large")
    await_empty(fresh_lab)


@pytest.mark.one_engine
def test_a_self_test_sends_no_faster_than_a_session(fresh_lab: Lab) -> None:
    """Who sends much more than a session at once is refused by name, and nothing is kept."""
    token = fresh_lab.headset_token(fresh_lab.join()["id"])
    frames = 700
    with socket_of(fresh_lab, token) as socket:
        for index in range(24):
            times_s = np.arange(frames) / RATE_HZ
            first = index * frames
            socket.send_bytes(
                message(standing(frames), stream=TARGET, times_s=times_s, seq_first=first)
            )
        heard: Json = {"type": "ack"}
        while heard["type"] == "ack":
            heard = json.loads(socket.receive_text())
    assert (heard["type"], heard["code"]) == ("error", "too_large")
    assert "faster than a session" in heard["message"]
    await_empty(fresh_lab)


@pytest.mark.one_engine
def test_batches_that_are_committed_with_the_end_of_their_test_are_not_kept(
    fresh_lab: Lab,
) -> None:
    """On a busy server the last batches and the end of a self-test come into one commit."""
    writer = fresh_lab.context.part(TelemetryWriter)
    contents = [
        TrialContent("a-trial", decode_batch(raw).header, raw) for raw in (batch(0), batch(1))
    ]
    arrived = [Arrival(NO_SESSION, ServerSender(), one) for one in contents]
    writer._commit([*arrived, Arrival(NO_SESSION, ServerSender(), TrialEnd("a-trial"))])
    assert kept(fresh_lab) == 0


def test_the_allowance_of_bytes_fills_again_at_its_rate() -> None:
    """A burst uses the allowance up; a second later there is a second's worth, never more."""
    allowance = Allowance()
    assert allowance.take(BURST_BYTES, 10.0)
    assert not allowance.take(1, 10.0)
    assert not allowance.take(BYTES_PER_S + 1, 11.0)
    assert allowance.take(BYTES_PER_S, 11.0)
    assert not allowance.take(BURST_BYTES + 1, 1e6)
    assert allowance.take(BURST_BYTES, 1e6)


@pytest.mark.one_engine
def test_a_newer_self_test_of_a_headset_replaces_the_older(fresh_lab: Lab) -> None:
    """A headset has one test at a time: the older socket is told so and closes, the newer works."""
    token = fresh_lab.headset_token(fresh_lab.join()["id"])
    other = fresh_lab.headset_token(fresh_lab.join()["id"])
    with (
        ExitStack() as enclosing,
        socket_of(fresh_lab, other) as elsewhere,
        socket_of(fresh_lab, token) as older,
    ):
        # Two sockets that open at once may come in either order; one that was answered is there.
        older.send_bytes(batch(0))
        assert json.loads(older.receive_text())["type"] == "ack"
        newer = enclosing.enter_context(socket_of(fresh_lab, token))
        told = json.loads(older.receive_text())
        assert (told["type"], told["code"]) == ("error", "conflict")
        assert "newer self-test" in told["message"]
        assert older.receive()["code"] == 4400
        for socket in (newer, elsewhere):
            socket.send_bytes(batch(0))
            assert json.loads(socket.receive_text())["type"] == "ack"


@pytest.mark.one_engine
def test_a_headset_whose_clock_is_ahead_hides_no_newer_test(fresh_lab: Lab) -> None:
    """The list is by the server's clock: the last report comes first, whatever its headset says."""
    token = fresh_lab.headset_token(fresh_lab.join()["id"])
    soon = fresh_lab.context.clock.utc_now() + timedelta(hours=6)
    ahead = report(started_at=soon.isoformat())
    today = report()
    for body in (ahead, today):
        ok(send(fresh_lab, token, body))
    listed = ok(fresh_lab.operator.get("/api/headset-tests"))
    assert [one["id"] for one in listed] == [today["id"], ahead["id"]]
    assert listed[1]["clock_ahead_s"] > 60.0


@pytest.mark.one_engine
def test_a_phase_prevents_and_ends_a_self_test(fresh_lab: Lab) -> None:
    """During a phase there is no self-test: its socket closes when the phase is prepared."""
    view = fresh_lab.skip_to(fresh_lab.join(), "free_roam")
    token = fresh_lab.headset_token(view["id"])
    with socket_of(fresh_lab, token) as socket:
        socket.send_bytes(batch(0))
        assert json.loads(socket.receive_text())["type"] == "ack"
        fresh_lab.context.hub.headset_joined(view["id"])
        fresh_lab.command(fresh_lab.view(view["id"]), "begin_phase")
        failure = json.loads(socket.receive_text())
        assert (failure["type"], failure["code"]) == ("error", "not_now")
    headers = bearer(token)
    error(fresh_lab.stranger().get(f"{PATH}/avatar", headers=headers), 409, "not_now")
    with socket_of(fresh_lab, token) as socket:
        assert json.loads(socket.receive_text())["code"] == "not_now"
    # A report of a test that was made before is accepted, however late it arrives.
    ok(send(fresh_lab, token, report()))


@pytest.mark.one_engine
@pytest.mark.parametrize("way", ["unpaired", "replaced"])
def test_the_end_of_its_pairing_ends_a_self_test(fresh_lab: Lab, way: str) -> None:
    """The socket of an unpaired or replaced headset closes at once, with the session's code."""
    session_id = fresh_lab.join()["id"]
    token = fresh_lab.headset_token(session_id)
    with socket_of(fresh_lab, token) as socket:
        socket.send_bytes(batch(0))
        assert json.loads(socket.receive_text())["type"] == "ack"
        if way == "replaced":
            fresh_lab.headset_token(session_id)
        else:
            (device,) = fresh_lab.view(session_id)["devices"]
            path = f"/api/sessions/{session_id}/devices/{device['id']}"
            assert fresh_lab.operator.delete(path).status_code == 204
        heard: Json = {"type": "ack"}
        while heard["type"] == "ack":
            heard = json.loads(socket.receive_text())
        assert (heard["type"], heard["code"]) == ("error", "not_signed_in")
        assert socket.receive()["code"] == 4401
    await_empty(fresh_lab)


def test_a_restart_deletes_what_a_killed_server_left(fresh_lab: Lab) -> None:
    """Batches that a killed server could not delete are deleted when it starts again."""
    with fresh_lab.database.writing() as db:
        row = HeadsetTestBatch(
            trial_id="f" * 32,
            stream="target",
            seq_first=0,
            received_at=fresh_lab.context.clock.utc_now(),
            message=batch(0),
        )
        db.add(row)
    assert kept(fresh_lab) == 1
    stop_running_clocks(fresh_lab.context)
    assert kept(fresh_lab) == 0


@pytest.mark.one_engine
def test_every_role_reads_the_self_tests_and_none_learns_a_condition(fresh_lab: Lab) -> None:
    """A blinded operator and an analyst see the same list, which names no session and condition."""
    view = fresh_lab.join()
    ok(send(fresh_lab, fresh_lab.headset_token(view["id"]), report()))
    listed = ok(fresh_lab.operator.get("/api/headset-tests"))
    for role in ("operator", "analyst", "experimenter"):
        reader = sign_in(fresh_lab, role, studies=[])
        assert ok(reader.get("/api/headset-tests")) == listed, role
    text = json.dumps(listed)
    assert view["id"] not in text
    assert "latency" not in text
    assert "condition" not in text


@pytest.mark.one_engine
def test_only_a_paired_headset_tests_itself(fresh_lab: Lab) -> None:
    """Without a headset's token nothing is stored, and a wrong token opens no socket."""
    error(fresh_lab.stranger().post(PATH, json=report()), 401, "not_signed_in")
    error(fresh_lab.operator.post(PATH, json=report()), 401, "not_signed_in")
    error(fresh_lab.stranger().get("/api/headset-tests"), 401, "not_signed_in")
    with socket_of(fresh_lab, "wrong") as socket:
        assert json.loads(socket.receive_text())["code"] == "not_signed_in"
        assert socket.receive()["code"] == 4401
    refused = send(fresh_lab, fresh_lab.headset_token(fresh_lab.join()["id"]), {"id": "x"})
    assert error(refused, 422, "invalid_input")["details"]
    assert ok(fresh_lab.operator.get("/api/headset-tests")) == []


def test_every_figure_of_a_self_test_is_exported(fresh_lab: Lab, tmp_path: Path) -> None:
    """headset_tests.csv has every verdict and every number of every report, and their units."""
    token = fresh_lab.headset_token(fresh_lab.join()["id"])
    bare = report(physics=None, started_at="2026-03-01T09:00:00Z", page__errors=["no worker"])
    full = report(page__memory_bytes=None)
    for body in (bare, full):
        ok(send(fresh_lab, token, body))
    with fresh_lab.database.reading() as db:
        export_study(
            db, STUDY, "people", tmp_path / "export", now=fresh_lab.context.clock.utc_now()
        )
    rows = rows_of((tmp_path / "export" / "headset_tests.csv").read_bytes())
    assert list(dict.fromkeys(row["self_test_id"] for row in rows)) == [full["id"], bare["id"]]
    of_full = {row["figure"]: row for row in rows if row["self_test_id"] == full["id"]}
    assert {name for name in of_full if name.startswith("verdict.")} == {
        f"verdict.{rule.code}" for rule in RULES
    }
    late = of_full["verdict.late_frames"]
    assert (late["status"], late["unit"], late["limit"], late["at_least"]) == (
        *("ok", "%", "1.0"),
        "false",
    )
    figures = {
        "rendering.interval_p95_s": ("0.0113", "s"),
        "rendering.nominal_rate_hz": ("90.0", "Hz"),
        "physics.real_time_factor": ("3.4", ""),
        "physics.stature_m": ("1.75", "m"),
        "storage.bytes_per_s": ("68300.0", "B/s"),
        "tracking.LeftLowerLeg.pose_rate_hz": ("90.0", "Hz"),
    }
    assert {name: (of_full[name]["value"], of_full[name]["unit"]) for name in figures} == figures
    assert "page.memory_bytes" not in of_full
    of_bare = {row["figure"]: row for row in rows if row["self_test_id"] == bare["id"]}
    assert not any(name.startswith("physics.") for name in of_bare)
    missing = of_bare["verdict.physics_speed"]
    assert (missing["value"], missing["status"], missing["errors"]) == ("", "fail", "no worker")


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("place", "changes"),
    [
        ("started_at", {"started_at": "0001-01-01T00:00:00+14:00"}),
        ("started_at", {"started_at": "9999-12-31T23:59:59-14:00"}),
        ("started_at", {"started_at": "2190-01-01T00:00:00Z"}),
        ("rendering.nominal_rate_hz", {"rendering__nominal_rate_hz": 1e-9}),
        ("rendering.nominal_rate_hz", {"rendering__nominal_rate_hz": 500.0}),
        ("rendering.frames", {"rendering__frames": 1, "rendering__late_frames": 0}),
        ("rendering.frames", {"rendering__frames": 100_000}),
        ("tracking.Head.longest_loss_s", {"tracking__Head": lost(1.0, 0.0)}),
        ("tracking.Head.longest_loss_s", {"tracking__Head": lost(1.0, 0.5)}),
        ("tracking.Hips.longest_loss_s", {"tracking__Hips": lost(0.1, 90.0)}),
    ],
)
def test_a_report_that_contradicts_itself_is_refused_by_its_field(
    fresh_lab: Lab, place: str, changes: Json
) -> None:
    """Figures that cannot belong together, and times out of range, are refused and not judged."""
    token = fresh_lab.headset_token(fresh_lab.join()["id"])
    refused = error(send(fresh_lab, token, report(**changes)), 422, "invalid_input")
    assert place in json.dumps(refused)
    assert ok(fresh_lab.operator.get("/api/headset-tests")) == []
    # What a real headset may send: never seen feet, a loss that lasts, a report that had to wait.
    fine = report(
        started_at="1970-01-01T00:00:09Z", tracking__Hips=lost(1.0, 120.0), duration_s=119.0
    )
    ok(send(fresh_lab, token, fine))
