"""Tests of a stop rule on the rise of a score since an earlier form."""

import pytest

from tests.features.lab import Json, Lab, ok
from tests.features.record.sessions.options_lab import FMS, answer_fms
from tests.protocol.options import KEY, with_options

START = "form.fms"
STUDY = with_options(
    (f"key: {KEY}", "key: reembodiment-rising"),
    ("    - {step: height", "    - {step: form, instrument: fms}\n    - {step: height"),
    ("stop_at: 15, warn_at: 10", "stop_at: 8, warn_at: 5, change_from: form.fms"),
)


def session(lab: Lab) -> Json:
    """Return a session of a study whose stop rule is about the rise of a score."""
    if lab.operator.get("/api/studies/reembodiment-rising").status_code == 404:
        ok(lab.operator.post("/api/studies", json={"yaml": STUDY}))
    view: Json = ok(lab.operator.post("/api/studies/reembodiment-rising/sessions", json={}))
    return view


@pytest.mark.one_engine
@pytest.mark.parametrize(
    ("start", "later", "codes"),
    [
        (12, 14, []),
        (12, 17, ["stop_rule_near"]),
        (12, 20, ["stop_rule_met"]),
        (0, 8, ["stop_rule_met"]),
        (8, 0, []),
    ],
)
def test_only_the_rise_counts(lab: Lab, start: int, later: int, codes: list[str]) -> None:
    """Only the rise of the score since the first form meets the stop rule, not its level."""
    view = lab.skip_to(session(lab), START)
    ok(answer_fms(lab, view["id"], start))
    assert lab.view(view["id"])["alarms"] == []
    view = lab.skip_to(lab.view(view["id"]), FMS)
    ok(answer_fms(lab, view["id"], later))
    view = lab.view(view["id"])
    assert [one["code"] for one in view["alarms"]] == codes
    hold = view["held"]
    assert (hold is not None and hold["is_rise"]) == ("stop_rule_met" in codes)


def test_a_missing_first_score_raises_a_warning(lab: Lab) -> None:
    """If the first form was skipped, a warning states that the rise of the score is unknown."""
    view = lab.skip_to(session(lab), FMS)
    ok(answer_fms(lab, view["id"], 2))
    assert [one["code"] for one in lab.view(view["id"])["alarms"]] == ["stop_rule_unknown"]
