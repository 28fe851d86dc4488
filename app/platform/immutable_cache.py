"""What never changes once it is stored, kept between requests.

A version of a study or of an instrument is never edited, and a session keeps its version and its
slot for life. Reading and unpacking them anew would be most of the work of a request that stores a
form. They are kept by database and by what names them there.
"""

import threading
from collections import OrderedDict
from collections.abc import Callable
from typing import Generic, TypeVar

from sqlalchemy import URL
from sqlalchemy.orm import Session

Key = TypeVar("Key")
Value = TypeVar("Value")


class Unchanging(Generic[Key, Value]):
    """Values by key, read once; of more than `size` the one that was wanted longest ago goes."""

    def __init__(self, size: int) -> None:
        self._size = size
        self._values: OrderedDict[tuple[URL, Key], Value] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, db: Session, key: Key, read: Callable[[], Value]) -> Value:
        """The value of `key` in this database, from `read` if it is not kept.

        What raises is not kept. Two threads may read the same at once; nobody waits here.
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
