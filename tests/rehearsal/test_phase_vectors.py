"""Tests of the phases' vectors, which the headset's page must reproduce too."""

import json
from typing import get_args

from app.wire import PhaseEvent
from tests.rehearsal.phase_vectors import SCRIPTS, Json, make_all, stored


def test_the_stored_vectors_are_what_the_scripted_headset_does() -> None:
    """The stored vectors are what the scripted headset does today."""
    assert json.loads(json.dumps(make_all())) == dict(stored())


def test_the_vectors_contain_every_kind_of_report_and_cause() -> None:
    """Together the vectors contain every change of the clock, every cause and every effect."""
    steps: list[Json] = [step for _, vector in stored() for step in vector["steps"]]
    reports: list[Json] = [report for step in steps for report in step.get("reports", [])]
    phases = [report for report in reports if report["kind"] == "phase"]
    contacts = [report for report in reports if report["kind"] == "contact"]
    assert len(SCRIPTS) == len(dict(stored()))
    assert {report["what"] for report in phases} == set(get_args(PhaseEvent))
    assert {report["cause"] for report in phases} == {
        "headset",
        "operator",
        "disconnected",
        "restarted",
    }
    assert {report["effect"] for report in contacts} == {
        "green",
        "out_of_order",
        "wrong_part",
        "early",
        "completed",
        "side",
        "start",
        "none",
    }
    assert any(report["kind"] == "completion" for report in reports)
