"""Everything that can go wrong on purpose, on one screen.

ReembodyError                     something was refused; carries value, valid and remedy
├── InvalidInput          422     the request is understood but its content cannot be used
│   └── InvalidConfig     422     a study or instrument file has problems, each with its place
├── NotSignedIn           401     no valid login, token or pairing
├── NotAllowed            403     signed in, but this is not theirs to do
├── NotFound              404     nothing by that name (or not for this reader)
├── Conflict              409     the request clashes with what is already recorded
│   ├── KeptConflict      409     the same, and what was refused is kept in the record
│   ├── StaleVersion      409     somebody else acted first; look again, then decide
│   └── NotNow            409     the session is in a step where this cannot be done
├── Gone                  410     a pairing code was used or has expired
│   └── Withdrawn         410     the participant has withdrawn: nothing more is taken of them
├── TooLarge              413     more bytes than this interface takes
├── TooManyAttempts       429     slow down; says for how long
├── Busy                  503     as much of this work is under way as the server takes at once
└── NotDurable            503     the record cannot be written now, so nothing was promised

Each error says what happened (`message`), the offending `value`, what is `valid`, and what to do
next (`remedy`); `retry_after_s` is sent as the header Retry-After. Science and configuration raise
their own plain errors; services translate them into these. One handler (`app.api.errors`) turns
them into the same JSON for every route.
"""

import errno
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import ClassVar


class ReembodyError(Exception):
    """Something was refused, with the reason and the way out."""

    code: ClassVar[str] = "error"
    status: ClassVar[int] = 500

    def __init__(
        self,
        message: str,
        *,
        value: object = None,
        valid: object = None,
        remedy: str = "",
        details: Sequence[Mapping[str, object]] = (),
        retry_after_s: float | None = None,
    ) -> None:
        super().__init__(message)
        self.message = message
        self.value = value
        self.valid = valid
        self.remedy = remedy
        self.details = tuple(dict(detail) for detail in details)
        self.retry_after_s = retry_after_s

    def as_json(self) -> dict[str, object]:
        """The error as every client sees it."""
        return {
            "code": self.code,
            "message": self.message,
            "value": self.value,
            "valid": self.valid,
            "remedy": self.remedy,
            "details": list(self.details),
        }


class InvalidInput(ReembodyError):
    """The request is understood but its content cannot be used."""

    code = "invalid_input"
    status = 422


class InvalidConfig(InvalidInput):
    """A study or instrument file has problems; `details` lists each with path, line and column."""

    code = "invalid_config"


class NotSignedIn(ReembodyError):
    """No valid login, token or pairing came with the request."""

    code = "not_signed_in"
    status = 401


class NotAllowed(ReembodyError):
    """The caller is known, but this is not theirs to do."""

    code = "not_allowed"
    status = 403


class NotFound(ReembodyError):
    """Nothing by that name, or nothing this reader may know of."""

    code = "not_found"
    status = 404


class Conflict(ReembodyError):
    """The request clashes with what is already recorded."""

    code = "conflict"
    status = 409


class KeptConflict(Conflict):
    """The request clashes with the record, and the record keeps what was refused.

    The transaction that raises it is committed, so that nobody's words are lost.
    """


class StaleVersion(Conflict):
    """Somebody else acted first: the caller decided on a state that has passed."""

    code = "stale"


class NotNow(Conflict):
    """The session is in a step or status where this cannot be done."""

    code = "not_now"


class Gone(ReembodyError):
    """A single-use thing was used already or has expired."""

    code = "gone"
    status = 410


class Withdrawn(Gone):
    """The participant has withdrawn, or their data were erased: nothing more is taken of them."""

    code = "withdrawn"


class TooLarge(ReembodyError):
    """More bytes than this interface takes."""

    code = "too_large"
    status = 413


class TooManyAttempts(ReembodyError):
    """Too many attempts in a short time; the remedy says how long to wait."""

    code = "too_many_attempts"
    status = 429


class Busy(ReembodyError):
    """As much of this work is under way as the server takes at once; nothing was queued."""

    code = "busy"
    status = 503


class DamagedValue(ValueError):
    """A stored value that this program cannot have written: the database is damaged."""


class NotDurable(ReembodyError):
    """The record cannot be written now, so nothing was promised."""

    code = "not_durable"
    status = 503


def as_sentences(*parts: str) -> str:
    """Messages one after the other, each with one full stop at its end; empty ones are left out."""
    stripped = (part.strip() for part in parts)
    return " ".join(
        part if part.endswith((".", "!", "?")) else f"{part}." for part in stripped if part
    )


def missing_file(path: Path) -> str:
    """That a file is not there, with the folder that was looked into, or is no regular file."""
    if path.is_dir():
        return f"{path} is a folder, where a file is needed"
    if path.exists():
        return f"{path} is no regular file (a device, a pipe or the like)"
    if path.is_symlink():
        return f"{path} is a link that leads to no file"
    folder = path.absolute().parent
    if folder.is_dir():
        return f"there is no file {path.name} in {folder}"
    return f"there is no file {path}: there is no folder {folder}"


def file_problem(error: OSError) -> str:
    """What the operating system refuses about a file, without its numbers and brackets.

    An error that names no file is quoted as it is.
    """
    if not isinstance(error.filename, str | bytes):
        return str(error)
    path = Path(os.fsdecode(error.filename))
    match error.errno:
        case errno.ENOENT:
            return missing_file(path)
        case errno.EISDIR:
            return f"{path} is a folder, where a file is needed"
        case errno.ENOTDIR:
            return f"there is no {path}: part of that path is a file, not a folder"
        case errno.EACCES | errno.EPERM:
            return f"{path} cannot be opened: your account does not have the permission"
        case _:
            return f"{path}: {error.strerror}"
