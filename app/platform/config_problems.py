"""Describe problems of study and instrument files, and detect stored ones that were damaged."""

from collections.abc import Iterator
from contextlib import contextmanager

from pydantic import BaseModel

from app.errors import InvalidConfig, NotDurable
from app.platform.trouble import DAMAGED
from app.protocol import ConfigError, sha256_of


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
        raise NotDurable(f"{DAMAGED.message}: nothing was stored", remedy=DAMAGED.remedy) from error
