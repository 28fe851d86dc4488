"""Tests of corrections: the first answer is stored, and the newest is used everywhere."""

import csv
import io
import zipfile

import pytest
from sqlalchemy import select

from app.features.record.headset import participant_info
from app.features.record.sessions import contents_of, events_of, verify_chain
from app.features.record.sessions.contents import salted_hash
from app.models import Answer
from app.platform.access import session_by_id
from app.science.instruments import score_answers
from tests.features.care.rights.visit import Visit, make_visit
from tests.features.lab import STUDY, Json, error, ok
from tests.features.record.headset.site import Site


def forms(site: Site, visit: Visit) -> dict[str, Json]:
    """Return the stored forms of a visit, by instrument."""
    stored = ok(site.operator.get(f"/api/sessions/{visit.session_id}/answers"))
    return {form["instrument"]: form for form in stored}


def correct(site: Site, visit: Visit, form: Json, item: str, value: object) -> Json:
    """Correct an answer with a reason; return the corrected form."""
    path = f"/api/sessions/{visit.session_id}/submissions/{form['submission_id']}/corrections"
    body = {"item": item, "value": value, "reason": "They said so afterwards."}
    after: Json = ok(site.operator.post(path, json=body))
    return after


def exported(site: Site, name: str) -> list[dict[str, str]]:
    """Return the rows of one table of a new export."""
    archive = site.operator.get(f"/api/studies/{STUDY}/export?kind=people").content
    with zipfile.ZipFile(io.BytesIO(archive)) as files:
        return list(csv.DictReader(io.StringIO(files.read(f"{name}.csv").decode())))


def test_the_newest_value_counts_and_every_earlier_one_is_kept(site: Site) -> None:
    """A corrected answer has its newest value in forms and exports; earlier values are kept."""
    visit = make_visit(site, "corrected-1")
    form = forms(site, visit)["karas2020"]
    item = "q1"
    correct(site, visit, form, item, 5)
    after = correct(site, visit, form, item, 7)
    assert after["answers"] == {**form["answers"], item: 7.0}
    reported = [(one["previous"], one["value"]) for one in after["corrections"]]
    assert reported == [(1.0, 5.0), (5.0, 7.0)]
    assert after["corrections"][0]["reason"] == "They said so afterwards."
    with site.database.reading() as db:
        given = db.get_one(Answer, (form["submission_id"], item))
        assert given.value_number == 1.0
        session = session_by_id(db, visit.session_id)
        assert verify_chain(events_of(db, session.id), version=session.version).ok
    rows = [row for row in exported(site, "answers") if row["session_id"] == visit.session_id]
    mine = [row for row in rows if row["submission_id"] == form["submission_id"]]
    assert {row["item"]: row["value_number"] for row in mine}[item] == "7.0"
    assert [row["item"] for row in mine if row["corrected"] == "true"] == [item]
    kept = [row for row in exported(site, "corrections") if row["session_id"] == visit.session_id]
    assert [(row["previous_number"], row["value_number"]) for row in kept] == [
        ("1.0", "5.0"),
        ("5.0", "7.0"),
    ]
    assert kept[0]["by"] == "account:admin"


def test_scores_are_recomputed_from_corrected_answers(site: Site) -> None:
    """Scores are recomputed from corrected answers; the stored answers give the first scores."""
    visit = make_visit(site, "corrected-2")
    form = forms(site, visit)["karas2020"]
    item = "q1"
    after = correct(site, visit, form, item, 7)
    from app.features.design.instruments import instrument_of
    from app.models import InstrumentVersion, Submission

    with site.database.reading() as db:
        version = db.get_one(Submission, form["submission_id"]).instrument_version_id
        instrument = instrument_of(db.get_one(InstrumentVersion, version))
        rows = db.scalars(select(Answer).where(Answer.submission_id == form["submission_id"])).all()
        first = {row.item: row.value_text or row.value_number for row in rows}
    assert after["scores"] == score_answers(instrument, after["answers"])
    assert form["scores"] == score_answers(instrument, first)
    assert after["scores"] != form["scores"]


@pytest.mark.one_engine
def test_the_headset_uses_corrected_demographics(site: Site) -> None:
    """The headset gets a participant's handedness as corrected."""
    visit = make_visit(site, "corrected-3")
    form = forms(site, visit)["demographics"]
    with site.database.reading() as db:
        before = participant_info(db, session_by_id(db, visit.session_id))
    other = "left" if before.handedness != "left" else "right"
    correct(site, visit, form, "handedness", other)
    with site.database.reading() as db:
        after = participant_info(db, session_by_id(db, visit.session_id))
    assert (before.handedness, after.handedness) == (form["answers"]["handedness"], other)


@pytest.mark.one_engine
def test_the_event_log_has_only_a_salted_hash_of_a_correction(site: Site) -> None:
    """The event log has only a salted hash of a correction's value and reason."""
    visit = make_visit(site, "corrected-4")
    form = forms(site, visit)["demographics"]
    correct(site, visit, form, "occupation", "a secret agent")
    events = ok(site.operator.get(f"/api/sessions/{visit.session_id}/events"))
    assert events[-1]["type"] == "answers_corrected"
    assert "secret" not in str(events)
    with site.database.reading() as db:
        content = contents_of(db, visit.session_id, "correction")[-1]
        assert content.salt is not None
        assert "a secret agent" in (content.body or "")
        expected = salted_hash(content.salt, content.body or "")
    assert events[-1]["data"]["content_hash"] == expected


@pytest.mark.one_engine
def test_an_invalid_correction_is_refused(site: Site) -> None:
    """A correction with an invalid value or item, no reason, or no change is refused."""
    visit = make_visit(site, "corrected-5")
    form = forms(site, visit)["karas2020"]
    item = "q1"
    path = f"/api/sessions/{visit.session_id}/submissions/{form['submission_id']}/corrections"
    for wrong in (
        {"item": item, "value": 99},
        {"item": item, "value": "seven"},
        {"item": item, "value": 1},
        {"item": "nothing", "value": 1},
        {"item": item, "value": 3, "reason": "  "},
    ):
        body = {"reason": "typed wrongly", **wrong}
        error(site.operator.post(path, json=body), 422, "invalid_input")
    stranger = make_visit(site, "corrected-6")
    path = path.replace(visit.session_id, stranger.session_id)
    body = {"item": item, "value": 3, "reason": "typed wrongly"}
    error(site.operator.post(path, json=body), 404, "not_found")
    assert forms(site, visit)["karas2020"] == form


@pytest.mark.one_engine
def test_an_answer_can_be_removed_by_a_correction(site: Site) -> None:
    """An answer corrected to null counts as left out, and scores that need it have no value."""
    visit = make_visit(site, "corrected-7")
    form = forms(site, visit)["karas2020"]
    item = "q1"
    after = correct(site, visit, form, item, None)
    assert after["answers"][item] is None
    assert None in after["scores"].values()
