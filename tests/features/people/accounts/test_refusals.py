"""Tests of refused logins in the audit trail: all are counted, in few rows."""

from typing import Any

import pytest

from app.features.people.accounts import RefusedSignIns
from app.features.people.audit import verify_trail
from tests.features.lab import Lab, error, ok
from tests.features.people.accounts.test_accounts import log_in


class ManualClock:
    """A monotonic clock that is set by hand."""

    now_s = 0.0

    def __call__(self) -> float:
        """Return the time in seconds."""
        return self.now_s


def refusals_of(lab: Lab) -> list[dict[str, Any]]:
    """Return the details of the refused logins in the audit trail, oldest first."""
    trail = ok(lab.operator.get("/api/audit?action=login.refused&limit=200"))
    return [entry["details"] for entry in reversed(trail["entries"])]


@pytest.fixture
def refusals(fresh_lab: Lab) -> RefusedSignIns:
    """Return a recorder of refused logins with a fixed clock, on the database of a lab."""
    return RefusedSignIns(fresh_lab.database, fresh_lab.context.clock, monotonic_s=ManualClock())


def test_many_refused_logins_make_two_rows(fresh_lab: Lab) -> None:
    """The first refused login is recorded immediately, later ones as a count per window."""
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
def test_typed_user_names_are_not_recorded(fresh_lab: Lab) -> None:
    """User names of refused logins are not recorded, as they may be mistyped passwords."""
    for _ in range(3):
        error(log_in(fresh_lab.stranger(), "a-secret", "a wrong guess"), 401, "not_signed_in")
    fresh_lab.context.part(RefusedSignIns).stop()
    assert "a-secret" not in str(refusals_of(fresh_lab))
    assert [one.get("count") for one in refusals_of(fresh_lab)] == [None, 2]


@pytest.mark.one_engine
def test_each_window_has_a_row(fresh_lab: Lab, refusals: RefusedSignIns) -> None:
    """Refused logins get one row per window; after a quiet one the next is recorded directly."""
    for at in range(4):
        for _ in range(10):
            refusals.note("10.0.0.1", "admin", checked=True)
        refusals.close_windows(60.0 * (at + 1))
    refusals.close_windows(1000.0)
    refusals.note("10.0.0.1", "admin", checked=True)
    assert [one.get("count", 1) for one in refusals_of(fresh_lab)] == [1, 9, 10, 10, 10, 1]


@pytest.mark.one_engine
def test_a_window_that_has_not_ended_stays_open(fresh_lab: Lab, refusals: RefusedSignIns) -> None:
    """The count of a window is not recorded before the window ends."""
    for _ in range(5):
        refusals.note("10.0.0.1", "admin", checked=True)
    refusals.close_windows(59.0)
    assert len(refusals_of(fresh_lab)) == 1


@pytest.mark.one_engine
def test_refusals_from_many_addresses_share_a_row(fresh_lab: Lab, refusals: RefusedSignIns) -> None:
    """Refused logins from more addresses than are tracked separately share one row."""
    for at in range(1000):
        refusals.note(f"10.0.{at // 250}.{at % 250}", "admin", checked=False)
    refusals.close_windows(60.0)
    with fresh_lab.database.reading() as db:
        check = verify_trail(db)
    assert check.ok
    assert check.entries < 270
    assert refusals_of(fresh_lab)[-1]["address"] == "other addresses"
    assert refusals_of(fresh_lab)[-1]["count"] == 743


def test_stopping_records_the_open_counts(fresh_lab: Lab, refusals: RefusedSignIns) -> None:
    """Stopping the server records the counts of all open windows."""
    refusals.start()
    for _ in range(7):
        refusals.note("10.0.0.1", "admin", checked=True)
    refusals.stop()
    assert [one.get("count", 1) for one in refusals_of(fresh_lab)] == [1, 6]
