"""Tests of expert sessions: listed with the others, but in no figure and no export."""

from pathlib import Path

import pytest

from app.features.results.analysis.tables import KINDS, sessions_table
from app.features.results.exports.writing import export_study, usual_kind
from tests.features.lab import STUDY, Lab, ok


def test_experts_have_their_own_ledger(fresh_lab: Lab) -> None:
    """An expert's session takes its slot from a separate ledger."""
    expert, person = fresh_lab.join(kind="expert"), fresh_lab.join()
    assert (expert["slot"]["index"], person["slot"]["index"]) == (0, 0)
    assert expert["participant_code"] == "EXPERT-0001"
    slots = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}/ledger?kind=expert"))["slots"]
    assert [slot["state"] for slot in slots].count("open") == 1


@pytest.mark.one_engine
def test_an_expert_is_in_the_list_of_sessions(fresh_lab: Lab) -> None:
    """An expert's session is listed with its own kind and not as simulated."""
    fresh_lab.join(kind="expert")
    (reported,) = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}/sessions?kind=expert"))
    assert (reported["kind"], reported["simulated"]) == ("expert", False)


@pytest.mark.one_engine
def test_an_expert_session_has_no_time_scale(lab: Lab) -> None:
    """An expert's session with a time scale is refused."""
    assert lab.try_join(kind="expert", time_scale=2.0).status_code == 422


def test_no_table_or_export_contains_an_expert(fresh_lab: Lab, tmp_path: Path) -> None:
    """No table and no export contains an expert's session, whatever kind is requested."""
    expert, person = fresh_lab.join(kind="expert"), fresh_lab.join()
    with fresh_lab.database.reading() as db:
        for kind in KINDS:
            assert expert["id"] not in set(sessions_table(db, STUDY, kind)["session_id"])
        assert set(sessions_table(db, STUDY, "all")["session_id"]) == {person["id"]}
        assert usual_kind(db, STUDY) == "people"
        export_study(db, STUDY, "all", tmp_path / "out", now=fresh_lab.context.clock.utc_now())
    texts = [one.read_text("utf-8") for one in (tmp_path / "out").rglob("*") if one.is_file()]
    assert not [text for text in texts if expert["id"] in text]
    for route in ("dashboard", "export"):
        answer = fresh_lab.operator.get(f"/api/studies/{STUDY}/{route}?kind=expert")
        assert answer.status_code == 422
