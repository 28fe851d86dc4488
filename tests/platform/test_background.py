"""Tests of background work: errors are detected, named in the health check and recovered from."""

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

import pytest

from app.clock import Clock
from app.features.record.alarms import Change, Condition
from app.features.record.telemetry import AlarmContent, Arrival, TelemetryWriter
from app.features.results.exports.export_queue import QUEUE, ExportQueue
from app.features.results.exports.jobs import Job
from app.platform.background import REMEMBERED_NS, Background
from app.platform.workers import Worker
from tests.features.lab import Lab, running_lab
from tests.support.sqlite import fresh_sqlite

PATIENCE_S = 120.0


@pytest.fixture
def small_lab(tmp_path: Path) -> Iterator[Lab]:
    """Yield an application on SQLite."""
    with running_lab(fresh_sqlite(tmp_path / "reembody.sqlite"), data_dir=tmp_path) as lab:
        yield lab


@pytest.fixture
def background() -> Background:
    """Return a background without any work."""
    return Background(Clock())


def test_a_thread_that_fails_is_reported_and_restarted(background: Background) -> None:
    """A thread that ends with an error is reported as failing and restarted."""
    runs, stop = [], threading.Event()

    def work() -> None:
        runs.append(True)
        if len(runs) == 1:
            raise ValueError("a bug")
        stop.wait(PATIENCE_S)

    thread = background.thread("work", work, critical=True)
    wait_for(lambda: len(runs) == 2)
    (one,) = background.failing()
    assert (one.name, one.state, one.urgency, one.error) == (
        *("work", "failing", "critical"),
        "ValueError",
    )
    background.recovered("work")
    assert background.failing() == ()
    (incident,) = background.take_incidents()
    assert incident.name == "work"
    stop.set()
    thread.join(PATIENCE_S)
    assert background.failing() == ()


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_thread_that_exits_is_reported_as_stopped(background: Background) -> None:
    """A thread that ended by `SystemExit` is reported as stopped."""

    def work() -> None:
        raise SystemExit(1)

    background.thread("work", work).join(PATIENCE_S)
    assert [(one.name, one.state) for one in background.failing()] == [("work", "stopped")]


def test_a_failure_without_later_work_is_forgotten_after_a_while() -> None:
    """A failure that no later success clears is forgotten after a while."""
    passed = [0]
    background = Background(Clock(monotonic_ns=lambda: passed[0]))
    with ThreadPoolExecutor(1) as pool:
        done = pool.submit(int, "no number")
    background.watched("queue", done)
    assert [one.name for one in background.failing()] == ["queue"]
    passed[0] += REMEMBERED_NS + 1
    assert background.failing() == ()


def test_a_dead_process_is_reported_until_the_next_one_works(background: Background) -> None:
    """A process that dies is reported until the next one works; one ended on purpose is not."""
    worker = Worker().watched_by(background, "figures")
    try:
        pid = worker.submit(os.getpid).result()
        worker.end()
        assert background.failing() == ()
        pid = worker.submit(os.getpid).result()
        with pytest.raises(BrokenProcessPool):
            worker.submit(os.kill, pid, signal.SIGKILL).result()
        wait_for(lambda: [one.name for one in background.failing()] == ["figures"])
        worker.submit(os.getpid).result()
        wait_for(lambda: background.failing() == ())
    finally:
        worker.end()


class _CountingSender:
    """A sender that counts its stored and refused messages."""

    def __init__(self) -> None:
        self.stored, self.refused = 0, 0
        self.last: object = None

    def deliver(self, outcome: object) -> None:
        """Count a message as stored."""
        self.stored, self.last = self.stored + 1, outcome

    def fail(self, error: Exception) -> None:
        """Count a message as refused."""
        self.refused, self.last = self.refused + 1, error


def test_a_failed_writer_is_restarted_and_loses_nothing(
    small_lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A telemetry writer that fails is reported and restarted, and stores what was waiting.

    The session with a connected headset has the alarm in its record.
    """
    lab, sender = small_lab, _CountingSender()
    view = lab.join(kind="test")
    writer = lab.context.part(TelemetryWriter)
    store, failures = writer._store, [OSError("the first"), OSError("the second")]

    def fails(arrivals: Any) -> None:
        if failures:
            raise failures.pop()
        store(arrivals)

    monkeypatch.setattr(writer, "_store", fails)
    lab.context.hub.headset_joined(view["id"])
    raised = Change("raised", Condition("gap", "a gap"), lab.context.clock.utc_now())
    writer.submit(Arrival(view["id"], sender, AlarmContent(raised)))
    wait_for(lambda: health(lab)["status"] == "degraded")
    (named,) = health(lab)["failing"]
    assert (named["name"], named["urgency"], named["error"]) == (
        *("telemetry-writer", "critical"),
        "OSError",
    )
    wait_for(lambda: health(lab)["status"] == "ok")
    assert (sender.stored, sender.refused) == (1, 0)
    wait_for(lambda: alarms(lab, view["id"]) == {"gap", "writer_failed"})


def test_a_message_that_keeps_failing_the_writer_is_refused(
    small_lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A message that makes the writer fail repeatedly is refused, so that others are stored."""
    lab, poisoned, sound = small_lab, _CountingSender(), _CountingSender()
    view = lab.join(kind="test")
    writer = lab.context.part(TelemetryWriter)
    store = writer._store

    def fails(arrivals: Any) -> None:
        if any(one.sender is poisoned for one in arrivals):
            raise OSError("this message")
        store(arrivals)

    monkeypatch.setattr(writer, "_store", fails)
    raised = Change("raised", Condition("gap", "a gap"), lab.context.clock.utc_now())
    writer.submit(Arrival(view["id"], poisoned, AlarmContent(raised)))
    wait_for(lambda: poisoned.refused == 1)
    writer.submit(Arrival(view["id"], sound, AlarmContent(raised)))
    wait_for(lambda: sound.stored == 1)
    wait_for(lambda: health(lab)["status"] == "ok")


def test_an_export_that_breaks_its_queue_fails(
    small_lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An export that breaks its queue is marked as failed, and the next one is made."""
    desk = small_lab.context.part(ExportQueue)

    def breaks(job: Job) -> None:
        raise OSError("no process can be started")

    monkeypatch.setattr(desk, "_make", breaks)
    path = "/api/studies/reembodiment-latency/exports"
    ordered = small_lab.operator.post(path, json={"kind": "test"}).json()
    wait_for(
        lambda: small_lab.operator.get(f"/api/exports/{ordered['id']}").json()["state"] == "failed"
    )
    assert [one["name"] for one in health(small_lab)["failing"]] == [QUEUE]
    monkeypatch.undo()
    small_lab.operator.post(path, json={"kind": "test"})
    wait_for(lambda: health(small_lab)["status"] == "ok")


def health(lab: Lab) -> dict[str, Any]:
    """Return the public health check."""
    reply: dict[str, Any] = lab.stranger().get("/api/health").json()
    return reply


def alarms(lab: Lab, session_id: str) -> set[str]:
    """Return the codes of all alarms that a session has had."""
    return {
        str(one["code"]) for one in lab.operator.get(f"/api/sessions/{session_id}/alarms").json()
    }


def wait_for(is_so: Callable[[], bool]) -> None:
    """Wait until a condition holds, or fail."""
    give_up_s = time.monotonic() + PATIENCE_S
    while not is_so():
        assert time.monotonic() < give_up_s
        time.sleep(0.01)
