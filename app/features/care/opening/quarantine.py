"""Move a damaged database into quarantine, never deleting it.

Each database gets its own folder, `quarantine/<UTC time>/`, with its log and a note. The note's
name is the state: `moving` while files are moved (the next start continues if interrupted),
`unresolved` until somebody has decided what to use instead, `resolved` from then on.
"""

import os
import shutil
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from app.platform.folders import DATABASE_SUFFIXES

MOVING, UNRESOLVED, RESOLVED = "moving.txt", "unresolved.txt", "resolved.txt"
SUFFIXES = DATABASE_SUFFIXES


@dataclass(frozen=True)
class Quarantine:
    """The quarantine folder next to the database `file`."""

    file: Path

    @property
    def folder(self) -> Path:
        """Return the folder of all databases in quarantine."""
        return self.file.absolute().parent / "quarantine"

    def put_away(self, why: str, now: datetime) -> Path:
        """Move the database with its log and index, unchanged, and return their new folder.

        Raises OSError; if some files had been moved by then, the next start moves the others.
        """
        place = self.folder / f"{now:%Y%m%dT%H%M%S.%fZ}"
        place.mkdir(mode=0o700, parents=True)
        note = place / MOVING
        try:
            note.write_text(
                f"{self.file.absolute()} was put away on {now.isoformat()}.\n"
                f"Why: {why}.\n"
                "What to do: see docs/backups.md. Nothing here was changed, and nothing needs "
                "it.\n",
                encoding="utf-8",
            )
            flush_to_disk(place, self.folder)
        except OSError:
            # Nothing was moved yet, so the attempt is undone completely.
            shutil.rmtree(place, ignore_errors=True)
            with suppress(OSError):
                self.folder.rmdir()
            raise
        self._move(place)
        return place

    def finish(self) -> None:
        """Complete a move that was interrupted."""
        for note in sorted(self.folder.glob(f"*/{MOVING}")):
            self._move(note.parent)

    def unresolved(self) -> list[Path]:
        """Return the folders that nobody has decided about yet, newest last."""
        return sorted(note.parent for note in self.folder.glob(f"*/{UNRESOLVED}"))

    def resolve(self, *places: Path) -> None:
        """Mark the given folders, or all, as resolved, so that they no longer prevent a start."""
        for place in places or self.unresolved():
            (place / UNRESOLVED).rename(place / RESOLVED)

    def _move(self, place: Path) -> None:
        for suffix in SUFFIXES:
            part = self.file.with_name(self.file.name + suffix)
            # A file that is already in the folder was moved before the interruption.
            if part.exists() and not (place / part.name).exists():
                part.rename(place / part.name)
        flush_to_disk(place, self.file.absolute().parent)
        (place / MOVING).rename(place / UNRESOLVED)
        flush_to_disk(place)


def flush_to_disk(*paths: Path) -> None:
    """Flush these files and folders to the disk."""
    for path in paths:
        handle = os.open(path, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
