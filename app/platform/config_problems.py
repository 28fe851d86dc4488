"""What is wrong with a study or instrument file, and with one that was stored and then damaged."""

from collections.abc import Iterator
from contextlib import contextmanager

from pydantic import BaseModel

from app.errors import InvalidConfig, NotDurable
from app.platform.trouble import DAMAGED
from app.protocol import ConfigError, sha256_of


class ProblemView(BaseModel):
    """One thing to correct in a file: where, what, what is valid, what to do. Lines from 1."""

    path: str
    line: int
    column: int
    message: str
    value: object = None
    valid: object = None
    remedy: str = ""


def problem_views(error: ConfigError) -> list[ProblemView]:
    """Every problem of the file, in its order."""
    return [ProblemView(**problem.as_json()) for problem in error.problems]


def invalid_config(what: str, error: ConfigError) -> InvalidConfig:
    """The refusal of a file with every problem in its details; `what` is "study" or the like."""
    problems = [view.model_dump() for view in problem_views(error)]
    count = len(problems)
    return InvalidConfig(
        f"the {what} file has {count} problem{'s' if count != 1 else ''}",
        remedy="Mend the lines named below; nothing was stored.",
        details=problems,
    )


@contextmanager
def unpacking(stored: str, content_hash: str) -> Iterator[None]:
    """Raise NotDurable where a stored text is unpacked that is not the one that was stored.

    Whatever unpacking it raises passes where the text still has its hash.
    """
    try:
        yield
    except Exception as error:
        if sha256_of(stored) == content_hash:
            raise
        raise NotDurable(f"{DAMAGED.message}: nothing was stored", remedy=DAMAGED.remedy) from error
