"""Making a new database: beside its place first, so that there is never half of one."""

import os
import tempfile
from pathlib import Path

from app.schema_revisions import migrate


def begin(file: Path) -> None:
    """Make an empty database with the newest schema at `file`, where there is none."""
    folder = file.absolute().parent
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".beginning-", dir=folder) as beside:
        fresh = Path(beside) / file.name
        # Its last connection copies the log into the file and removes it.
        migrate(f"sqlite:///{fresh}")
        for path in (fresh, folder):
            handle = os.open(path, os.O_RDONLY)
            try:
                os.fsync(handle)
            finally:
                os.close(handle)
        if not file.exists():
            fresh.rename(file)
