"""Tests of the differences between two versions: each place once, lists aligned."""

from app.protocol.difference import Difference, differences
from app.protocol.source import Plain


def found(before: Plain, after: Plain) -> list[Difference]:
    """Return all differences."""
    return list(differences(before, after))


def test_an_inserted_step_is_one_difference() -> None:
    """A step inserted in front is one added step, and the following ones are unchanged."""
    old: Plain = [{"step": "consent", "text": "a"}, {"step": "debrief", "text": "b"}]
    new: Plain = [{"step": "form", "instrument": "ssq"}, *old]  # type: ignore[misc]  # a list of JSON
    (one,) = found({"before": old}, {"before": new})
    assert (one.path, one.kind) == (("before", 0), "added")


def test_entries_are_matched_by_their_key() -> None:
    """A condition whose latency changed is reported as changed, not as another condition."""
    old: Plain = [{"key": "a", "latency_ms": 0}, {"key": "b", "latency_ms": 1}]
    new: Plain = [{"key": "b", "latency_ms": 2}]
    removed, changed = found(old, new)
    assert (removed.path, removed.kind) == ((0,), "removed")
    assert (changed.path, changed.before, changed.after) == ((1, "latency_ms"), 1, 2)


def test_equal_trees_have_no_differences() -> None:
    """Another order of keys is no difference, but `true` and 1 differ."""
    assert found({"a": 1, "b": [1]}, {"b": [1], "a": 1}) == []
    assert len(found({"a": True}, {"a": 1})) == 1
