"""Every route of the application, in one place."""

import asyncio
from datetime import datetime
from typing import Any, Literal

from fastapi import APIRouter, WebSocket
from pydantic import BaseModel
from sqlalchemy import text

from app import __version__
from app.features.accounts.endpoints import router as accounts
from app.features.accounts.people_endpoints import router as people
from app.features.alarms.endpoints import router as alarms
from app.features.analysis.endpoints import router as analysis
from app.features.audit.endpoints import router as audit
from app.features.calibrations.endpoints import router as calibrations
from app.features.context import AppContext
from app.features.dependencies import API_PREFIX, Context
from app.features.devices.endpoints import router as devices
from app.features.exports.endpoints import router as exports
from app.features.headset.socket import serve_headset
from app.features.instruments.endpoints import router as instruments
from app.features.network.endpoints import router as network
from app.features.participants.endpoints import router as participants
from app.features.receipts.endpoints import router as receipts
from app.features.rights.endpoints import router as rights
from app.features.sessions.consent_endpoints import router as consents
from app.features.sessions.endpoints import router as sessions
from app.features.sessions.watching import router as watching
from app.features.studies.endpoints import router as studies
from app.features.suggestions.endpoints import router as suggestions
from app.features.tablet.endpoints import router as tablet
from app.features.telemetry.writer import TelemetryWriter


class Health(BaseModel):
    """Whether the server and its database answer, and whether the record can be written.

    `low_disk`: little space is left in the data folder.
    """

    status: str
    version: str
    database: str
    storage: Literal["ok", "failing"]
    storage_since: datetime | None
    storage_reason: str | None
    low_disk: bool


class Refusal(BaseModel):
    """Why something was refused (app.errors): what happened, the value, what is valid, the way on.

    `details` lists single problems of a file or form, each with its place.
    """

    code: str
    message: str
    value: Any
    valid: Any
    remedy: str
    details: list[dict[str, Any]]


class ErrorBody(BaseModel):
    """The body of every answer that is not a success."""

    error: Refusal


REFUSALS: dict[int | str, dict[str, Any]] = {
    "4XX": {"model": ErrorBody, "description": "Refused, with the reason and the way out."},
    "503": {"model": ErrorBody, "description": "Cannot be stored now, so nothing was promised."},
}


def build_router() -> APIRouter:
    """The routes under /api."""
    router = APIRouter(prefix=API_PREFIX, responses=REFUSALS)
    parts = (
        *(accounts, people, audit, studies, instruments, participants, sessions, watching),
        *(devices, tablet, alarms, consents, suggestions, calibrations),
        *(analysis, exports, receipts, rights, network),
    )
    for part in parts:
        router.include_router(part)
    router.add_api_route("/health", get_health, methods=["GET"], tags=["health"])
    router.add_api_websocket_route("/vr/stream", vr_stream)
    return router


def get_health(context: Context) -> Health:
    """Whether the server and its database answer."""
    with context.database.reading() as db:
        db.execute(text("SELECT 1"))
    storage = context.storage.state()
    return Health(
        status="ok",
        version=__version__,
        database=context.database.engine.dialect.name,
        storage=storage.status,
        storage_since=storage.since,
        storage_reason=storage.reason,
        low_disk=storage.low_disk,
    )


async def vr_stream(socket: WebSocket) -> None:
    """The headset's socket; see docs/protocol.md."""
    context: AppContext = socket.app.state.context
    writer: TelemetryWriter = socket.app.state.writer
    try:
        await serve_headset(socket, context, writer)
    except asyncio.CancelledError:
        return
