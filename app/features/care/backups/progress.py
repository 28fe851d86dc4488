"""Telling how far copying has come."""

from collections.abc import Callable

Progress = Callable[[str, int], None]
"""Called with a table's name and how many more of its rows are done."""


def silent(_table: str, _rows: int) -> None:
    """Tell nobody."""
