"""Tests that an alarm is raised once and cleared once its condition has been absent for a while."""

from app.features.record.alarms.alarm import SEVERITIES, Condition, OpenAlarms
from tests.features.record.alarms.watched import at

GAP = Condition("gap", "a gap", "target", 0.5, "s")


def test_an_alarm_is_raised_once_however_often_it_is_reported() -> None:
    """An alarm is raised once; later reports update its condition and keep its start time."""
    book = OpenAlarms(3.0)
    first = list(book.report(GAP, at(0.0)))
    repeated = list(book.report(Condition("gap", "a longer gap", "target", 2.0, "s"), at(1.0)))
    (alarm,) = book.open
    assert ([change.state for change in first], repeated) == (["raised"], [])
    assert (alarm.condition.value, alarm.since) == (2.0, at(0.0).utc)


def test_an_alarm_is_cleared_when_nothing_was_reported_for_a_while() -> None:
    """An alarm is cleared three seconds after the last report of its condition."""
    book = OpenAlarms(3.0)
    list(book.report(GAP, at(0.0)))
    list(book.report(GAP, at(2.0)))
    assert list(book.clear_expired(at(4.9))) == []
    (cleared,) = book.clear_expired(at(5.0))
    assert (cleared.state, cleared.condition, cleared.at) == ("cleared", GAP, at(5.0).utc)
    assert book.open == ()


def test_an_intermittent_condition_raises_one_alarm() -> None:
    """A condition that recurs every two seconds raises one alarm, not several."""
    book = OpenAlarms(3.0)
    changes = []
    for second in range(0, 20, 2):
        changes += [*book.report(GAP, at(second)), *book.clear_expired(at(second + 1.9))]
    assert [change.state for change in changes] == ["raised"]


def test_each_stream_has_its_own_alarms() -> None:
    """A gap in one stream does not keep the alarm of the other stream open."""
    book = OpenAlarms(3.0)
    list(book.report(GAP, at(0.0)))
    list(book.report(Condition("gap", "a gap", "actual"), at(2.0)))
    assert [change.condition.stream for change in book.clear_expired(at(3.0))] == ["target"]


def test_closing_clears_every_alarm_with_a_reason() -> None:
    """Closing the list of open alarms clears each of them with the given reason."""
    book = OpenAlarms(3.0)
    list(book.report(GAP, at(0.0)))
    (cleared,) = book.close("it is over", at(1.0))
    assert (cleared.state, cleared.condition.message) == ("cleared", "it is over")
    assert list(book.clear_expired(at(9.0))) == []


def test_every_alarm_has_a_severity() -> None:
    """Only lost data and participants who are unwell, call, ask or refuse give critical alarms."""
    losing = {"silent", "page_silent", "too_slow", "disconnected", "storage", "writer_failed"}
    critical = {code for code, severity in SEVERITIES.items() if severity == "critical"}
    of_person = {"stop_rule_met", "help_asked", "stop_asked", "question_asked", "consent_refused"}
    assert critical == losing | of_person
    assert GAP.severity == "warning"
