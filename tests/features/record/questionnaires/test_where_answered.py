"""Tests of forms that are answered inside the headset, or aloud, instead of on the tablet."""

import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.protocol import compile_plan
from app.rehearsal.answers import fill_in
from app.simulated_people.body import make_person
from tests.features.lab import Json, Lab, error, ok
from tests.features.record.questionnaires.forms import ANSWERS, FORM, filled, send
from tests.protocol.helpers import STUDY, edited, loaded

KEY = "answered-elsewhere"
RNG = np.random.default_rng(3)
IN_PHASE = "questionnaire: karas2020"


def study(where: str) -> str:
    """Return the study whose first questionnaire is answered at `where`."""
    return edited(
        ("key: reembodiment-latency", f"key: {KEY}-{where}"),
        (IN_PHASE, f"{IN_PHASE}\n        forms: {where}"),
    )


def at_the_form(lab: Lab, where: str) -> Json:
    """Return a session at its first questionnaire, which is answered at `where`."""
    ok(lab.operator.post("/api/studies", json={"yaml": study(where)}))
    path = f"/api/studies/{KEY}-{where}/sessions"
    return lab.skip_to(ok(lab.operator.post(path, json={})), FORM)


def bearing(lab: Lab, session_id: str) -> TestClient:
    """Return a client with the token of the session's headset."""
    client = lab.stranger()
    client.headers["authorization"] = f"Bearer {lab.headset_token(session_id)}"
    return client


def test_the_place_of_a_form_changes_no_hash_unless_it_is_given() -> None:
    """A study that names the tablet has the hash of one that names nothing; others differ."""
    tablet = loaded(STUDY.replace(IN_PHASE, f"{IN_PHASE}\n        forms: tablet"))
    assert tablet.content_hash == loaded().content_hash
    other = loaded(STUDY.replace(IN_PHASE, f"{IN_PHASE}\n        forms: oral"))
    assert other.content_hash != loaded().content_hash
    keys = [condition.key for condition in other.protocol.conditions]
    asked = {step.forms for step in compile_plan(other.protocol, keys) if step.instrument}
    assert asked == {"tablet", "oral"}


def test_a_form_is_answered_inside_the_headset(fresh_lab: Lab) -> None:
    """The headset gets the form, stores it once and is the way of entry; the tablet looks on."""
    view = at_the_form(fresh_lab, "headset")
    headset, tablet = bearing(fresh_lab, view["id"]), fresh_lab.tablet(view["id"])
    shown = ok(tablet.get("/api/tablet/state"))
    assert (shown["screen"], shown["administration"]) == ("in_headset", None)
    form = ok(headset.get("/api/vr/form"))
    assert form["key"].startswith(FORM)
    body = filled(form)
    error(send(tablet, body), 409, "not_now")
    error(headset.post("/api/vr/submissions", json=filled(form, {"q1": 9})), 422, "invalid_input")
    receipt = ok(headset.post("/api/vr/submissions", json=body))
    again = ok(headset.post("/api/vr/submissions", json=body))
    assert (again["receipt_id"], again["duplicate"]) == (receipt["receipt_id"], True)
    (scores,) = fresh_lab.view(view["id"])["scores"]
    assert (scores["mode"], scores["scores"]["ownership"]) == ("headset", 8)
    error(headset.get("/api/vr/form"), 409, "not_now")


def test_a_form_that_is_read_aloud_is_entered_by_the_operator(fresh_lab: Lab) -> None:
    """For a form that is answered aloud, only the operator can enter the answers."""
    view = at_the_form(fresh_lab, "oral")
    headset, tablet = bearing(fresh_lab, view["id"]), fresh_lab.tablet(view["id"])
    assert ok(tablet.get("/api/tablet/state"))["screen"] == "oral"
    form = ok(fresh_lab.operator.get(f"/api/sessions/{view['id']}/administration"))
    error(send(tablet, filled(form)), 409, "not_now")
    error(headset.post("/api/vr/submissions", json=filled(form)), 409, "not_now")
    path = f"/api/sessions/{view['id']}/submissions"
    ok(fresh_lab.operator.post(path, json=filled(form, ANSWERS)))
    assert fresh_lab.view(view["id"])["scores"][0]["mode"] == "operator"


@pytest.mark.one_engine
def test_a_text_said_aloud_in_the_headset_is_entered_later(fresh_lab: Lab) -> None:
    """In a headset nobody can type: a required text may be missing, and is entered afterwards."""
    asked = "- {step: form, instrument: demographics"
    text = edited(
        ("key: reembodiment-latency", f"key: {KEY}-spoken"), (asked, f"{asked}, forms: headset")
    )
    ok(fresh_lab.operator.post("/api/studies", json={"yaml": text}))
    path = f"/api/studies/{KEY}-spoken/sessions"
    view = fresh_lab.skip_to(ok(fresh_lab.operator.post(path, json={})), "form.demographics")
    headset = bearing(fresh_lab, view["id"])
    form = ok(headset.get("/api/vr/form"))
    required = [one for one in form["instrument"]["items"] if one.get("required", True)]
    assert "occupation" in [one["key"] for one in required]
    answers = fill_in(form["instrument"], make_person(RNG, None), 0.0, "hand", RNG)
    missing = filled(form, {**answers, "occupation": None, "age": None})
    refused = error(headset.post("/api/vr/submissions", json=missing), 422, "invalid_input")
    assert refused["value"] == ["age"]
    spoken = filled(form, {**answers, "occupation": None})
    ok(headset.post("/api/vr/submissions", json=spoken))
    (stored,) = ok(fresh_lab.operator.get(f"/api/sessions/{view['id']}/answers"))
    assert stored["answers"]["occupation"] is None
    correction = {"item": "occupation", "value": "a baker", "reason": "said aloud"}
    path = f"/api/sessions/{view['id']}/submissions/{stored['submission_id']}/corrections"
    ok(fresh_lab.operator.post(path, json=correction))
    (stored,) = ok(fresh_lab.operator.get(f"/api/sessions/{view['id']}/answers"))
    assert stored["answers"]["occupation"] == "a baker"


@pytest.mark.one_engine
def test_a_form_on_the_tablet_is_not_answered_inside_the_headset(lab: Lab) -> None:
    """Where a study says nothing, forms are answered on the tablet, and the headset has none."""
    view = lab.skip_to(lab.join(), FORM)
    headset = bearing(lab, view["id"])
    error(headset.get("/api/vr/form"), 409, "not_now")
    form = ok(lab.operator.get(f"/api/sessions/{view['id']}/administration"))
    error(headset.post("/api/vr/submissions", json=filled(form)), 409, "not_now")


@pytest.mark.one_engine
def test_instructions_and_language_are_chosen_inside_the_headset(lab: Lab) -> None:
    """Instructions that were read inside the headset are completed there, once; nothing else is."""
    view = lab.skip_to(lab.join(), "instructions")
    headset, index = bearing(lab, view["id"]), view["current"]["index"]
    assert ok(headset.put("/api/vr/language", json={"language": "de"})) == {"language": "de"}
    error(headset.put("/api/vr/language", json={"language": "xx"}), 422, "invalid_input")
    for _ in range(2):
        ok(headset.post("/api/vr/acknowledge", json={"step_index": index}))
    after = lab.view(view["id"])
    assert (after["current"]["index"], after["language"]) == (index + 1, "de")
    error(headset.post("/api/vr/acknowledge", json={"step_index": 0}), 422, "invalid_input")
