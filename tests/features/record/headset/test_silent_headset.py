"""Tests of a headset that is taken off: its socket stays open and no data arrive.

`pytest -m long --long` waits for a minute with the default limit of three seconds.
"""

import sys
import time
from pathlib import Path

import pytest
from sqlalchemy import select

from app.models import PhaseQuality
from tests.features.lab import Json, ok
from tests.features.record.headset.conftest import running_site
from tests.features.record.headset.site import Headset, Site
from tests.features.record.headset.streaming import Streamer, in_free_movement, materialised

QUALITY_WITHIN_S = 20.0


def paused(headset: Headset) -> Json:
    """Wait for the state in which the phase is paused."""
    return headset.hear("state", lambda state: state["phase"]["status"] == "paused")


def alarms(site: Site, session_id: str) -> list[Json]:
    """Return every alarm of the session, newest first."""
    history: list[Json] = ok(site.operator.get(f"/api/sessions/{session_id}/alarms"))
    return history


def cleared(site: Site, session_id: str, code: str, within_s: float = 8.0) -> Json:
    """Wait until an alarm is cleared, and return it."""
    deadline_s = time.monotonic() + within_s
    while time.monotonic() < deadline_s:
        for alarm in alarms(site, session_id):
            if alarm["code"] == code and alarm["cleared_at"] is not None:
                return alarm
        time.sleep(0.05)
    raise AssertionError(f"{code} was not cleared: {alarms(site, session_id)}")


def fall_asleep(site: Site, headset: Headset, session_id: str, for_s: float) -> tuple[float, float]:
    """Stream for a second, send nothing for `for_s`, then resume and finish the phase.

    Returns the seconds until the phase was paused, and the length of the gap in its frames.
    """
    streamer = in_free_movement(site, session_id, headset)
    streamer.stream(1.0)
    state = paused(headset)
    detected_s = time.monotonic() - streamer.last_sent_s
    assert state["phase"]["active_s"] == pytest.approx(streamer.active_s)
    view = site.view(session_id)
    assert view["current"]["pause_reason"] == "headset_silent"
    (alarm,) = [one for one in view["alarms"] if one["code"] == "silent"]
    assert (alarm["severity"], alarm["cleared_at"]) == ("critical", None)
    time.sleep(max(0.0, for_s - detected_s))
    wake_up(site, headset, session_id, streamer, for_s)
    return detected_s, for_s


def wake_up(
    site: Site, headset: Headset, session_id: str, streamer: Streamer, slept_s: float
) -> None:
    """Let the headset confirm the pause, resume the phase and finish it."""
    streamer.t_s += slept_s
    phase_id = streamer.phase_id
    clock = {"t_s": streamer.t_s, "active_s": streamer.active_s}
    headset.reported(kind="phase", phase_id=phase_id, what="paused", cause="asleep", **clock)
    site.command(session_id, "resume")
    headset.hear("state", lambda state: state["phase"]["resuming"])
    headset.reported(kind="phase", phase_id=phase_id, what="resumed", **clock)
    with streamer.streaming():
        cleared(site, session_id, "silent")
    streamer.active_s = 120.0
    streamer.stream(0.2)
    for what in ("time_up", "ended"):
        headset.reported(
            kind="phase", phase_id=phase_id, what=what, t_s=streamer.t_s, active_s=120.0
        )


def quality_of(site: Site, session_id: str) -> PhaseQuality:
    """Wait for the quality of the actual stream, and return it."""
    deadline_s = time.monotonic() + QUALITY_WITHIN_S
    query = select(PhaseQuality).where(
        PhaseQuality.session_id == session_id, PhaseQuality.stream == "actual"
    )
    while time.monotonic() < deadline_s:
        with site.database.reading() as db:
            row = db.scalar(query)
        if row is not None:
            return row
        time.sleep(0.1)
    raise AssertionError("the phase's quality was not judged")


@pytest.mark.one_engine
def test_a_headset_that_falls_asleep_stops_its_phase(
    quick_site: Site, capsys: pytest.CaptureFixture[str]
) -> None:
    """A silent headset pauses its phase at the last time on disk; alarm and gap are recorded."""
    session_id = materialised(quick_site)
    with quick_site.headset(quick_site.token(session_id)) as headset:
        detected_s, slept_s = fall_asleep(quick_site, headset, session_id, 2.5)
    print_figure(capsys, f"silent for {slept_s:.1f} s, limit 1 s: noticed after {detected_s:.2f} s")
    assert 1.0 <= detected_s < 1.0 + 2.0
    reported = alarms(quick_site, session_id)
    silent = next(one for one in reversed(reported) if one["code"] == "silent")
    assert silent["outcome"].startswith("The headset is connected but has sent no movement for")
    (gap,) = [one for one in reported if (one["code"], one["stream"]) == ("gap", "actual")]
    assert gap["value"] == pytest.approx(slept_s, abs=0.1)
    event = next(
        event
        for event in ok(quick_site.operator.get(f"/api/sessions/{session_id}/events"))
        if event["type"] == "phase_paused"
    )
    assert (event["by"], event["data"]["cause"]) == ("system", "headset_silent")
    quality = quality_of(quick_site, session_id)
    assert quality.gaps == 1
    assert quality.longest_gap_s == pytest.approx(slept_s, abs=0.1)


@pytest.mark.one_engine
def test_a_silent_headset_only_raises_an_alarm_if_the_study_continues(
    quick_site: Site,
) -> None:
    """With `on_disconnect: continue` a silent headset raises an alarm; its phase keeps running."""
    text = ok(quick_site.operator.get("/api/studies/reembodiment-latency"))["yaml"]
    text = text.replace("key: reembodiment-latency", "key: goes-on", 1)
    text = text.replace("on_disconnect: pause", "on_disconnect: continue", 1)
    assert "on_disconnect: continue" in text
    quick_site.operator.post("/api/studies", json={"yaml": text})
    view = ok(quick_site.operator.post("/api/studies/goes-on/sessions", json={}))
    session_id = str(view["id"])
    quick_site.skip_to(session_id, "materialise")
    with quick_site.headset(quick_site.token(session_id)) as headset:
        in_free_movement(quick_site, session_id, headset).stream(0.5)
        headset.hear("state")
        view = quick_site.view(session_id)
        deadline_s = time.monotonic() + 5.0
        while not view["alarms"] and time.monotonic() < deadline_s:
            time.sleep(0.05)
            view = quick_site.view(session_id)
        assert [alarm["code"] for alarm in view["alarms"]] == ["silent"]
        assert view["current"]["status"] == "running"


def test_a_lost_headset_raises_an_alarm_until_it_reconnects(quick_site: Site) -> None:
    """A headset that disconnects raises an alarm, which is cleared when it reconnects."""
    session_id = materialised(quick_site)
    token = quick_site.token(session_id)
    with quick_site.headset(token) as headset:
        in_free_movement(quick_site, session_id, headset).stream(0.3)
    opened = [alarm["code"] for alarm in wait_for_alarms(quick_site, session_id)]
    assert opened == ["disconnected"]
    with quick_site.headset(token, epoch=1):
        assert cleared(quick_site, session_id, "disconnected")["outcome"] == "the headset is back"
    quick_site.command(session_id, "abort", reason="over")
    wait_until_clear(quick_site, session_id)


@pytest.mark.one_engine
def test_the_end_of_a_session_clears_its_alarms(quick_site: Site) -> None:
    """Ending a session clears its open alarms."""
    session_id = materialised(quick_site)
    with quick_site.headset(quick_site.token(session_id)) as headset:
        in_free_movement(quick_site, session_id, headset).stream(0.3)
        wait_for_alarms(quick_site, session_id)
        quick_site.command(session_id, "abort", reason="over")
        assert quick_site.view(session_id)["alarms"] == []
    assert cleared(quick_site, session_id, "silent")["outcome"] == "the session has ended"


@pytest.mark.long
def test_a_headset_that_is_off_for_a_minute(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A headset that is silent for a minute is noticed within the default limits."""
    with running_site("sqlite", tmp_path, {}) as site:
        session_id = materialised(site)
        with site.headset(site.token(session_id)) as headset:
            detected_s, slept_s = fall_asleep(site, headset, session_id, 60.0)
    print_figure(capsys, f"silent for {slept_s:.1f} s, limit 3 s: noticed after {detected_s:.2f} s")
    assert 3.0 <= detected_s < 5.0


def wait_for_alarms(site: Site, session_id: str, within_s: float = 5.0) -> list[Json]:
    """Wait until any alarm is open, and return the open alarms."""
    deadline_s = time.monotonic() + within_s
    while time.monotonic() < deadline_s:
        opened: list[Json] = site.view(session_id)["alarms"]
        if opened:
            return opened
        time.sleep(0.05)
    raise AssertionError("no alarm was raised")


def wait_until_clear(site: Site, session_id: str, within_s: float = 5.0) -> None:
    """Wait until no alarm is open."""
    deadline_s = time.monotonic() + within_s
    while site.view(session_id)["alarms"]:
        assert time.monotonic() < deadline_s
        time.sleep(0.05)


def print_figure(capsys: pytest.CaptureFixture[str], line: str) -> None:
    """Print a measured figure despite the capturing of output."""
    with capsys.disabled():
        sys.stdout.write(f"\n{line}\n")
