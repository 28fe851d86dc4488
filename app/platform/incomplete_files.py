"""Track files that are being made outside the database, and clean up after a crash.

An export or a backup is written next to its destination, anywhere on the machine, and moved there
once it is complete. Meanwhile the process keeps a note of it in the data folder, which it locks as
long as it lives. So the leftovers of a crash are known: they are listed, and removed at the next
start of the server and with every erasure, which must not leave an incomplete export of an erased
person. What is made within the data folder (uploads, a new database, a backup that is migrated) is
recognised by its location.
"""

import json
import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import IO, Any, Literal

from app.platform.folders import BEGINNING, home_of
from app.settings import Settings

Kind = Literal["backup", "export", "upload", "restore", "database", "check"]
PARTIAL = ".partial"
"""The suffix of folders in which something is made next to its destination."""
UPLOADS = "uploads"
_BY_PLACE: tuple[tuple[Kind, str], ...] = (
    ("upload", f"scratch/{UPLOADS}/*"),
    ("export", "scratch/exports/*"),
    ("restore", "backups/.restoring-*"),
    ("backup", f"backups/.*{PARTIAL}"),
    ("database", f"{BEGINNING}*"),
    ("check", ".write-test-*"),
)


@dataclass(frozen=True)
class IncompleteFile:
    """An incomplete file or folder: its kind, its path, and since when it exists.

    `to`: its intended destination. `study_key`: the study of an export. `going_on`: whether the
    process that makes it still runs.
    """

    kind: Kind
    path: Path
    since: datetime
    to: Path | None = None
    study_key: str | None = None
    going_on: bool = False
    note: Path | None = None


def uploads_of(settings: Settings) -> Path:
    """Return the folder for files on their way into the database, creating it if necessary."""
    folder = settings.scratch_dir / UPLOADS
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    return folder


@dataclass(frozen=True)
class Notes:
    """The notes of an installation on what is being made outside its folder."""

    folder: Path

    @classmethod
    def of(cls, settings: Settings) -> "Notes":
        """Return the notes kept next to the database."""
        return cls(home_of(settings) / "half-made")

    @contextmanager
    def on(
        self, kind: Kind, path: Path, *, to: Path, now: datetime, study_key: str | None = None
    ) -> Iterator[None]:
        """Keep a note while `path` exists; raise OSError if none can be written."""
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        note = self.folder / f"{path.name}.json"
        words = {
            "kind": kind,
            "path": str(path.absolute()),
            "to": str(to.absolute()),
            "since": now.astimezone(UTC).isoformat(),
            "study_key": study_key,
        }
        with note.open("x", encoding="utf-8") as file:
            lock_file(file)
            json.dump(words, file)
            file.flush()
            os.fsync(file.fileno())
            try:
                yield
            finally:
                # Do not fail if the note cannot be removed: the next start removes it.
                if not os.path.lexists(path):
                    with suppress(OSError):
                        note.unlink()

    def all(self) -> list[IncompleteFile]:
        """Return all noted files, oldest first; incomplete notes are skipped."""
        found = [one for note in self.folder.glob("*.json") if (one := _read(note)) is not None]
        return sorted(found, key=lambda one: (one.since, one.path))


@contextmanager
def partial_folder(
    kind: Kind, to: Path, *, now: datetime, notes: Notes | None, study_key: str | None = None
) -> Iterator[Path]:
    """Make a private temporary folder next to `to`, and remove it afterwards.

    Only its owner can read it. With `notes`, a note is written before the folder exists. Raises
    OSError if the folder cannot be made.
    """
    to = to.absolute()
    folder = to.parent / f".{to.name}.{secrets.token_hex(4)}{PARTIAL}"
    with (
        nullcontext()
        if notes is None
        else notes.on(kind, folder, to=to, now=now, study_key=study_key)
    ):
        folder.mkdir(mode=0o700)
        try:
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)


def incomplete_files(settings: Settings) -> list[IncompleteFile]:
    """Return all incomplete files, in progress or left by a crash, oldest first."""
    home = home_of(settings)
    found = Notes.of(settings).all()
    for kind, pattern in _BY_PLACE:
        for folder in {home.resolve(), settings.data_dir.resolve()}:
            for path in folder.glob(pattern):
                with suppress(OSError):  # it was removed meanwhile
                    since = datetime.fromtimestamp(path.lstat().st_mtime, UTC)
                    found.append(IncompleteFile(kind, path, since))
    return sorted(found, key=lambda one: (one.since, one.path))


def remove_leftovers(settings: Settings, *, starting: bool = False) -> list[IncompleteFile]:
    """Remove the incomplete files of processes that have ended; return what was removed.

    `starting`: no server uses the folder yet, so that files recognised by their location are
    removed as well. What cannot be removed (its disk is not mounted) stays on the list.
    """
    found = incomplete_files(settings) if starting else Notes.of(settings).all()
    removed = [one for one in found if not one.going_on and _remove(one)]
    if starting:
        # The crash happened while the note was written, before anything was made.
        for note in [one for one in Notes.of(settings).folder.glob("*.json") if not _read(one)]:
            note.unlink(missing_ok=True)
    return removed


def _remove(one: IncompleteFile) -> bool:
    """Remove an incomplete file; return whether it existed and no longer does.

    A note that names any other kind of path removes nothing.
    """
    there = os.path.lexists(one.path)
    with suppress(OSError):
        if one.note is None or one.path.name.endswith(PARTIAL):
            # Restore the earlier export that was being replaced.
            if one.to is not None and (one.path / "old").is_dir() and not one.to.exists():
                (one.path / "old").rename(one.to)
            shutil.rmtree(one.path) if one.path.is_dir() else one.path.unlink(missing_ok=True)
    removed = not os.path.lexists(one.path)
    # If its disk is not mounted, it still exists.
    if removed and one.note is not None and one.path.parent.is_dir():
        with suppress(OSError):
            one.note.unlink()
    return there and removed


def _read(note: Path) -> IncompleteFile | None:
    try:
        with note.open("r+", encoding="utf-8") as file:
            going_on = not lock_file(file, wait=False)
            words = json.load(file)
            return IncompleteFile(
                kind=words["kind"],
                path=Path(words["path"]),
                since=datetime.fromisoformat(words["since"]),
                to=Path(words["to"]),
                study_key=words["study_key"],
                going_on=going_on,
                note=note,
            )
    except (OSError, ValueError, KeyError, TypeError):
        return None


def lock_file(file: IO[Any], *, wait: bool = True) -> bool:
    """Lock a file until it is closed or the process ends; return whether that succeeded.

    Where there are no file locks it returns True. `wait`: until nobody else has it.
    """
    try:
        import fcntl
    except ImportError:
        return True
    try:
        fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks
        return True
    return True
