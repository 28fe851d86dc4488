"""Files that are being made outside of the database, and what is left of them after a crash.

An export or a backup is written beside its place, anywhere on the machine, and moved there once it
is whole. Whoever makes one keeps a note of it in the data folder, locked as long as the process
lives. So what a crash left is known: it is listed, removed at the next start of the server and
with every erasure, which must not leave half an export of an erased person behind. What is made
within the data folder (uploads, a new database, a backup that is migrated) is known by its place.
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
from typing import IO, Literal

from app.platform.folders import BEGINNING, home_of
from app.settings import Settings

Kind = Literal["backup", "export", "upload", "restore", "database", "check"]
PARTIAL = ".partial"
"""How the names of folders end in which something is made beside its place."""
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
class HalfMade:
    """Something that is not whole: what it is, where it lies, since when.

    `to`: where it would have been. `study_key`: of an export. `going_on`: its process lives.
    """

    kind: Kind
    path: Path
    since: datetime
    to: Path | None = None
    study_key: str | None = None
    going_on: bool = False
    note: Path | None = None


def uploads_of(settings: Settings) -> Path:
    """The folder for files on their way into the database; it is made if need be."""
    folder = settings.scratch_dir / UPLOADS
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    return folder


@dataclass(frozen=True)
class Notes:
    """The notes of an installation on what is made outside of its folder."""

    folder: Path

    @classmethod
    def of(cls, settings: Settings) -> "Notes":
        """Those beside the database."""
        return cls(home_of(settings) / "half-made")

    @contextmanager
    def on(
        self, kind: Kind, path: Path, *, to: Path, now: datetime, study_key: str | None = None
    ) -> Iterator[None]:
        """Keep a note while `path` is there; raises OSError where none can be kept."""
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
            _lock(file)
            json.dump(words, file)
            file.flush()
            os.fsync(file.fileno())
            try:
                yield
            finally:
                # A note that cannot be removed is no reason to fail: the next start removes it.
                if not os.path.lexists(path):
                    with suppress(OSError):
                        note.unlink()

    def all(self) -> list[HalfMade]:
        """What is noted, oldest first; a note that was not finished says nothing yet."""
        found = [one for note in self.folder.glob("*.json") if (one := _read(note)) is not None]
        return sorted(found, key=lambda one: (one.since, one.path))


@contextmanager
def made_beside(
    kind: Kind, to: Path, *, now: datetime, notes: Notes | None, study_key: str | None = None
) -> Iterator[Path]:
    """A folder beside `to`, that only its owner can look into and that is gone afterwards.

    With `notes` it is noted before it is there. Raises OSError where it cannot be made.
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


def half_made(settings: Settings) -> list[HalfMade]:
    """Everything that is not whole, going on or left by a crash, oldest first."""
    home = home_of(settings)
    found = Notes.of(settings).all()
    for kind, pattern in _BY_PLACE:
        for folder in {home.resolve(), settings.data_dir.resolve()}:
            for path in folder.glob(pattern):
                with suppress(OSError):  # it went away meanwhile
                    since = datetime.fromtimestamp(path.lstat().st_mtime, UTC)
                    found.append(HalfMade(kind, path, since))
    return sorted(found, key=lambda one: (one.since, one.path))


def remove_left(settings: Settings, *, starting: bool = False) -> list[HalfMade]:
    """Remove what processes left that are gone; what was removed.

    `starting`: no server has the folder yet, so that what is known by its place is nobody's, too.
    What cannot be removed (its disk is not there) stays on the list.
    """
    found = half_made(settings) if starting else Notes.of(settings).all()
    removed = [one for one in found if not one.going_on and _remove(one)]
    if starting:
        # A crash cut them off: nothing was begun yet.
        for note in [one for one in Notes.of(settings).folder.glob("*.json") if not _read(one)]:
            note.unlink(missing_ok=True)
    return removed


def _remove(one: HalfMade) -> bool:
    """Whether it was there and is gone. A note that names something else removes nothing."""
    there = os.path.lexists(one.path)
    with suppress(OSError):
        if one.note is None or one.path.name.endswith(PARTIAL):
            # An export that was being replaced goes back to its place.
            if one.to is not None and (one.path / "old").is_dir() and not one.to.exists():
                (one.path / "old").rename(one.to)
            shutil.rmtree(one.path) if one.path.is_dir() else one.path.unlink(missing_ok=True)
    gone = not os.path.lexists(one.path)
    # On a disk that is not there it is not gone.
    if gone and one.note is not None and one.path.parent.is_dir():
        with suppress(OSError):
            one.note.unlink()
    return there and gone


def _read(note: Path) -> HalfMade | None:
    try:
        with note.open("r+", encoding="utf-8") as file:
            going_on = not _lock(file, wait=False)
            words = json.load(file)
            return HalfMade(
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


def _lock(file: IO[str], *, wait: bool = True) -> bool:
    """Lock a note until the process ends; whether it is ours. True where there are no locks."""
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
