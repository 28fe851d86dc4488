"""Every route of the application, in one place."""

import asyncio
from datetime import datetime
from typing import Literal

from fastapi import APIRouter, WebSocket
from pydantic import BaseModel
from sqlalchemy import text

from app import __version__
from app.features.accounts.endpoints import router as accounts
from app.features.accounts.people_endpoints import router as people
from app.features.alarms.endpoints import router as alarms
from app.features.analysis.endpoints import router as analysis
from app.features.audit.endpoints import router as audit
from app.features.context import AppContext
from app.features.dependencies import API_PREFIX, Context
from app.features.devices.endpoints import router as devices
from app.features.exports.endpoints import router as exports
from app.features.headset.socket import serve_headset
from app.features.instruments.endpoints import router as instruments
from app.features.network.endpoints import router as network
from app.features.participants.endpoints import router as participants
from app.features.receipts.endpoints import router as receipts
from app.features.sessions.endpoints import router as sessions
from app.features.sessions.watching import router as watching
from app.features.studies.endpoints import router as studies
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


def build_router() -> APIRouter:
    """The routes under /api."""
    router = APIRouter(prefix=API_PREFIX)
    parts = (
        *(accounts, people, audit, studies, instruments, participants, sessions, watching),
        *(devices, tablet, alarms),
        *(analysis, exports, receipts, network),
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
