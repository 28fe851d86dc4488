"""Short calls for backing up and restoring with a fixed clock."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from app.clock import Clock
from app.database import Database
from app.features.care.backups.service import (
    BackedUp,
    Restored,
    back_up,
    checked_backup,
    restore,
)

NOW = datetime(2026, 11, 21, 6, 11, 8, 123456, UTC)
CLOCK = Clock(utc_now=lambda: NOW)


def make(database: Database, to: Path, **options: Any) -> BackedUp:
    """Back up a database to a file with the fixed clock."""
    return back_up(database, to, clock=CLOCK, **options)


def put_back(database: Database, path: Path, *, replace: bool = False, **options: Any) -> Restored:
    """Restore a backup; the replaced data are backed up to the folder `kept` next to it."""
    keep_in = path.parent / "kept"
    with checked_backup(path, keep_in) as backup:
        return restore(database, backup, keep_in=keep_in, clock=CLOCK, replace=replace, **options)
