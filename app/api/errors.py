"""One handler: every refusal reaches every client in the same shape."""

import logging
from collections.abc import Mapping, Sequence
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from sqlalchemy.exc import DatabaseError, DataError, IntegrityError, OperationalError
from starlette.exceptions import HTTPException

from app.errors import (
    Conflict,
    InvalidInput,
    NotAllowed,
    NotDurable,
    NotFound,
    ReembodyError,
)
from app.platform.trouble import BUSY, explain

log = logging.getLogger(__name__)


def error_response(error: ReembodyError) -> JSONResponse:
    """The JSON of an error with its status."""
    return JSONResponse({"error": _jsonable(error.as_json())}, status_code=error.status)


def install_error_handler(app: FastAPI) -> None:
    """Translate every error of ours, and the framework's, into one shape."""

    @app.exception_handler(ReembodyError)
    def ours(_: Request, error: ReembodyError) -> JSONResponse:
        return error_response(error)

    @app.exception_handler(RequestValidationError)
    def validation(_: Request, error: RequestValidationError) -> JSONResponse:
        details = [
            {
                "path": ".".join(str(part) for part in problem["loc"][1:]),
                "message": problem["msg"],
                "value": problem.get("input"),
            }
            for problem in error.errors()
        ]
        return error_response(
            InvalidInput(
                "the request does not fit",
                remedy="Mend the fields named below; nothing was stored.",
                details=details,
            )
        )

    _install_database_handlers(app)

    @app.exception_handler(HTTPException)
    def framework(_: Request, error: HTTPException) -> JSONResponse:
        # The framework wraps what goes wrong while a body is read, such as our limit on its size.
        if isinstance(error.__cause__, ReembodyError):
            return error_response(error.__cause__)
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
    """What the database refuses, in our words: its own would tell of the inside."""

    @app.exception_handler(OperationalError)
    def not_now(_: Request, error: OperationalError) -> JSONResponse:
        _log_refusal(error)
        return _not_durable(error)

    @app.exception_handler(DatabaseError)
    def never(_: Request, error: DatabaseError) -> JSONResponse:
        _log_refusal(error)
        return _went_wrong() if explain(error) is None else _not_durable(error)

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


def _log_refusal(error: DatabaseError) -> None:
    trouble = explain(error)
    if trouble is None:
        log.error("the database refused", exc_info=error)
    else:
        # Where it came from was logged when it began; a full disk must not be filled by telling.
        log.error("a request was refused: %s (%s)", trouble.message, error.orig)


def _not_durable(error: DatabaseError) -> JSONResponse:
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


def _jsonable(value: Any) -> Any:
    """Values as JSON can carry them: NaN and bytes become text."""
    if isinstance(value, Mapping):
        return {str(key): _jsonable(one) for key, one in value.items()}
    if isinstance(value, str | int | bool) or value is None:
        return value
    if isinstance(value, float):
        return value if value == value and abs(value) != float("inf") else str(value)
    if isinstance(value, Sequence) and not isinstance(value, bytes | bytearray):
        return [_jsonable(one) for one in value]
    return str(value)[:500]
