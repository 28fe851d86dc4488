"""What is kept between requests: read once; the longest unwanted goes; failures never stay."""

import pytest
from sqlalchemy import create_engine
from sqlalchemy.orm import Session

from app.platform.immutable_cache import ImmutableCache

HERE, THERE = (Session(create_engine(f"sqlite:///{name}.sqlite")) for name in ("here", "there"))
"""Two databases that nobody connects to."""


def test_a_value_is_read_once_and_the_longest_unwanted_goes() -> None:
    """Of two places the one that was asked for last keeps its value."""
    kept: ImmutableCache[str, str] = ImmutableCache(2)
    read: list[str] = []

    def ask(key: str) -> str:
        def value() -> str:
            read.append(key)
            return key.upper()

        return kept.get(HERE, key, value)

    assert [ask(key) for key in "abacab"] == list("ABACAB")
    assert read == ["a", "b", "c", "b"]


def test_databases_share_nothing() -> None:
    """The same name may mean something else elsewhere."""
    kept: ImmutableCache[str, str] = ImmutableCache(2)
    assert (kept.get(HERE, "a", lambda: "h"), kept.get(THERE, "a", lambda: "t")) == ("h", "t")


def test_what_failed_is_read_again() -> None:
    """A row that is not there yet may come."""
    kept: ImmutableCache[str, int] = ImmutableCache(2)
    with pytest.raises(ZeroDivisionError):
        kept.get(HERE, "a", lambda: 1 // 0)
    assert kept.get(HERE, "a", lambda: 7) == 7
