"""Report errors of commands: the reason on standard error, and the exit code.

Every command wraps its calls in `reported`, so that errors are worded only here. Typer handles
Ctrl+C ("Aborted!"), except where it ends a command normally: a server stops, and a tuning reports
that nothing was stored.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from difflib import get_close_matches
from typing import NoReturn

from app.errors import ReembodyError, as_sentences, file_problem

INCOMPLETE, UNUSABLE = 1, 2
"""Exit codes: something of a session is missing; the input or the installation cannot be used."""

ERASE_LINE = "\r\033[K"
"""Control sequence that erases the current line of a terminal."""


def fail(message: str) -> NoReturn:
    """Print an error message and exit with the status for unusable input."""
    warn(message)
    raise SystemExit(UNUSABLE)


def warn(message: str) -> None:
    """Print a warning of a command that continues."""
    # Replaces the progress line of a long command on a terminal.
    print(f"{ERASE_LINE if sys.stderr.isatty() else ''}reembody: {message}", file=sys.stderr)


@contextmanager
def reported(*expected: type[Exception], with_valid: bool = False) -> Iterator[None]:
    """Exit with the message of a ReembodyError, of a database error, or of an `expected` error.

    `with_valid` adds the valid values, and the one that was probably meant; the problems of which
    an error consists are listed below it. Any other error is a fault of the program and keeps its
    traceback.
    """
    try:
        yield
    except ReembodyError as error:
        fail("\n".join([_sentence(error, with_valid=with_valid), *_details(error)]))
    except expected as error:
        fail(file_problem(error) if isinstance(error, OSError) else str(error))
    except Exception as error:
        refused = _refused_by_storage(error)
        if refused is None:
            raise
        fail(as_sentences(refused.message, refused.remedy))


def _sentence(error: ReembodyError, *, with_valid: bool) -> str:
    valid, meant = "", ""
    if with_valid and isinstance(error.valid, list):
        words = [str(one) for one in error.valid]
        valid = f"; valid: {', '.join(words)}"
        close = get_close_matches(str(error.value), words, n=1)
        meant = f"Did you mean {close[0]}?" if close else ""
    elif with_valid and isinstance(error.valid, str):
        valid = f"; valid: {error.valid}"
    return as_sentences(f"{error.message}{valid}", meant, error.remedy)


def _details(error: ReembodyError) -> Iterator[str]:
    for one in error.details:
        where, said = one.get("path", ""), one.get("message", "")
        yield f"  {where}: {as_sentences(str(said), str(one.get('remedy') or ''))}"


def _refused_by_storage(error: Exception) -> ReembodyError | None:
    """Return the explanation of a database error; None for any other error."""
    if not type(error).__module__.startswith(("sqlite3", "sqlalchemy")):
        return None  # avoids loading SQLAlchemy, which a command may never need
    from app.platform.trouble import explain, not_durable_error, proves_damage

    if explain(error) is None and not proves_damage(error):
        return None
    return not_durable_error("the database reported an error", error)
