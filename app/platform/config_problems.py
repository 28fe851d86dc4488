"""Describe problems of study and instrument files, and detect stored ones that were damaged."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Literal, TypeVar

from pydantic import BaseModel

from app.errors import InvalidConfig, NotDurable
from app.platform.trouble import DAMAGED
from app.protocol import ConfigError, sha256_of

Parsed = TypeVar("Parsed")


class ProblemView(BaseModel):
    """One problem of a file: its place, the message, what is valid, what to do.

    Lines and columns count from 1.
    """

    path: str
    line: int
    column: int
    message: str
    value: object = None
    valid: object = None
    remedy: str = ""


def problem_views(error: ConfigError) -> list[ProblemView]:
    """Return every problem of the file, in the order of the file."""
    return [ProblemView(**problem.as_json()) for problem in error.problems]


def invalid_config(what: str, error: ConfigError) -> InvalidConfig:
    """Make the error for an invalid file, with every problem in its details.

    `what` names the kind of file, such as "study".
    """
    problems = [view.model_dump() for view in problem_views(error)]
    count = len(problems)
    return InvalidConfig(
        f"the {what} file has {count} problem{'s' if count != 1 else ''}",
        remedy="Correct the lines listed below; nothing was stored.",
        details=problems,
    )


def require_sound(stored: str, content_hash: str) -> None:
    """Raise NotDurable if a stored text does not have its hash, because it was damaged."""
    if sha256_of(stored) != content_hash:
        raise _damaged()


@contextmanager
def unpacking(stored: str, content_hash: str) -> Iterator[None]:
    """Raise NotDurable if parsing a stored text fails because the text was damaged.

    If the text still has its hash, the original error is raised.
    """
    try:
        yield
    except Exception as error:
        if sha256_of(stored) == content_hash:
            raise
        raise _damaged() from error


FaultKind = Literal["damaged", "unreadable", "incomplete"]


@dataclass(frozen=True)
class StoredFault:
    """What is wrong with a stored version of a study, an instrument or an avatar.

    `kind`: `damaged`, its content does not have its hash; `unreadable`, this release cannot read
    it; `incomplete`, it can be read, but nothing can use it. `version` is None if only the content,
    which cannot be read, says which one it is.
    """

    key: str
    version: int | None
    kind: FaultKind
    problem: str
    remedy: str


def stored_fault(
    key: str,
    version: int | None,
    stored: tuple[str, str],
    parse: Callable[[str], Parsed],
    problems: Callable[[Parsed], Iterable[str]] = lambda _: (),
) -> StoredFault | None:
    """Return what is wrong with a stored content and its hash; None if nothing is.

    `parse` raises ValueError for a content that cannot be read; `problems` yields why what was read
    cannot be used.
    """
    content, content_hash = stored
    if sha256_of(content) != content_hash:
        return StoredFault(key, version, "damaged", "its content was changed", DAMAGED.remedy)
    try:
        parsed = parse(content)
    except ValueError as error:
        reason = str(error).strip().partition("\n")[0]
        remedy = "Use the release of Reembody that stored it, and report this."
        return StoredFault(key, version, "unreadable", reason, remedy)
    for problem in problems(parsed):
        remedy = "Studies cannot use it; save a version in which this is corrected."
        return StoredFault(key, version, "incomplete", problem, remedy)
    return None


def _damaged() -> NotDurable:
    return NotDurable(f"{DAMAGED.message}: nothing was stored", remedy=DAMAGED.remedy)
