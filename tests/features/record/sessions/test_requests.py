"""Tests of requests for sessions that are repeated, because of a double click or a lost answer."""

import uuid
from concurrent.futures import ThreadPoolExecutor

from tests.features.lab import STUDY, Lab, error, ok


def test_a_repeated_request_returns_the_session_of_the_first(lab: Lab) -> None:
    """Asking again with the same request id returns the first session and takes no second slot."""
    request_id, before = str(uuid.uuid4()), _ids(lab)
    first = lab.join(request_id=request_id)
    assert lab.join(request_id=request_id)["id"] == first["id"]
    named = lab.join(request_id=request_id, participant_code=first["participant_code"])
    assert named["id"] == first["id"]
    assert _ids(lab) - before == {first["id"]}
    other = lab.join(request_id=str(uuid.uuid4()))
    assert other["id"] != first["id"]
    assert lab.join()["id"] not in {first["id"], other["id"]}


def test_two_requests_at_once_create_one_session(lab: Lab) -> None:
    """Two requests with one id that arrive at the same time create one session."""
    request_id, before = str(uuid.uuid4()), _ids(lab)
    with ThreadPoolExecutor(2) as threads:
        made = list(threads.map(lambda _: lab.try_join(request_id=request_id), range(2)))
    ids = {ok(one)["id"] for one in made}
    assert len(ids) == 1
    assert _ids(lab) - before == ids


def test_a_repeated_request_for_another_session_is_refused(lab: Lab) -> None:
    """A repeated request that asks for something else is refused, and names the session it made."""
    request_id = str(uuid.uuid4())
    first = lab.join(request_id=request_id, participant_code="P-A")
    made = _ids(lab)
    for changed in (
        {"participant_code": "P-B"},
        {"participant_code": "P-A", "kind": "test"},
        {"participant_code": "P-A", "language": "de"},
    ):
        answer = lab.try_join(request_id=request_id, **changed)
        refusal = error(answer, 409, "conflict")
        assert "already created the session of P-A" in refusal["message"]
        assert refusal["details"] == [{"session_id": first["id"], "status": "planned"}]
    assert _ids(lab) == made


def test_a_code_that_differs_in_case_alone_is_refused(lab: Lab) -> None:
    """p-0007 is no second person beside P-0007, but another kind of session may use the code."""
    lab.join(participant_code="Case-7")
    refusal = error(lab.try_join(participant_code="case-7"), 409, "conflict")
    assert (refusal["value"], refusal["valid"]) == ("case-7", "Case-7")
    assert ok(lab.try_join(participant_code="case-7", kind="test"))["participant_code"] == "case-7"


def _ids(lab: Lab) -> set[str]:
    return {one["id"] for one in ok(lab.operator.get(f"/api/studies/{STUDY}/sessions"))}
