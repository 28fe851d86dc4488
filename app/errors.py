"""All errors that the application raises deliberately.

ReembodyError                     a request was refused; has value, valid and remedy
├── InvalidInput          422     the request is understood but its content cannot be used
│   └── InvalidConfig     422     a study or instrument file has problems, each with its place
├── NotSignedIn           401     no valid login, token or pairing
├── NotAllowed            403     signed in, but without the permission
├── NotFound              404     does not exist, or must not be visible to this caller
├── Conflict              409     the request contradicts what is already recorded
│   ├── RecordedConflict      409     the same, and the refused input is stored in the record
│   ├── StaleVersion      409     the session has changed since the caller read it
│   ├── NotNow            409     not possible in the session's current step or status
│   ├── OtherAccount      409     the page shows another account than the signed-in one
│   └── TakenOver         409     a newer connection of the same headset has taken over
├── Gone                  410     a pairing code was used or has expired
│   └── Withdrawn         410     the participant has withdrawn: no more of their data are stored
├── TooLarge              413     the request has more bytes than allowed
├── TooManyAttempts       429     too many attempts; says how long to wait
├── Busy                  503     the server already runs as much of this work as it can
└── NotDurable            503     the record cannot be written now, so nothing was stored

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
    """Base class of refused requests, with the reason and the remedy."""

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
        """Return the error's JSON object as sent to every client."""
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
    """The request has no valid login, token or pairing."""

    code = "not_signed_in"
    status = 401


class NotAllowed(ReembodyError):
    """The caller is signed in but does not have the permission."""

    code = "not_allowed"
    status = 403


class NotFound(ReembodyError):
    """The object does not exist, or must not be visible to this caller."""

    code = "not_found"
    status = 404


class Conflict(ReembodyError):
    """The request contradicts what is already recorded."""

    code = "conflict"
    status = 409


class RecordedConflict(Conflict):
    """The request contradicts the record, but what was refused is stored in the record.

    The transaction that raises it is committed, so that no participant's answers are lost.
    """


class StaleVersion(Conflict):
    """What is to be changed has changed since the caller read the version that they start from."""

    code = "stale"


class NotNow(Conflict):
    """The request is not possible in the session's current step or status."""

    code = "not_now"


class OtherAccount(Conflict):
    """The request comes from a page that shows another account than the one signed in now."""

    code = "other_account"


class TakenOver(Conflict):
    """A newer connection of the same headset has taken over, so this one is closed."""

    code = "taken_over"


class Gone(ReembodyError):
    """A single-use code or link was already used or has expired."""

    code = "gone"
    status = 410


class Withdrawn(Gone):
    """The participant has withdrawn, or their data were erased.

    No more of their data are stored.
    """

    code = "withdrawn"


class TooLarge(ReembodyError):
    """The request has more bytes than this interface accepts."""

    code = "too_large"
    status = 413


class TooManyAttempts(ReembodyError):
    """Too many attempts were made in a short time; the remedy says how long to wait."""

    code = "too_many_attempts"
    status = 429


class Busy(ReembodyError):
    """The server already runs as much of this work as it can; nothing was queued."""

    code = "busy"
    status = 503


class DamagedValue(ValueError):
    """A stored value that this program cannot have written: the database is damaged."""


class NotDurable(ReembodyError):
    """The record cannot be written now, so nothing was stored."""

    code = "not_durable"
    status = 503


def as_sentences(*parts: str) -> str:
    """Join messages, ending each with a full stop; empty messages are left out."""
    stripped = (part.strip() for part in parts)
    return " ".join(
        part if part.endswith((".", "!", "?")) else f"{part}." for part in stripped if part
    )


def missing_file(path: Path) -> str:
    """Describe why there is no regular file at `path`, naming the folder that was searched."""
    if path.is_dir():
        return f"{path} is a folder, where a file is needed"
    if path.exists():
        return f"{path} is not a regular file (a device, a pipe or the like)"
    if path.is_symlink():
        return f"{path} is a link that leads to no file"
    folder = path.absolute().parent
    if folder.is_dir():
        return f"there is no file {path.name} in {folder}"
    return f"there is no file {path}: there is no folder {folder}"


def file_problem(error: OSError) -> str:
    """Describe an operating system error about a file, without error numbers.

    An error that names no file is quoted unchanged.
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
