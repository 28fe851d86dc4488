"""Tests of the list of a study's sessions."""

from tests.features.lab import STUDY, Lab, ok


def test_only_a_running_session_says_at_which_step_it_is(lab: Lab) -> None:
    """A planned session has no step in the list; a started one has the first, of how many."""
    running, planned = lab.join(), lab.join()
    started = lab.command(running, "start")
    listed = {one["id"]: one for one in ok(lab.operator.get(f"/api/studies/{STUDY}/sessions"))}
    assert listed[planned["id"]]["step"] is None
    assert listed[running["id"]]["step"] == {
        "index": 0,
        "steps": len(started["steps"]),
        "kind": "consent",
        "limb": None,
        "paused": False,
    }
