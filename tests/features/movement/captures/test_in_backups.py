"""A test that captures are contained in backups."""

from pathlib import Path

import pytest

from app.database import open_database
from app.features.movement.files import contents, plain_pieces
from app.models import CapturePiece, CaptureRow, SavedJointMap
from tests.features.care.backups.lab import make, put_back
from tests.features.lab import Lab, ok
from tests.features.movement.captures.files import uploaded, walk_bvh
from tests.support.sqlite import fresh_sqlite


def test_a_restored_capture_is_the_file_that_was_uploaded(
    fresh_lab: Lab, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A restored capture is the uploaded file, in small pieces, with its summary and joint map."""
    monkeypatch.setattr(contents, "PIECE_BYTES", 4096)
    walk = walk_bvh(2_000)
    view = uploaded(fresh_lab.operator, walk)
    reply = ok(fresh_lab.operator.get(f"/api/captures/{view['id']}/joint-map"))
    request = {"joint_map": reply["joint_map"], "version": 0}
    ok(fresh_lab.operator.put(f"/api/captures/{view['id']}/joint-map", json=request))
    make(fresh_lab.database, tmp_path / "all.reembody")
    other = open_database(fresh_sqlite(tmp_path / "other.sqlite"))
    put_back(other, tmp_path / "all.reembody")
    with other.reading() as db:
        pieces = list(plain_pieces(db, view["content_hash"]))
        row = db.get_one(CaptureRow, view["id"])
        saved = db.query(SavedJointMap).one()
        own = db.query(CapturePiece.data).filter_by(hash=view["content_hash"])
        sizes = [len(piece) for (piece,) in own]
    other.close()
    assert b"".join(pieces) == walk
    assert len(sizes) > 1
    assert max(sizes) == 4096
    assert row.summary["names"] == view["summary"]["names"]
    assert saved.joint_map == reply["joint_map"]
