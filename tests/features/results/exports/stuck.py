"""A substitute for a long export, without imports that would delay its process."""

import os
import time
from typing import Any

LONG_S = 120.0


def never_done(order: Any) -> None:
    """Create a file, write the process id next to it, and sleep for two minutes."""
    order.to.with_suffix(".part").write_bytes(b"half")
    order.to.with_suffix(".pid").write_text(str(os.getpid()))
    time.sleep(LONG_S)
