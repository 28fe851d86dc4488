"""Stands in for a long export; nothing is imported that its process would take long to load."""

import os
import time
from typing import Any

LONG_S = 120.0


def never_done(order: Any) -> None:
    """Begin a file, say which process does, and never end."""
    order.to.with_suffix(".part").write_bytes(b"half")
    order.to.with_suffix(".pid").write_text(str(os.getpid()))
    time.sleep(LONG_S)
