"""The erasures of an installation, one JSON line each, in a file next to the database.

A backup that is older than an erasure still has the data. Restoring it also restores the table of
erasures of that moment; this file is not replaced, and lists what has to be erased again. It has
only ids. It is completed from the table at every start.
"""

import json
import logging
import os
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotDurable, NotFound, file_problem, missing_file
from app.models import Erasure
from app.platform.folders import home_of
from app.platform.trouble import errors_as_not_durable
from app.settings import Settings

log = logging.getLogger(__name__)
NAME = "erasures.jsonl"


@dataclass(frozen=True)
class Tombstone:
    """An erasure, with the ids of what was erased; `at`: ISO 8601, UTC."""

    erasure_id: str
    study_id: str
    participant_id: str
    sessions: tuple[str, ...]
    by: str
    at: str


@dataclass(frozen=True)
class TombstoneFile:
    """The list of erasures in the data folder of this installation."""

    folder: Path

    @property
    def path(self) -> Path:
        """Return the path of the list."""
        return self.folder / NAME

    def read(self) -> list[Tombstone]:
        """Return every erasure in the list, without a line that a crash truncated.

        Raises NotDurable if it cannot be read, because erased data must not reappear for that
        reason.
        """
        with errors_as_not_durable(f"the list of erasures {self.path} cannot be read"):
            if not self.path.exists():
                return []
            found, unreadable = _parsed(self.path.read_bytes())
        if unreadable:
            log.warning(
                "%d line(s) of %s are not erasures, and were left out", unreadable, self.path
            )
        return found

    def add(self, tombstones: Iterable[Tombstone]) -> None:
        """Append new erasures, flushed to the disk; raise NotDurable if that fails."""
        known_ids = {one.erasure_id for one in self.read()}
        new = [one for one in tombstones if one.erasure_id not in known_ids]
        if not new:
            return
        # Start on a new line if the last one was truncated.
        lines = "\n" + "".join(json.dumps(asdict(one)) + "\n" for one in new)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            with self.path.open("a", encoding="utf-8") as file:
                file.write(lines.removeprefix("\n") if self._ends_with_newline() else lines)
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            raise NotDurable(
                f"the data were erased, but the list could not be written: {file_problem(error)}",
                remedy="Free some space there, then start the server again: it completes the list.",
            ) from error

    def _ends_with_newline(self) -> bool:
        return not self.path.exists() or self.path.read_bytes()[-1:] in (b"", b"\n")


def read_list(path: Path) -> tuple[Tombstone, ...]:
    """Return the erasures in the list of an earlier data folder.

    Unlike the list of this installation, it is not completed from a table, so an invalid line is an
    error. Raises NotFound, NotDurable, and InvalidInput for a file that is not a list of erasures.
    """
    if not path.is_file():
        raise NotFound(
            missing_file(path),
            value=str(path),
            valid=f"the file {NAME} of a data folder",
            remedy="Name the list of erasures of the earlier data folder; nothing was changed.",
        )
    with errors_as_not_durable(f"the list of erasures {path} cannot be read"):
        found, unreadable = _parsed(path.read_bytes())
    if unreadable:
        raise InvalidInput(
            f"{unreadable} line(s) of {path} are not erasures; nothing was changed",
            value=str(path),
            valid=f"the file {NAME} of a data folder",
            remedy="Use another copy of it, or correct the line by hand: each line is one erasure.",
        )
    return tuple(found)


def _parsed(data: bytes) -> tuple[list[Tombstone], int]:
    """Return the erasures of a list, and the number of invalid lines."""
    found, unreadable = [], 0
    for line in data.splitlines():
        try:
            values = json.loads(line)
            one = Tombstone(**{**values, "sessions": tuple(values["sessions"])})
            moment(one)
            if not all(isinstance(part, str) for part in (*one.sessions, one.erasure_id, one.by)):
                raise TypeError
        except (ValueError, TypeError, KeyError):
            unreadable += bool(line.strip())
        else:
            found.append(one)
    return found, unreadable


def tombstone_file(settings: Settings) -> TombstoneFile:
    """Return the list of this installation, in the folder of its automatic backups."""
    return TombstoneFile(home_of(settings))


def tombstones_of(db: Session) -> list[Tombstone]:
    """Return every erasure in the table, oldest first."""
    return [tombstone(row) for row in db.scalars(select(Erasure).order_by(Erasure.at, Erasure.id))]


def tombstone(row: Erasure) -> Tombstone:
    """Return an erasure as an entry of the list."""
    return Tombstone(
        erasure_id=row.id,
        study_id=row.study_id,
        participant_id=row.participant_id,
        sessions=tuple(str(one) for one in row.sessions),
        by=row.by,
        at=row.at.astimezone(UTC).isoformat(),
    )


def moment(one: Tombstone) -> datetime:
    """Return when the data were first erased."""
    return datetime.fromisoformat(one.at)
