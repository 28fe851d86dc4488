"""One handler: every refusal reaches every client in the same shape."""

import json
import logging
import math
import sqlite3
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import TypeAdapter
from sqlalchemy.exc import DatabaseError, DataError, IntegrityError, OperationalError
from starlette.exceptions import HTTPException

from app.errors import (
    Conflict,
    DamagedValue,
    InvalidInput,
    NotAllowed,
    NotDurable,
    NotFound,
    ReembodyError,
)
from app.platform.text import printable
from app.platform.trouble import BUSY, DAMAGED, explain

log = logging.getLogger(__name__)
MOST_DETAILS = 50
LONGEST_VALUE = 100
LONGEST_TEXT = 2000
MOST_ITEMS = 500
MOST_CHARACTERS = 60_000
DEEPEST = 8
UNREADABLE = 400
"""What the framework says of a body that Python's JSON reader gives up on."""


def error_response(error: ReembodyError) -> JSONResponse:
    """The JSON of an error with its status: a few kilobytes, however much was sent."""
    headers = None
    if error.retry_after_s is not None:
        headers = {"retry-after": str(max(1, math.ceil(error.retry_after_s)))}
    told = _Bounded().jsonable(error.as_json())
    return JSONResponse({"error": told}, status_code=error.status, headers=headers)


def install_error_handler(app: FastAPI) -> None:
    """Translate every error of ours, and the framework's, into one shape."""

    @app.exception_handler(ReembodyError)
    def ours(_: Request, error: ReembodyError) -> JSONResponse:
        return error_response(error)

    @app.exception_handler(RequestValidationError)
    def validation(request: Request, error: RequestValidationError) -> JSONResponse:
        fields, problems = _fields_beside_secrets(request.scope.get("route")), error.errors()
        more = len(problems) - MOST_DETAILS
        return error_response(
            InvalidInput(
                "the request does not fit",
                remedy="Mend the fields named below; nothing was stored."
                + (f" {more} more problems are not listed." if more > 0 else ""),
                details=[
                    {
                        "path": _path(problem["loc"], fields),
                        "message": problem["msg"],
                        # A container would be the whole input; of a missing field it is all others.
                        "value": None if fields else _scalar(problem.get("input")),
                    }
                    for problem in problems[:MOST_DETAILS]
                ],
            )
        )

    _install_database_handlers(app)

    @app.exception_handler(HTTPException)
    def framework(_: Request, error: HTTPException) -> JSONResponse:
        # The framework wraps what goes wrong while a body is read, such as our limit on its size.
        if isinstance(error.__cause__, ReembodyError):
            return error_response(error.__cause__)
        if error.status_code == UNREADABLE and isinstance(
            error.__cause__, ValueError | RecursionError
        ):
            return error_response(_unreadable_body())
        if error.status_code == NotFound.status:
            return error_response(NotFound("there is nothing at this address"))
        if error.status_code == NotAllowed.status:
            return error_response(NotAllowed(str(error.detail)))
        body = {"error": {**ReembodyError(str(error.detail)).as_json(), "code": "http"}}
        return JSONResponse(body, status_code=error.status_code, headers=error.headers)

    @app.exception_handler(Exception)
    def anything_else(_: Request, _error: Exception) -> JSONResponse:
        return _went_wrong()


def _install_database_handlers(app: FastAPI) -> None:
    """What the database or the disk refuses, in our words: its own would tell of the inside."""

    @app.exception_handler(OperationalError)
    def not_now(_: Request, error: OperationalError) -> JSONResponse:
        _log_refusal(error)
        return _not_durable(error)

    @app.exception_handler(DatabaseError)
    def never(_: Request, error: DatabaseError) -> JSONResponse:
        _log_refusal(error)
        return _went_wrong() if explain(error) is None else _not_durable(error)

    # What is in a request is checked where it comes in; text that cannot be read here was stored.
    @app.exception_handler(UnicodeDecodeError)
    @app.exception_handler(DamagedValue)
    @app.exception_handler(sqlite3.Error)
    @app.exception_handler(OSError)
    def refused(_: Request, error: Exception) -> JSONResponse:
        _log_refusal(error)
        return _went_wrong() if explain(error) is None else _not_durable(error)

    @app.exception_handler(json.JSONDecodeError)
    def not_as_stored(_: Request, error: Exception) -> JSONResponse:
        log.error("what is stored was damaged", exc_info=error)
        return error_response(
            NotDurable(f"{DAMAGED.message}: nothing was stored", remedy=DAMAGED.remedy)
        )

    @app.exception_handler(IntegrityError)
    def clash(_: Request, error: IntegrityError) -> JSONResponse:
        log.warning("two requests clashed", exc_info=error)
        return error_response(
            Conflict(
                "somebody else stored the same at the same moment; nothing was stored",
                remedy="Look again, then decide.",
            )
        )

    @app.exception_handler(DataError)
    def unusable(_: Request, _error: DataError) -> JSONResponse:
        return error_response(
            InvalidInput(
                "the request holds a value that cannot be stored; nothing was stored",
                remedy="Leave out control characters and numbers beyond all measure.",
            )
        )


def _log_refusal(error: Exception) -> None:
    trouble = explain(error)
    if trouble is None:
        log.error("the database refused", exc_info=error)
    else:
        # Where it came from was logged when it began; a full disk must not be filled by telling.
        log.error("a request was refused: %s (%s)", trouble.message, getattr(error, "orig", error))


def _not_durable(error: Exception) -> JSONResponse:
    trouble = explain(error) or BUSY
    message = f"{trouble.message}: nothing was stored or promised"
    return error_response(NotDurable(message, remedy=f"{trouble.remedy} Then try again."))


def _went_wrong() -> JSONResponse:
    return error_response(
        ReembodyError(
            "something went wrong on the server; nothing was stored",
            remedy="Try again. If it happens again, the server's log tells why.",
        )
    )


def _unreadable_body() -> InvalidInput:
    return InvalidInput(
        "the request's body is JSON that cannot be read: a number in it has too many digits, or "
        "its lists and objects stand too deep inside each other",
        valid="JSON with numbers of at most 4300 digits, nested a few hundred deep at most",
        remedy="Send it again without that; nothing was stored.",
    )


def _fields_beside_secrets(route: object) -> frozenset[str]:
    """The names in a route's body if one of them is marked as a secret (`writeOnly`), else none.

    Where there is one, no value is repeated, not even of other fields, and no name but these: a
    password may stand in any place.
    """
    field = getattr(route, "body_field", None)
    model = getattr(getattr(field, "field_info", None), "annotation", None)
    return frozenset() if model is None else _names_beside_secrets(model)


@lru_cache(maxsize=256)
def _names_beside_secrets(model: Any) -> frozenset[str]:
    schema = TypeAdapter(model).json_schema(mode="validation")
    if '"writeOnly": true' not in json.dumps(schema):
        return frozenset()
    parts = [schema, *schema.get("$defs", {}).values()]
    return frozenset(name for part in parts for name in part.get("properties", {}))


def _path(place: Sequence[object], fields: frozenset[str]) -> str:
    """Where in a request it is; beside secrets only what we call things ourselves."""
    hidden = bool(fields) and place[:1] == ("body",)
    return ".".join(
        "(a field that is not known)"
        if hidden and isinstance(part, str) and part not in fields
        else str(part)[:LONGEST_VALUE]
        for part in place[1:]
    )


def _scalar(value: object) -> object:
    if isinstance(value, str):
        return value if len(value) <= LONGEST_VALUE else f"{value[:LONGEST_VALUE]}..."
    return value if isinstance(value, bool | int | float) else None


@dataclass
class _Bounded:
    """Values as JSON can carry them, and no more characters of them than a reader wants.

    NaN and bytes become text, lone surrogates are written out, long lists and texts are cut.
    """

    left: int = MOST_CHARACTERS

    def jsonable(self, value: Any, depth: int = 0) -> Any:
        """The value, cut where it is too long or too deep."""
        if value is None or isinstance(value, bool):
            return value
        if isinstance(value, int) and abs(value) < 2**63:
            return value
        if isinstance(value, float) and math.isfinite(value):
            return value
        if isinstance(value, Mapping | list | tuple | set | frozenset) and depth >= DEEPEST:
            return "..."
        if isinstance(value, Mapping):
            return {
                self._text(str(key)): self.jsonable(one, depth + 1)
                for key, one in list(value.items())[:MOST_ITEMS]
            }
        if isinstance(value, Sequence | set | frozenset) and not isinstance(
            value, str | bytes | bytearray
        ):
            kept = list(value)[:MOST_ITEMS]
            # The end of a cut list is not marked: readers expect entries of one kind.
            return [self.jsonable(one, depth + 1) for one in kept if self.left > 0]
        return self._text(value if isinstance(value, str) else _written(value))

    def _text(self, text: str) -> str:
        most = max(0, min(LONGEST_TEXT, self.left))
        cut = text if len(text) <= most else f"{text[:most]}..."
        self.left -= len(cut)
        return printable(cut)


def _written(value: object) -> str:
    # Python refuses to write integers of more than 4300 digits.
    return "a very large number" if isinstance(value, int) else str(value)
