"""Tests of disk usage on both engines: total, shares of studies and sessions, forecast."""

import pytest
from sqlalchemy import text

import app.features.care.storage.tables as tables
from app.database import Base
from app.features.care.storage.families import FAMILIES, FAMILY_OF
from app.wire import BODY_STREAMS
from tests.features.builders import STUDY, SessionSpec, build_session
from tests.features.lab import Json, Lab, ok
from tests.features.movement_builders import moving_values, store_chunks

FRAMES = {"ROOM-1": 1800, "ROOM-2": 900, "ROOM-3": 0}


@pytest.fixture(scope="module")
def usage(lab: Lab) -> Json:
    """Return the disk usage of three completed sessions with different amounts of movement."""
    with lab.database.writing() as db:
        for code, frames in FRAMES.items():
            session = build_session(db, SessionSpec(code))
            if frames:
                for seed, stream in enumerate(BODY_STREAMS):
                    values = moving_values(frames, seed)
                    store_chunks(db, session.id, stream, range(frames), values)
    reply: Json = ok(lab.operator.get("/api/storage", params={"anew": True}))
    return reply


def test_every_table_is_in_exactly_one_group() -> None:
    """Every table of the database is listed in exactly one group of the disk usage."""
    named = [table for family in FAMILIES.values() for table in family]
    assert sorted(named) == sorted({*Base.metadata.tables, "alembic_version"})
    assert len(FAMILY_OF) == len(named)


def test_the_parts_add_up_to_the_database_size(lab: Lab, usage: Json) -> None:
    """On SQLite, tables and unused pages add up to the size of the database file."""
    parts = {part["place"]: part["bytes"] for part in usage["parts"]}
    assert parts.keys() >= FAMILIES.keys()
    if usage["engine"] == "sqlite":
        with lab.database.reading() as db:
            pages = int(db.scalar(text("PRAGMA page_count")) or 0)
            size = int(db.scalar(text("PRAGMA page_size")) or 0)
        inside = sum(parts[place] for place in parts if place in (*FAMILIES, "unused"))
        assert (usage["method"], inside) == ("dbstat", pages * size)
    else:
        with lab.database.reading() as db:
            reported = db.scalar(text("SELECT pg_total_relation_size('telemetry_chunks')"))
        assert usage["method"] == "pg_total_relation_size"
        assert reported is not None
        assert parts["samples"] >= reported


def test_a_sessions_size_follows_its_recorded_movement(usage: Json) -> None:
    """Twice the movement takes about twice the space; sessions add up to their study's size."""
    sizes = {row["participant_code"]: row["bytes"] for row in usage["sessions"]}
    moved = {code: sizes[code] - sizes["ROOM-3"] for code in FRAMES}
    assert moved["ROOM-1"] == pytest.approx(2 * moved["ROOM-2"], rel=0.1)
    (study,) = (row for row in usage["studies"] if row["key"] == STUDY)
    assert study["bytes"] == pytest.approx(sum(sizes.values()), abs=len(sizes))
    assert [row["bytes"] for row in usage["sessions"]] == sorted(sizes.values(), reverse=True)
    assert usage["sessions_total"] == len(FRAMES)


def test_the_forecast_is_free_space_over_mean_session_size(lab: Lab, usage: Json) -> None:
    """The forecast is the free space above the threshold, divided by the mean size of a session.

    Sessions without movement are left out of the mean, as they are much smaller than others.
    """
    disk = usage["disk"]
    assert disk["warn_below_bytes"] == lab.context.settings.low_disk_bytes
    (study,) = (row for row in usage["studies"] if row["key"] == STUDY)
    assert (study["measured"], study["measured_kind"]) == (2, "people")
    sizes = {row["participant_code"]: row["bytes"] for row in usage["sessions"]}
    assert study["mean_bytes"] == pytest.approx((sizes["ROOM-1"] + sizes["ROOM-2"]) / 2, abs=1)
    if usage["engine"] == "postgresql":
        assert (disk["holds_database"], study["room_for"]) == (False, None)
        return
    left = disk["free_bytes"] - disk["warn_below_bytes"]
    assert study["room_for"] == pytest.approx(left / study["mean_bytes"], rel=1e-3)


def test_a_full_disk_is_reported_with_no_sessions_left(lab: Lab, usage: Json) -> None:
    """Below the threshold, low disk space is reported, with room for no further session."""
    storage = lab.context.storage
    before, storage.free_bytes = storage.free_bytes, lambda _: 1000
    try:
        reply: Json = ok(lab.operator.get("/api/storage"))
    finally:
        storage.free_bytes = before
    assert reply["disk"]["is_low"] is True
    (study,) = (row for row in reply["studies"] if row["key"] == STUDY)
    assert study["room_for"] in (0, None)
    assert reply["measured_at"] == usage["measured_at"]


def test_without_dbstat_the_total_is_still_reported(
    lab: Lab, usage: Json, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A SQLite without `dbstat` still reports the database's total size, without parts.

    PostgreSQL measures its sizes in another way and is not affected.
    """
    monkeypatch.setattr(tables, "_DBSTAT", text("SELECT name, pgsize FROM no_dbstat"))
    reply: Json = ok(lab.operator.get("/api/storage", params={"anew": True}))
    parts = {part["place"]: part["bytes"] for part in reply["parts"]}
    if usage["engine"] != "sqlite":
        assert reply["method"] == "pg_total_relation_size"
        return
    assert reply["method"] == "page_counts"
    assert parts["database"] > 0
    assert not parts.keys() & FAMILIES.keys()
