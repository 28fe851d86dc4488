"""Tests of experts' suggestions, which belong to a step of a version and are decided once."""

import pytest

from tests.features.lab import STUDY, Json, Lab, error, ok


def advise(lab: Lab, **fields: object) -> Json:
    """Store a suggestion for the shipped study."""
    stored: Json = ok(
        lab.operator.post(f"/api/studies/{STUDY}/suggestions", json={"body": "Longer", **fields})
    )
    return stored


def all_of(lab: Lab) -> list[Json]:
    """Return every suggestion for the shipped study."""
    reply: list[Json] = ok(lab.operator.get(f"/api/studies/{STUDY}/suggestions"))
    return reply


def decide(lab: Lab, suggestion: Json, **decision: object) -> Json:
    """Decide on a suggestion."""
    path = f"/api/suggestions/{suggestion['id']}/decision"
    decided: Json = ok(lab.operator.post(path, json=decision))
    return decided


def next_version(lab: Lab, word: str) -> int:
    """Store a version of the study with another wording and return its number."""
    study = ok(lab.operator.get(f"/api/studies/{STUDY}/versions/1"))
    text = study["yaml"].replace("Thank you for coming.", word, 1)
    assert text != study["yaml"]
    added = ok(lab.operator.post(f"/api/studies/{STUDY}/versions", json={"yaml": text}))
    return int(added["version"])


def test_a_suggestion_belongs_to_a_session_and_a_step(fresh_lab: Lab) -> None:
    """A suggestion has its session's version and participant, and the title of its step."""
    view = fresh_lab.join(kind="expert")
    stored = advise(fresh_lab, session_id=view["id"], about="block1.foot", body=" Longer boxes ")
    assert (stored["version"], stored["participant_code"]) == (1, "EXPERT-0001")
    assert (stored["about_title"], stored["body"]) == ("Foot task", "Longer boxes")
    assert (stored["status"], stored["by"]) == ("open", "account:admin")
    assert all_of(fresh_lab) == [stored]


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("fields", "status", "code"),
    [
        ({"about": "block9.hand"}, 422, "invalid_input"),
        ({"version": 7}, 422, "invalid_input"),
        ({"session_id": "nobody"}, 404, "not_found"),
        ({"body": "   "}, 422, "invalid"),
        ({"body": "x" * 4001}, 422, "invalid"),
        ({"surprise": 1}, 422, "invalid"),
    ],
)
def test_an_invalid_suggestion_is_refused(lab: Lab, fields: Json, status: int, code: str) -> None:
    """A suggestion about an unknown step, version or session, or without text, is refused."""
    body = {"body": "Longer", **fields}
    answer = lab.operator.post(f"/api/studies/{STUDY}/suggestions", json=body)
    assert error(answer, status, answer.json()["error"]["code"])
    assert answer.json()["error"]["code"].startswith(code)


@pytest.mark.one_engine
def test_a_suggestion_is_decided_once(fresh_lab: Lab) -> None:
    """A suggestion is adopted in a later version or declined, once."""
    first, second = advise(fresh_lab), advise(fresh_lab, body="Shorter")
    number = next_version(fresh_lab, "Welcome.")
    adopted = decide(fresh_lab, first, status="adopted", adopted_in=number)
    assert (adopted["status"], adopted["adopted_in"]) == ("adopted", 2)
    assert adopted["decided_by"] == "account:admin"
    assert decide(fresh_lab, second, status="declined")["adopted_in"] is None
    path = f"/api/suggestions/{first['id']}/decision"
    repeated = fresh_lab.operator.post(path, json={"status": "declined"})
    assert error(repeated, 409, "conflict")["value"] == "adopted"


@pytest.mark.one_engine
@pytest.mark.parametrize("number", [1, 99])
def test_a_suggestion_is_adopted_only_in_a_later_version(fresh_lab: Lab, number: int) -> None:
    """A suggestion cannot be adopted in its own version or in a missing one."""
    stored = advise(fresh_lab)
    next_version(fresh_lab, "Welcome.")
    path = f"/api/suggestions/{stored['id']}/decision"
    body = {"status": "adopted", "adopted_in": number}
    assert error(fresh_lab.operator.post(path, json=body), 422, "invalid_input")["valid"] == [2]


def test_suggestions_list_the_newest_version_first(fresh_lab: Lab) -> None:
    """Suggestions list the newest version first, and in order of writing within a version."""
    old = [advise(fresh_lab, body=body)["id"] for body in ("a", "b")]
    next_version(fresh_lab, "Welcome.")
    new = advise(fresh_lab, body="c")["id"]
    assert [one["id"] for one in all_of(fresh_lab)] == [new, *old]
