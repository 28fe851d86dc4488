"""Tests of uploading, listing, changing and deleting captures."""

import hashlib

import pytest
from sqlalchemy import func, select

from app.models import CaptureContent, CapturePiece, CaptureRow, HumanoidRow
from tests.api.people import sign_in
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.captures.files import upload, uploaded, walk_bvh

WALK = walk_bvh()


def counted(lab: Lab) -> tuple[int, int, int]:
    """Return the numbers of stored captures, contents and pieces, without those of bodies."""
    bodies = select(HumanoidRow.hash)
    with lab.database.reading() as db:
        return (
            db.scalars(select(func.count(CaptureRow.id))).one(),
            db.scalars(
                select(func.count(CaptureContent.hash)).where(CaptureContent.hash.not_in(bodies))
            ).one(),
            db.scalars(
                select(func.count(CapturePiece.hash)).where(CapturePiece.hash.not_in(bodies))
            ).one(),
        )


def test_an_uploaded_capture_is_described_and_downloaded_unchanged(fresh_lab: Lab) -> None:
    """An uploaded capture is described by its content, and its file downloads unchanged."""
    view = uploaded(fresh_lab.operator, WALK)
    assert (view["format"], view["kind"], view["frames"]) == ("bvh", "skeleton", 150)
    assert (view["rate_hz"], view["tracks"], view["size_bytes"]) == (30.0, 21, len(WALK))
    assert view["content_hash"] == hashlib.sha256(WALK).hexdigest()
    assert view["by"] == "account:admin"
    summary = view["summary"]
    assert summary["names"][0] == "Hips"
    assert summary["observed"] == 1.0
    assert summary["skeleton"]["parents"][0] == -1
    assert set(summary["conventions"]) == {"length", "axes", "rotations", "rate"}
    path = f"/api/captures/{view['id']}"
    assert ok(fresh_lab.operator.get(path)) == view
    answer = fresh_lab.operator.get(f"{path}/file")
    assert answer.content == WALK
    assert "walk.bvh" in answer.headers["content-disposition"]
    listed = ok(fresh_lab.operator.get("/api/captures"))
    assert listed["total"] == 1
    assert listed["captures"] == [{name: view[name] for name in listed["captures"][0]}]


def test_the_same_content_is_stored_once(fresh_lab: Lab) -> None:
    """Uploading the same content under another name returns the first capture."""
    first = upload(fresh_lab.operator, WALK)
    repeated = upload(fresh_lab.operator, WALK, "copy.bvh")
    assert (first.status_code, repeated.status_code) == (201, 200)
    assert repeated.json() == first.json()
    assert counted(fresh_lab)[0] == 1


@pytest.mark.one_engine
def test_an_unreadable_capture_is_refused(fresh_lab: Lab) -> None:
    """An unreadable capture is refused with file, line and reason, and not stored."""
    broken = WALK.replace(b"Frame Time", b"Frome Time")
    refusal = error(upload(fresh_lab.operator, broken), 422, "invalid_input")
    (where,) = refusal["details"]
    assert where["path"] == "walk.bvh"
    assert where["line"] == broken[: broken.index(b"Frome")].count(b"\n") + 1
    assert where["message"] in refusal["message"]
    for nothing in (b"", b"hello", bytes(1000)):
        error(upload(fresh_lab.operator, nothing), 422, "invalid_input")
    assert counted(fresh_lab) == (0, 0, 0)


@pytest.mark.one_engine
def test_a_chosen_unit_rereads_the_file(fresh_lab: Lab) -> None:
    """Choosing another unit rereads the file and marks the convention as chosen."""
    view = uploaded(fresh_lab.operator, WALK)
    assert view["summary"]["conventions"]["length"]["origin"] == "guessed"
    path = f"/api/captures/{view['id']}"
    request = {"reading": {"metres_per_unit": 0.0254}, "title": " A walk "}
    changed = ok(fresh_lab.operator.patch(path, json=request))
    assert changed["title"] == "A walk"
    assert changed["reading"] == {"metres_per_unit": 0.0254, "up": None}
    assert changed["summary"]["conventions"]["length"]["origin"] == "chosen"
    back = ok(fresh_lab.operator.patch(path, json={"reading": {}}))
    assert back["summary"] == view["summary"]
    error(fresh_lab.operator.patch(path, json={"reading": {"up": "w"}}), 422, "invalid_input")


def test_deleting_a_capture_deletes_its_content(fresh_lab: Lab) -> None:
    """Deleting a capture deletes its content unless another uses it, and is recorded."""
    view = uploaded(fresh_lab.operator, WALK)
    other = uploaded(fresh_lab.operator, walk_bvh(60), "short.bvh")
    with fresh_lab.database.writing() as db:
        row = db.get_one(CaptureRow, other["id"])
        row.companion_name, row.companion_hash = "walk.bvh", view["content_hash"]
    assert fresh_lab.operator.delete(f"/api/captures/{view['id']}").status_code == 204
    assert counted(fresh_lab)[:2] == (1, 2)
    assert fresh_lab.operator.delete(f"/api/captures/{other['id']}").status_code == 204
    assert counted(fresh_lab) == (0, 0, 0)
    error(fresh_lab.operator.get(f"/api/captures/{view['id']}"), 404, "not_found")
    trail: list[Json] = ok(fresh_lab.operator.get("/api/audit?action=capture."))["entries"]
    assert [one["action"] for one in trail] == ["capture.removed"] * 2 + ["capture.added"] * 2
    assert {one["subject"] for one in trail} == {
        f"capture:{view['id']}",
        f"capture:{other['id']}",
    }
    assert "walk" not in str(trail)


@pytest.mark.one_engine
def test_a_companion_needs_name_and_size(fresh_lab: Lab) -> None:
    """A companion file without both name and size, or as large as the whole upload, is refused."""
    operator = fresh_lab.operator
    error(upload(operator, WALK, companion="01.asf"), 422, "invalid_input")
    error(upload(operator, WALK, companion_bytes=5), 422, "invalid_input")
    whole = upload(operator, WALK, companion="01.asf", companion_bytes=len(WALK))
    error(whole, 422, "invalid_input")
    assert counted(fresh_lab) == (0, 0, 0)


@pytest.mark.one_engine
def test_only_designers_may_change_captures(lab: Lab) -> None:
    """Operators and analysts may see captures, but only study designers may change them."""
    view = uploaded(lab.operator, WALK)
    path = f"/api/captures/{view['id']}"
    for role in ("operator", "analyst"):
        client = sign_in(lab, role, studies=[])
        assert ok(client.get(path))["id"] == view["id"]
        error(upload(client, WALK), 403, "not_allowed")
        error(client.delete(path), 403, "not_allowed")
        error(client.patch(path, json={"title": "mine"}), 403, "not_allowed")
    ok(sign_in(lab, "experimenter", studies=[]).patch(path, json={"title": "ours"}))
