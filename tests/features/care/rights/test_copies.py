"""Tests that copies of the data are recorded, and that an erasure lists them."""

import io
import json
import subprocess
import sys
import zipfile
from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.platform.incomplete_files import Notes, partial_folder
from app.settings import Settings
from tests.faults.commands import reembody
from tests.features.care.rights.visit import erase, in_bytes, make_visit, participant_of
from tests.features.lab import STUDY, Json, error, ok
from tests.features.record.headset.site import Site
from tests.platform.test_incomplete_files import KILLED


def copies(site: Site) -> list[Json]:
    """Return the recorded copies of the study, newest first."""
    listed: list[Json] = ok(site.operator.get(f"/api/studies/{STUDY}/copies"))
    return listed


@pytest.mark.one_engine
def test_every_kind_of_copy_is_recorded(site: Site, tmp_path: Path) -> None:
    """Browser export, command-line export, backup and a participant's own copy are all recorded."""
    visit = make_visit(site, "copied-1")
    before = len(copies(site))
    ok_bytes(site, f"/api/studies/{STUDY}/export?kind=people")
    ok_bytes(site, f"/api/studies/{STUDY}/participants/{visit.participant_id}/access")
    export = ("export", "--study", STUDY, "--to", tmp_path / "export", "--kind", "people")
    assert reembody(site.server, *export).code == 0
    assert reembody(site.server, "backup", tmp_path / "all.reembody").code == 0
    made = copies(site)[: len(copies(site)) - before]
    assert [(one["kind"], one["session_kind"]) for one in reversed(made)] == [
        ("export", "people"),
        ("access", "people"),
        ("export", "people"),
        ("backup", None),
    ]
    assert made[0]["place"] == str(tmp_path / "all.reembody")
    assert made[0]["bytes"] == (tmp_path / "all.reembody").stat().st_size
    assert made[3]["place"] == "downloaded by admin"
    of_participant = participant_of(site, visit.session_id)["copies"]
    assert {one["id"] for one in made} <= {one["id"] for one in of_participant}


def test_an_erasure_lists_the_copies_that_may_contain_the_data(site: Site) -> None:
    """An erasure lists the copies that may contain the participant's data, and no others.

    Copies of other kinds of sessions or of other participants are left out. Marking a copy as
    destroyed twice has no further effect.
    """
    visit, other = make_visit(site, "copied-2"), make_visit(site, "copied-3")
    ok_bytes(site, f"/api/studies/{STUDY}/export?kind=simulated")
    ok_bytes(site, f"/api/studies/{STUDY}/export?kind=all")
    ok_bytes(site, f"/api/studies/{STUDY}/participants/{other.participant_id}/access")
    ok_bytes(site, f"/api/studies/{STUDY}/participants/{visit.participant_id}/access")
    own, theirs, everything, simulated = copies(site)[:4]
    site.command(visit.session_id, "withdraw", reason="enough")
    left = {one["id"] for one in erase(site, visit)["remaining"]}
    assert {own["id"], everything["id"]} <= left
    assert not {theirs["id"], simulated["id"]} & left
    for _ in range(2):
        marked = ok(site.operator.post(f"/api/copies/{own['id']}/destroyed"))
        assert marked["destroyed_by"] == "account:admin"
    remaining = participant_of(site, visit.session_id)["erasure"]["remaining"]
    assert [one["id"] for one in remaining if one["destroyed_at"]] == [own["id"]]
    error(site.operator.post("/api/copies/nothing/destroyed"), 404, "not_found")


def test_an_erasure_covers_incomplete_files(site: Site, tmp_path: Path) -> None:
    """An erasure deletes incomplete files left by a crash and lists an unfinished export."""
    visit = make_visit(site, "copied-6")
    site.command(visit.session_id, "withdraw", reason="enough")
    # Notes are stored next to the database, which is not in the server's data folder here.
    file = site.database.engine.url.database if site.database.is_sqlite else None
    data = Path(file).parent if file else site.server.data_dir
    subprocess.run(
        [sys.executable, "-c", KILLED, str(data), str(tmp_path / "left"), STUDY], check=False
    )
    (left,) = tmp_path.iterdir()
    settings = Settings(data_dir=data)
    to = tmp_path / "export"
    now = datetime.now(UTC)
    with partial_folder("export", to, now=now, notes=Notes.of(settings), study_key=STUDY):
        shown = ok(site.operator.get("/api/storage"))["half_made"]
        assert {(one["place"], one["going_on"]) for one in shown} >= {(str(left), False)}
        places = [one["place"] for one in erase(site, visit)["remaining"]]
    assert str(to) in places
    assert str(tmp_path / "left") not in places
    assert list(tmp_path.iterdir()) == []


def test_a_participants_own_copy_contains_all_their_data(site: Site) -> None:
    """A participant's own copy contains all of their answers, notes, consent and samples."""
    visit, other = make_visit(site, "copied-4"), make_visit(site, "copied-5")
    site.command(visit.session_id, "note", text="<script>alert(1)</script>")
    content = ok_bytes(site, f"/api/studies/{STUDY}/participants/{visit.participant_id}/access")
    with zipfile.ZipFile(io.BytesIO(content)) as files:
        names = files.namelist()
        page = files.read("your-data.html").decode()
        words = json.loads(files.read("words.json"))
        sessions = files.read("sessions.csv").decode()
        samples = files.read(next(name for name in names if name.startswith("samples/")))
    assert names[0] == "your-data.html"
    assert "What is your profession or field of study?" in page
    assert f"<dd>{visit.code}</dd>" in page
    assert "&lt;script&gt;" in page
    assert "<script" not in page
    assert visit.session_id in sessions
    assert samples.count(b"\n") > 180
    assert {"note", "reason", "refused_form"} <= {row["kind"] for row in words}
    assert in_bytes(visit, content) > 180
    assert in_bytes(other, content) == 0
    assert other.session_id.encode() not in content


def ok_bytes(site: Site, path: str) -> bytes:
    """Return the body of a successful download."""
    answer = site.operator.get(path)
    assert answer.is_success, answer.text
    return answer.content
