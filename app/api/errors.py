"""Convert every error to the same JSON shape for every client."""

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
"""The framework's status for a body that Python's JSON parser cannot read."""


def error_response(error: ReembodyError) -> JSONResponse:
    """Return the response to an error, a few kilobytes at most, however much was sent."""
    headers = None
    if error.retry_after_s is not None:
        headers = {"retry-after": str(max(1, math.ceil(error.retry_after_s)))}
    content = _Bounded().jsonable(error.as_json())
    return JSONResponse({"error": content}, status_code=error.status, headers=headers)


def install_error_handler(app: FastAPI) -> None:
    """Convert every error, ours and the framework's, to the same shape."""

    @app.exception_handler(ReembodyError)
    def ours(_: Request, error: ReembodyError) -> JSONResponse:
        return error_response(error)

    @app.exception_handler(RequestValidationError)
    def validation(request: Request, error: RequestValidationError) -> JSONResponse:
        fields, problems = _fields_if_secret(request.scope.get("route")), error.errors()
        more = len(problems) - MOST_DETAILS
        return error_response(
            InvalidInput(
                "the request is not valid",
                remedy="Correct the fields listed below; nothing was stored."
                + (f" {more} more problems are not listed." if more > 0 else ""),
                details=[
                    {
                        "path": _path(problem["loc"], fields),
                        "message": problem["msg"],
                        # A container could be the whole input; for a missing field it is all other
                        # fields.
                        "value": None if fields else _scalar(problem.get("input")),
                    }
                    for problem in problems[:MOST_DETAILS]
                ],
            )
        )

    _install_database_handlers(app)

    @app.exception_handler(HTTPException)
    def framework(_: Request, error: HTTPException) -> JSONResponse:
        # The framework wraps errors raised while a body is read, such as our limit on its size.
        if isinstance(error.__cause__, ReembodyError):
            return error_response(error.__cause__)
        if error.status_code == UNREADABLE and isinstance(
            error.__cause__, ValueError | RecursionError
        ):
            return error_response(_unreadable_body())
        if error.status_code == NotFound.status:
            return error_response(NotFound("nothing exists at this address"))
        if error.status_code == NotAllowed.status:
            return error_response(NotAllowed(str(error.detail)))
        body = {"error": {**ReembodyError(str(error.detail)).as_json(), "code": "http"}}
        return JSONResponse(body, status_code=error.status_code, headers=error.headers)

    @app.exception_handler(Exception)
    def anything_else(_: Request, _error: Exception) -> JSONResponse:
        return _went_wrong()


def _install_database_handlers(app: FastAPI) -> None:
    """Report errors of the database or the disk without disclosing internals."""

    @app.exception_handler(OperationalError)
    def not_now(_: Request, error: OperationalError) -> JSONResponse:
        _log_refusal(error)
        return _not_durable(error)

    @app.exception_handler(DatabaseError)
    def never(_: Request, error: DatabaseError) -> JSONResponse:
        _log_refusal(error)
        return _went_wrong() if explain(error) is None else _not_durable(error)

    # Requests are checked on arrival, so text that cannot be decoded here comes from the database.
    @app.exception_handler(UnicodeDecodeError)
    @app.exception_handler(DamagedValue)
    @app.exception_handler(sqlite3.Error)
    @app.exception_handler(OSError)
    def refused(_: Request, error: Exception) -> JSONResponse:
        _log_refusal(error)
        return _went_wrong() if explain(error) is None else _not_durable(error)

    @app.exception_handler(json.JSONDecodeError)
    def not_as_stored(_: Request, error: Exception) -> JSONResponse:
        log.error("stored data are damaged", exc_info=error)
        return error_response(
            NotDurable(f"{DAMAGED.message}: nothing was stored", remedy=DAMAGED.remedy)
        )

    @app.exception_handler(IntegrityError)
    def clash(_: Request, error: IntegrityError) -> JSONResponse:
        log.warning("two requests were in conflict", exc_info=error)
        return error_response(
            Conflict(
                "somebody else stored the same thing at the same moment; nothing of yours was "
                "stored",
                remedy="Reload, then decide.",
            )
        )

    @app.exception_handler(DataError)
    def unusable(_: Request, _error: DataError) -> JSONResponse:
        return error_response(
            InvalidInput(
                "the request contains a value that cannot be stored; nothing was stored",
                remedy="Leave out control characters and excessively large numbers.",
            )
        )


def _log_refusal(error: Exception) -> None:
    trouble = explain(error)
    if trouble is None:
        log.error("the database refused", exc_info=error)
    else:
        # Without a traceback: it was logged when the trouble began, and must not fill a full disk.
        log.error("a request was refused: %s (%s)", trouble.message, getattr(error, "orig", error))


def _not_durable(error: Exception) -> JSONResponse:
    trouble = explain(error) or BUSY
    message = f"{trouble.message}: nothing was stored or promised"
    return error_response(NotDurable(message, remedy=f"{trouble.remedy} Then try again."))


def _went_wrong() -> JSONResponse:
    return error_response(
        ReembodyError(
            "an unexpected error occurred on the server; nothing was stored",
            remedy="Try again. If it happens again, see the server's log for the reason.",
        )
    )


def _unreadable_body() -> InvalidInput:
    return InvalidInput(
        "the request's body is JSON that cannot be read: a number in it has too many digits, or "
        "its lists and objects are nested too deeply",
        valid="JSON with numbers of at most 4300 digits, nested at most a few hundred levels deep",
        remedy="Correct it and send it again; nothing was stored.",
    )


def _fields_if_secret(route: object) -> frozenset[str]:
    """Return the field names of a route's body if one of them is secret (`writeOnly`), else none.

    If one is, error messages repeat no value, not even of other fields, and no names but these: a
    password may have been sent in any place.
    """
    field = getattr(route, "body_field", None)
    model = getattr(getattr(field, "field_info", None), "annotation", None)
    return frozenset() if model is None else _names_if_secret(model)


@lru_cache(maxsize=256)
def _names_if_secret(model: Any) -> frozenset[str]:
    schema = TypeAdapter(model).json_schema(mode="validation")
    if '"writeOnly": true' not in json.dumps(schema):
        return frozenset()
    parts = [schema, *schema.get("$defs", {}).values()]
    return frozenset(name for part in parts for name in part.get("properties", {}))


def _path(place: Sequence[object], fields: frozenset[str]) -> str:
    """Return the path of a problem in a request; next to secrets, only our own field names."""
    hidden = bool(fields) and place[:1] == ("body",)
    return ".".join(
        "(an unknown field)"
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
    """Converts values to JSON, and limits the number of characters.

    NaN and bytes become text, lone surrogates are escaped, long lists and texts are cut.
    """

    left: int = MOST_CHARACTERS

    def jsonable(self, value: Any, depth: int = 0) -> Any:
        """Return the value as JSON types, cut where it is too long or too deeply nested."""
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
            items = list(value)[:MOST_ITEMS]
            # The end of a cut list is not marked: readers expect entries of one kind.
            return [self.jsonable(one, depth + 1) for one in items if self.left > 0]
        return self._text(value if isinstance(value, str) else _written(value))

    def _text(self, text: str) -> str:
        most = max(0, min(LONGEST_TEXT, self.left))
        cut = text if len(text) <= most else f"{text[:most]}..."
        self.left -= len(cut)
        return printable(cut)


def _written(value: object) -> str:
    # Python refuses to write integers of more than 4300 digits.
    return "a very large number" if isinstance(value, int) else str(value)
