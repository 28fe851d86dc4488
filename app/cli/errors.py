"""How a command says that it cannot go on: why on standard error, and the exit code.

A command takes what it calls into `reported`, so that no other place puts an error into words.
Ctrl+C is Typer's ("Aborted!"), but where it ends a command well: a server stops, and a tuning says
that nothing was kept.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NoReturn

from app.errors import ReembodyError, as_sentences, file_problem

INCOMPLETE, UNUSABLE = 1, 2
"""Exit codes: something of a session is missing; the input or the installation cannot be used."""

ERASE_LINE = "\r\033[K"
"""Takes back what stands on the present line of a terminal."""


def fail(message: str) -> NoReturn:
    """Say what is wrong and leave with the status for unusable input."""
    warn(message)
    raise SystemExit(UNUSABLE)


def warn(message: str) -> None:
    """Say what went wrong where the command can go on all the same."""
    # Behind what a long command says of itself on the same line of a terminal.
    print(f"{ERASE_LINE if sys.stderr.isatty() else ''}reembody: {message}", file=sys.stderr)


def require_folder_of(out: Path | None) -> None:
    """Refuse a file to write whose folder is missing, before the work; raises ValueError."""
    if out is not None and not out.absolute().parent.is_dir():
        raise ValueError(f"--out {out}: there is no folder {out.absolute().parent}")


@contextmanager
def reported(*expected: type[Exception], with_valid: bool = False) -> Iterator[None]:
    """Fail with the words of an error of the product, and of those `expected` of the input.

    `with_valid` adds what would be valid, where an error lists it. Any other error is a fault of
    the program, whose trace is wanted.
    """
    try:
        yield
    except ReembodyError as error:
        valid = ""
        if with_valid and isinstance(error.valid, list):
            valid = f"; valid: {', '.join(error.valid)}"
        fail(as_sentences(f"{error.message}{valid}", error.remedy))
    except expected as error:
        fail(file_problem(error) if isinstance(error, OSError) else str(error))
    except Exception as error:
        refused = _refused_by_storage(error)
        if refused is None:
            raise
        fail(as_sentences(refused.message, refused.remedy))


def _refused_by_storage(error: Exception) -> ReembodyError | None:
    """What a database refuses, in words; None for any other error, a fault of the program."""
    if not type(error).__module__.startswith(("sqlite3", "sqlalchemy")):
        return None  # without loading what a command may never need
    from app.platform.trouble import explain, in_plain_words, proves_damage

    if explain(error) is None and not proves_damage(error):
        return None
    return in_plain_words("the database did not take part", error)
