"""What differs between two versions: each place once, lists aligned."""

from app.protocol.difference import Difference, differences
from app.protocol.source import Plain


def found(before: Plain, after: Plain) -> list[Difference]:
    """Every difference."""
    return list(differences(before, after))


def test_a_step_put_in_front_is_one_step_more() -> None:
    """The steps behind it are not called changed."""
    old: Plain = [{"step": "consent", "text": "a"}, {"step": "debrief", "text": "b"}]
    new: Plain = [{"step": "form", "instrument": "ssq"}, *old]  # type: ignore[misc]  # a list of JSON
    (one,) = found({"before": old}, {"before": new})
    assert (one.path, one.kind) == (("before", 0), "added")


def test_an_entry_is_known_by_its_key() -> None:
    """A condition whose latency changed is the same condition."""
    old: Plain = [{"key": "a", "latency_ms": 0}, {"key": "b", "latency_ms": 1}]
    new: Plain = [{"key": "b", "latency_ms": 2}]
    removed, changed = found(old, new)
    assert (removed.path, removed.kind) == ((0,), "removed")
    assert (changed.path, changed.before, changed.after) == ((1, "latency_ms"), 1, 2)


def test_equal_trees_differ_nowhere() -> None:
    """The order of keys does not count; true and 1 are two things."""
    assert found({"a": 1, "b": [1]}, {"b": [1], "a": 1}) == []
    assert len(found({"a": True}, {"a": 1})) == 1
