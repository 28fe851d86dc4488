"""Refused sign-ins on the audit trail: all of them counted, few rows, an unbroken chain."""

from typing import Any

import pytest

from app.features.people.accounts import RefusedSignIns
from app.features.people.audit import verify_trail
from tests.features.lab import Lab, error, ok
from tests.features.people.accounts.test_accounts import log_in


class Watch:
    """A clock that is moved by hand."""

    now_s = 0.0

    def __call__(self) -> float:
        """The time (s)."""
        return self.now_s


def refusals_of(lab: Lab) -> list[dict[str, Any]]:
    """What the trail says of refused sign-ins, the oldest first."""
    trail = ok(lab.operator.get("/api/audit?action=login.refused&limit=200"))
    return [entry["details"] for entry in reversed(trail["entries"])]


@pytest.fixture
def desk(fresh_lab: Lab) -> RefusedSignIns:
    """A desk whose time stands still, on the database of a lab."""
    return RefusedSignIns(fresh_lab.database, fresh_lab.context.clock, monotonic_s=Watch())


def test_a_flood_of_refusals_costs_two_rows(fresh_lab: Lab) -> None:
    """The first is on record at once, the others with their number when the window ends."""
    client = fresh_lab.stranger()
    answers = [log_in(client, f"name{at % 20}", "a wrong guess").status_code for at in range(60)]
    assert (answers.count(401), answers.count(429)) == (30, 30)
    assert refusals_of(fresh_lab) == [{"address": "testclient"}]
    fresh_lab.context.part(RefusedSignIns).close_windows(float("inf"))
    assert refusals_of(fresh_lab)[1:] == [
        {"address": "testclient", "count": 59, "unchecked": 30, "names": 20}
    ]
    with fresh_lab.database.reading() as db:
        assert verify_trail(db).ok


@pytest.mark.one_engine
def test_the_names_that_were_typed_are_nowhere(fresh_lab: Lab) -> None:
    """Somebody may have typed a password in the wrong field."""
    for _ in range(3):
        error(log_in(fresh_lab.stranger(), "a-secret", "a wrong guess"), 401, "not_signed_in")
    fresh_lab.context.part(RefusedSignIns).stop()
    assert "a-secret" not in str(refusals_of(fresh_lab))
    assert [one.get("count") for one in refusals_of(fresh_lab)] == [None, 2]


@pytest.mark.one_engine
def test_each_window_has_a_row(fresh_lab: Lab, desk: RefusedSignIns) -> None:
    """What goes on is a row a window; a quiet window ends it, and the next refusal is a first."""
    for at in range(4):
        for _ in range(10):
            desk.note("10.0.0.1", "admin", checked=True)
        desk.close_windows(60.0 * (at + 1))
    desk.close_windows(1000.0)
    desk.note("10.0.0.1", "admin", checked=True)
    assert [one.get("count", 1) for one in refusals_of(fresh_lab)] == [1, 9, 10, 10, 10, 1]


@pytest.mark.one_engine
def test_a_window_that_has_not_ended_stays_open(fresh_lab: Lab, desk: RefusedSignIns) -> None:
    """Nothing is put on record before its time."""
    for _ in range(5):
        desk.note("10.0.0.1", "admin", checked=True)
    desk.close_windows(59.0)
    assert len(refusals_of(fresh_lab)) == 1


@pytest.mark.one_engine
def test_refusals_from_everywhere_are_counted_together(
    fresh_lab: Lab, desk: RefusedSignIns
) -> None:
    """Addresses beyond those that are kept apart share a row: the trail grows by a fixed number."""
    for at in range(1000):
        desk.note(f"10.0.{at // 250}.{at % 250}", "admin", checked=False)
    desk.close_windows(60.0)
    with fresh_lab.database.reading() as db:
        check = verify_trail(db)
    assert check.ok
    assert check.entries < 270
    assert refusals_of(fresh_lab)[-1]["address"] == "other addresses"
    assert refusals_of(fresh_lab)[-1]["count"] == 743


def test_a_server_that_ends_keeps_its_count(fresh_lab: Lab, desk: RefusedSignIns) -> None:
    """Stopping closes every window."""
    desk.start()
    for _ in range(7):
        desk.note("10.0.0.1", "admin", checked=True)
    desk.stop()
    assert [one.get("count", 1) for one in refusals_of(fresh_lab)] == [1, 6]
