"""Tests of walks extracted from stored captures, and of fits interrupted by a server stop."""

import hashlib
from pathlib import Path

import pytest
from sqlalchemy.orm import Session

from app.database import make_engine
from app.features.movement.files import compress, store
from app.features.movement.walking.fit_queue import FitQueue
from app.features.movement.walking.sources import Cannot, CapturedWalk, Store, TrackSource
from app.features.movement.walking.worker_tasks import captured_table
from app.models import WalkingModelRow
from tests.features.lab import Lab, ok
from tests.features.movement.captures.files import SPEED_M_S, walk_bvh


def store_content(url: str, data: bytes, folder: Path) -> str:
    """Store a content as an upload does and return its hash."""
    file, packed = folder / "file", folder / "packed"
    file.write_bytes(data)
    compress(file, packed)
    content_hash = hashlib.sha256(data).hexdigest()
    engine = make_engine(url)
    with Session(engine) as db:
        store(db, content_hash, len(data), packed)
        db.commit()
    engine.dispose()
    return content_hash


def captured_walk(content_hash: str) -> CapturedWalk:
    """Return a stored BVH file as a capture of a walk."""
    return CapturedWalk("walk.bvh", content_hash, None, None, None, None, None, 10**7)


def test_a_walk_is_extracted_from_a_capture(database_url: str, tmp_path: Path) -> None:
    """A walk extracted from a captured skeleton has its person, speed and stature."""
    content = store_content(database_url, walk_bvh(150), tmp_path)
    walk = captured_walk(content)
    source = TrackSource("captures", "", subjects=(("c0", "Ann"),), statures_m=(("Ann", 1.7),))
    found = captured_table(Store(database_url), (("c0", walk),), source)
    assert found.table.startswith(b"id,time_s,x_m,y_m\nc0,0.0,")
    assert (found.summary["walks"], found.summary["people"]) == (1, 1)
    # It begins and ends in mid-stride.
    assert found.summary["cut_by_recording"] == 1
    assert found.summary["speed_m_s"]["mean"] == pytest.approx(SPEED_M_S, rel=0.05)
    assert found.summary["dependencies"]["stature_m"]["low"] == 1.7


@pytest.mark.one_engine
def test_a_deleted_capture_is_reported(database_url: str) -> None:
    """Extracting a walk from a capture that is no longer stored is an error."""
    walk = captured_walk("0" * 64)
    with pytest.raises(Cannot, match="no longer stored"):
        captured_table(Store(database_url), (("c0", walk),), TrackSource("captures", ""))


def test_an_interrupted_fit_is_marked_as_stopped(fresh_lab: Lab) -> None:
    """A fit that was interrupted by the server's end is marked as stopped at the next start."""
    row = WalkingModelRow(
        title="Left",
        kind="human",
        state="fitting",
        walk_set={"title": "Gone", "origin": "tracks"},
        scene=None,
        options={},
        by="account:admin",
        at=fresh_lab.context.clock.utc_now(),
    )
    with fresh_lab.database.writing() as db:
        db.add(row)
    fresh_lab.context.part(FitQueue).start()
    (listed,) = ok(fresh_lab.operator.get("/api/walking/models"))
    assert (listed["state"], listed["trouble"]) == ("stopped", None)
