"""Let no file of this process grow, as on a full disk."""

import resource
from collections.abc import Iterator
from contextlib import contextmanager
from signal import SIG_IGN, SIGXFSZ, signal


@contextmanager
def small_files(limit_bytes: int = 4096) -> Iterator[None]:
    """Refuse what would make a file longer than `limit_bytes`, with an error of the system."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    before = signal(SIGXFSZ, SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit_bytes, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal(SIGXFSZ, before)
