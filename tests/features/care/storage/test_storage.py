"""What takes how much room, on both engines: sums that fit, shares that follow, a forecast."""

import pytest
from sqlalchemy import text

import app.features.care.storage.tables as tables
from app.database import Base
from app.features.care.storage.families import FAMILIES, FAMILY_OF
from app.wire import StreamName
from tests.features.builders import STUDY, SessionSpec, build_session
from tests.features.lab import Json, Lab, ok
from tests.features.movement_builders import moving_values, store_chunks

FRAMES = {"ROOM-1": 1800, "ROOM-2": 900, "ROOM-3": 0}


@pytest.fixture(scope="module")
def room(lab: Lab) -> Json:
    """What is told of three completed sessions of people, with unlike lengths of movement."""
    with lab.database.writing() as db:
        for code, frames in FRAMES.items():
            session = build_session(db, SessionSpec(code))
            if frames:
                for seed, stream in enumerate(StreamName):
                    values = moving_values(frames, seed)
                    store_chunks(db, session.id, stream, range(frames), values)
    told: Json = ok(lab.operator.get("/api/storage", params={"anew": True}))
    return told


def test_every_table_belongs_somewhere() -> None:
    """A table of a new migration has to be named, once."""
    named = [table for family in FAMILIES.values() for table in family]
    assert sorted(named) == sorted({*Base.metadata.tables, "alembic_version"})
    assert len(FAMILY_OF) == len(named)


def test_the_parts_make_the_whole(lab: Lab, room: Json) -> None:
    """Tables and unused pages are the file, to the byte, on SQLite; PostgreSQL tells its own."""
    parts = {part["place"]: part["bytes"] for part in room["parts"]}
    assert parts.keys() >= FAMILIES.keys()
    if room["engine"] == "sqlite":
        with lab.database.reading() as db:
            pages = int(db.scalar(text("PRAGMA page_count")) or 0)
            size = int(db.scalar(text("PRAGMA page_size")) or 0)
        inside = sum(parts[place] for place in parts if place in (*FAMILIES, "unused"))
        assert (room["method"], inside) == ("dbstat", pages * size)
    else:
        with lab.database.reading() as db:
            told = db.scalar(text("SELECT pg_total_relation_size('telemetry_chunks')"))
        assert room["method"] == "pg_total_relation_size"
        assert told is not None
        assert parts["samples"] >= told


def test_a_session_takes_what_was_recorded_in_it(room: Json) -> None:
    """Twice the movement takes about twice the room, and all sessions are in the study's sum."""
    sizes = {row["participant_code"]: row["bytes"] for row in room["sessions"]}
    moved = {code: sizes[code] - sizes["ROOM-3"] for code in FRAMES}
    assert moved["ROOM-1"] == pytest.approx(2 * moved["ROOM-2"], rel=0.1)
    (study,) = (row for row in room["studies"] if row["key"] == STUDY)
    assert study["bytes"] == pytest.approx(sum(sizes.values()), abs=len(sizes))
    assert [row["bytes"] for row in room["sessions"]] == sorted(sizes.values(), reverse=True)
    assert room["sessions_total"] == len(FRAMES)


def test_the_forecast_is_the_free_room_over_the_mean(lab: Lab, room: Json) -> None:
    """Free space above the pre-flight's threshold by the mean of the sessions with movement.

    One without movement is a fraction of the size of the next, and would promise room for many.
    """
    disk = room["disk"]
    assert disk["warn_below_bytes"] == lab.context.settings.low_disk_bytes
    (study,) = (row for row in room["studies"] if row["key"] == STUDY)
    assert (study["measured"], study["measured_kind"]) == (2, "people")
    sizes = {row["participant_code"]: row["bytes"] for row in room["sessions"]}
    assert study["mean_bytes"] == pytest.approx((sizes["ROOM-1"] + sizes["ROOM-2"]) / 2, abs=1)
    if room["engine"] == "postgresql":
        assert (disk["holds_database"], study["room_for"]) == (False, None)
        return
    left = disk["free_bytes"] - disk["warn_below_bytes"]
    assert study["room_for"] == pytest.approx(left / study["mean_bytes"], rel=1e-3)


def test_a_full_disk_is_told_with_no_room_left(lab: Lab, room: Json) -> None:
    """Below the threshold nothing more fits, and the page is warned."""
    storage = lab.context.storage
    before, storage.free_bytes = storage.free_bytes, lambda _: 1000
    try:
        told: Json = ok(lab.operator.get("/api/storage"))
    finally:
        storage.free_bytes = before
    assert told["disk"]["is_low"] is True
    (study,) = (row for row in told["studies"] if row["key"] == STUDY)
    assert study["room_for"] in (0, None)
    assert told["measured_at"] == room["measured_at"]


def test_without_dbstat_the_whole_is_still_told(
    lab: Lab, room: Json, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A SQLite that has no such table gives the pages of the database; sessions then have none.

    PostgreSQL knows its sizes in another way, and goes on telling them.
    """
    monkeypatch.setattr(tables, "_DBSTAT", text("SELECT name, pgsize FROM no_dbstat"))
    told: Json = ok(lab.operator.get("/api/storage", params={"anew": True}))
    parts = {part["place"]: part["bytes"] for part in told["parts"]}
    if room["engine"] != "sqlite":
        assert told["method"] == "pg_total_relation_size"
        return
    assert told["method"] == "page_counts"
    assert parts["database"] > 0
    assert not parts.keys() & FAMILIES.keys()
