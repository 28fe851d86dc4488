"""A client of the public interfaces: HTTP, and the WebSocket with its journal."""

from app.client.file_journal import FileJournal
from app.client.http import (
    Json,
    Operator,
    ServerRefusedError,
    Tablet,
    UnreachableError,
    call,
    call_with_retry,
    submit_form,
)
from app.client.journal import Journal
from app.client.road import RoadClient
from app.client.telemetry import TelemetryClient, TelemetryError

__all__ = [
    "FileJournal",
    "Journal",
    "Json",
    "Operator",
    "RoadClient",
    "ServerRefusedError",
    "Tablet",
    "TelemetryClient",
    "TelemetryError",
    "UnreachableError",
    "call",
    "call_with_retry",
    "submit_form",
]
