"""Tests of the conversion of recorded times to UTC, on both engines."""

from dataclasses import replace
from datetime import timedelta

import numpy as np
import pandas as pd
import pytest
from sqlalchemy import update

from app.database import Database
from app.features.results.analysis.tables import (
    clock_mapping_table,
    clock_probes_table,
    completions_table,
    contacts_table,
)
from app.features.results.analysis.tables.clocks import run_clocks
from app.models import ClockProbe, Contact, StudySession
from app.science.clock import ClockProbes
from tests.features.builders import NOW, STUDY, SessionSpec, build_session
from tests.features.clock_filler import EPOCH_UTC, store_probes
from tests.science.clock.simulated import (
    SERVER_STARTS_S,
    SYMMETRIC,
    UTC_S,
    Scenario,
    Simulated,
    simulate,
)

WIFI = replace(SYMMETRIC[0], duration_s=700.0)


def _session(database: Database, kind: str = "people") -> str:
    """Return a session without clock probes."""
    with database.writing() as db:
        session = build_session(db, SessionSpec("P-0001", kind=kind))
        db.query(ClockProbe).delete()
        return session.id


def _stored(database: Database, session_id: str, scenario: Scenario, epoch: int = 1) -> Simulated:
    simulated = simulate(scenario, np.random.default_rng(epoch), events=500)
    with database.writing() as db:
        store_probes(db, session_id, simulated.probes, epoch=epoch)
    return simulated


def _errors_s(database: Database, session_id: str, simulated: Simulated, epoch: int = 1) -> float:
    """Return the 95th percentile of the events' error in UTC (s); each must be within its bound.

    The wall clock is read with the probes, up to 80 ms late; the median lateness is subtracted
    because it is the same for all events.
    """
    with database.reading() as db:
        clock = run_clocks(db, session_id)[epoch]
    utc, uncertainty_ms = clock.to_utc(simulated.event_client_s)
    told_s = (utc - np.datetime64("1970-01-01")) / np.timedelta64(1, "us") / 1e6
    truth_s = UTC_S + simulated.event_server_s - SERVER_STARTS_S
    late_s = told_s - truth_s
    assert 0.0 < np.median(late_s) < 0.03
    error_s = np.abs(late_s - np.median(late_s))
    assert (1000.0 * error_s <= 2.0 * uncertainty_ms).all()
    return float(np.percentile(error_s, 95))


@pytest.mark.one_engine
@pytest.mark.parametrize(
    "scenario",
    [
        WIFI,
        replace(WIFI, client_step_s=0.5),
        replace(WIFI, asleep_s=60.0),
        replace(WIFI, server_step_s=-30.0),
        replace(WIFI, server_step_s=-SERVER_STARTS_S, lost=0.3),
    ],
    ids=["plain", "client steps", "headset asleep", "server steps", "server starts again"],
)
def test_event_times_in_utc_are_correct_within_5_ms(database: Database, scenario: Scenario) -> None:
    """Event times converted to UTC from stored probes are correct within 5 ms."""
    session_id = _session(database)
    simulated = _stored(database, session_id, scenario)
    assert _errors_s(database, session_id, simulated) < 0.005


@pytest.mark.one_engine
def test_a_wall_clock_change_does_not_change_utc(database: Database) -> None:
    """Changing the wall clock during a session does not change UTC; the mapping shows the step."""
    session_id = _session(database)
    simulated = _stored(database, session_id, WIFI)
    with database.reading() as db:
        before, _ = run_clocks(db, session_id)[1].to_utc(simulated.event_client_s)
    set_at = EPOCH_UTC + timedelta(seconds=UTC_S + 350.0)
    with database.writing() as db:
        for probe in db.query(ClockProbe).where(ClockProbe.server_utc > set_at):
            probe.server_utc -= timedelta(seconds=30)
    with database.reading() as db:
        after, _ = run_clocks(db, session_id)[1].to_utc(simulated.event_client_s)
        rows = clock_mapping_table(db, STUDY, "people")
    assert np.array_equal(before, after)
    assert rows["server_utc_step_ms"].iloc[0] == pytest.approx(0.0, abs=50.0)
    assert rows["server_utc_step_ms"].iloc[-1] == pytest.approx(-30_000.0, abs=50.0)
    assert rows["stepped"].isna().all()


def _later(probes: ClockProbes, client_s: float, server_s: float, utc_s: float) -> ClockProbes:
    assert probes.server_utc_s is not None
    return ClockProbes(
        probes.client_sent_s + client_s,
        probes.server_received_s + server_s,
        probes.server_sent_s + server_s,
        probes.client_received_s + client_s,
        probes.server_utc_s + utc_s,
    )


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("server_s", "utc_s", "passed_s"),
    [
        (1000.0, 1000.0, 1000.0),
        (1000.0, 970.0, 1000.0),
        (1000.0 - SERVER_STARTS_S, 1000.0, 1000.0),
        (1000.0, 90_000.0, 90_000.0),
    ],
    ids=["goes on", "wall clock set", "server started again", "later than it was up"],
)
def test_utc_is_consistent_across_runs_of_the_client(
    database: Database, server_s: float, utc_s: float, passed_s: float
) -> None:
    """UTC is consistent across two runs of the client with different clocks.

    UTC is taken from the wall clock again if the server's monotonic clock went back, or advanced so
    little that the server must have restarted after the first run.
    """
    session_id = _session(database)
    probes = _stored(database, session_id, WIFI).probes
    with database.writing() as db:
        store_probes(db, session_id, _later(probes, -1000.0, server_s, utc_s), epoch=2)
    with database.reading() as db:
        clocks = run_clocks(db, session_id)
    assert list(clocks) == [1, 2]
    first, _ = clocks[1].to_utc(np.array([1500.0]))
    second, _ = clocks[2].to_utc(np.array([500.0]))
    assert (second - first)[0] / np.timedelta64(1, "s") == pytest.approx(passed_s, abs=0.001)


@pytest.mark.one_engine
def test_a_run_after_a_restart_within_a_run_keeps_utc(database: Database) -> None:
    """A run of the client that follows a server restart within the previous run keeps UTC."""
    session_id = _session(database)
    restarting = replace(WIFI, server_step_s=-SERVER_STARTS_S)
    probes = _stored(database, session_id, restarting).probes
    later = np.arange(len(probes)) > 400
    with database.writing() as db:
        repeated = _later(probes.select(later), 0.0, 1000.0, 1000.0)
        store_probes(db, session_id, repeated, epoch=2)
    with database.reading() as db:
        clocks = run_clocks(db, session_id)
    at = np.array([float(probes.client_sent_s[500])])
    passed = clocks[2].to_utc(at)[0] - clocks[1].to_utc(at)[0]
    assert passed[0] / np.timedelta64(1, "s") == pytest.approx(1000.0, abs=0.01)


def test_a_clock_that_was_set_back_is_read_in_the_order_of_storing(database: Database) -> None:
    """Times of a client clock that was set back are read in stored order, with a large bound."""
    session_id = _session(database)
    simulated = _stored(database, session_id, replace(WIFI, client_step_s=-30.0))
    with database.reading() as db:
        clock = run_clocks(db, session_id)[1]
    assert [segment.stepped for segment in clock.mapping.segments if segment.stepped] == ["client"]
    utc, uncertainty_ms = clock.to_utc(np.sort(simulated.event_client_s))
    assert (np.diff(utc) >= np.timedelta64(0, "us")).all()
    assert uncertainty_ms.max() == pytest.approx(30_000.0, rel=0.01)


def test_contacts_and_completions_have_utc(database: Database) -> None:
    """Contacts and completed tasks have their UTC and its uncertainty."""
    with database.writing() as db:
        build_session(db, SessionSpec("P-0001"))
    with database.reading() as db:
        contacts = contacts_table(db, STUDY, "people")
        completions = completions_table(db, STUDY, "people")
    for frame, seconds, utc in (
        (contacts, "begin_s", "begin_utc"),
        (completions, "at_s", "at_utc"),
    ):
        expected = pd.Timestamp(NOW) + pd.to_timedelta(frame[seconds] + 0.010, unit="s")
        late_s = (frame[utc] - expected).dt.total_seconds()
        assert late_s.abs().max() < 1e-5
        assert frame["clock_uncertainty_ms"].between(2.0, 3.0).all()
        assert set(frame["epoch"]) == {1}


def test_without_probes_there_is_no_utc(database: Database) -> None:
    """A run of the client without clock probes has no UTC, even if another run has."""
    session_id = _session(database)
    with database.reading() as db:
        contacts = contacts_table(db, STUDY, "people")
        assert len(clock_probes_table(db, STUDY, "people")) == 0
        assert run_clocks(db, session_id) == {}
    assert contacts["begin_utc"].isna().all()
    assert contacts["clock_uncertainty_ms"].isna().all()
    _stored(database, session_id, WIFI)
    with database.writing() as db:
        db.execute(update(Contact).where(Contact.begin_s < 1.5).values(epoch=2))
    with database.reading() as db:
        contacts = contacts_table(db, STUDY, "people")
    assert (contacts["begin_utc"].isna() == (contacts["epoch"] == 2)).all()
    assert set(contacts["epoch"]) == {1, 2}


@pytest.mark.one_engine
def test_an_accelerated_clock_is_mapped_by_its_time_scale(database: Database) -> None:
    """At a time scale of ten, a minute of the client's clock is six seconds of UTC."""
    session_id = _session(database, "simulated")
    probes = simulate(replace(WIFI, drift_ppm=0.0), np.random.default_rng(1)).probes
    with database.writing() as db:
        db.execute(update(StudySession).values(time_scale=10.0))
        store_probes(db, session_id, probes, time_scale=10.0)
    with database.reading() as db:
        clock = run_clocks(db, session_id)[1]
        rows = clock_mapping_table(db, STUDY, "simulated")
        stored = clock_probes_table(db, STUDY, "simulated")
    utc, _ = clock.to_utc(np.array([14_000.0, 14_060.0]))
    assert np.diff(utc)[0] / np.timedelta64(1, "s") == pytest.approx(6.0, abs=0.001)
    assert rows["drift_ppm"].abs().max() < 20.0
    passed = (rows["to_utc"] - rows["from_utc"]).dt.total_seconds()
    lengths_s = (rows["to_s"] - rows["from_s"]) / 10.0
    assert passed.tolist() == pytest.approx(lengths_s.tolist(), rel=20e-6)
    assert stored["round_trip_ms"].min() == pytest.approx(4.0, abs=0.5)


def test_the_clock_tables_have_probes_and_segments(database: Database) -> None:
    """The clock tables contain every probe, answered or not, and the segments of the mapping."""
    with database.writing() as db:
        session_id = build_session(db, SessionSpec("P-0001")).id
    with database.reading() as db:
        probes = clock_probes_table(db, STUDY, "people")
        rows = clock_mapping_table(db, STUDY, "people")
        clock = run_clocks(db, session_id)[1]
    assert probes["timed_out"].tolist() == [False, False, True] + 117 * [False]
    answered = probes[~probes["timed_out"]]
    assert answered["round_trip_ms"].to_numpy() == pytest.approx(4.0, abs=1e-3)
    assert answered["offset_s"].to_numpy() == pytest.approx(5000.0, abs=1e-6)
    assert answered["server_received_s"].to_numpy() == pytest.approx(
        answered["client_sent_s"].to_numpy() + 5000.002, abs=1e-6
    )
    assert probes[probes["timed_out"]]["server_sent_s"].isna().all()
    assert rows["probes"].sum() == 119
    assert rows["segment"].tolist() == list(range(1, len(rows) + 1))
    assert rows["offset_s"].to_numpy() == pytest.approx(5000.0, abs=1e-6)
    first = rows.iloc[0]
    half_utc, _ = clock.to_utc(np.array([0.5 * (first["from_s"] + first["to_s"])]))
    reported = first["from_utc"] + 0.5 * (first["to_utc"] - first["from_utc"])
    assert abs((pd.Timestamp(half_utc[0], tz="UTC") - reported).total_seconds()) < 1e-5
