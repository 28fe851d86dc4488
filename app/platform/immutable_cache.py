"""Cache stored values that never change, such as versions of studies.

A version of a study or of an instrument is never edited, and a session keeps its version and its
slot for life. Reading and parsing them for every request would be most of the work of storing a
form. Values are cached by database and by their key in it.
"""

import threading
from collections import OrderedDict
from collections.abc import Callable
from typing import Generic, TypeVar

from sqlalchemy import URL
from sqlalchemy.orm import Session

Key = TypeVar("Key")
Value = TypeVar("Value")


class ImmutableCache(Generic[Key, Value]):
    """A cache of immutable values by key; beyond `size` it evicts the least recently used."""

    def __init__(self, size: int) -> None:
        self._size = size
        self._values: OrderedDict[tuple[URL, Key], Value] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, db: Session, key: Key, read: Callable[[], Value]) -> Value:
        """Return the value of `key` in this database, calling `read` if it is not cached.

        If `read` raises, nothing is cached. Two threads may read the same value simultaneously;
        neither waits for the other.
        """
        name = (db.get_bind().engine.url, key)
        with self._lock:
            if name in self._values:
                self._values.move_to_end(name)
                return self._values[name]
        value = read()
        with self._lock:
            self._values[name] = value
            if len(self._values) > self._size:
                self._values.popitem(last=False)
        return value
