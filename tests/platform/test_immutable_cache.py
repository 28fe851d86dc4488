"""Tests of the cache of immutable values: read once, least recently used evicted first."""

import pytest
from sqlalchemy import create_engine
from sqlalchemy.orm import Session

from app.platform.immutable_cache import ImmutableCache

HERE, THERE = (Session(create_engine(f"sqlite:///{name}.sqlite")) for name in ("here", "there"))
"""Two databases that are never connected to."""


def test_the_least_recently_used_value_is_evicted() -> None:
    """A value is read once, and the least recently used one is evicted."""
    kept: ImmutableCache[str, str] = ImmutableCache(2)
    read: list[str] = []

    def ask(key: str) -> str:
        def value() -> str:
            read.append(key)
            return key.upper()

        return kept.get(HERE, key, value)

    assert [ask(key) for key in "abacab"] == list("ABACAB")
    assert read == ["a", "b", "c", "b"]


def test_databases_do_not_share_values() -> None:
    """Databases do not share cached values under the same key."""
    kept: ImmutableCache[str, str] = ImmutableCache(2)
    assert (kept.get(HERE, "a", lambda: "h"), kept.get(THERE, "a", lambda: "t")) == ("h", "t")


def test_a_failed_read_is_not_cached() -> None:
    """A failed read is not cached."""
    kept: ImmutableCache[str, int] = ImmutableCache(2)
    with pytest.raises(ZeroDivisionError):
        kept.get(HERE, "a", lambda: 1 // 0)
    assert kept.get(HERE, "a", lambda: 7) == 7
