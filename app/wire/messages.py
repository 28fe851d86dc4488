"""The JSON messages beside the binary batches, typed for both ends.

A headset sends `hello` first and may then send `report`, `produced`, `probe` and `probed` messages
and binary batches. The server answers with `welcome`, and sends `state` on every change of the
session, `ack` after each commit, `resend` where it expected an earlier seq, `flag` for bad samples,
`refused` for a report that did not fit, and `error` before it closes.
"""

from app.wire.basis import (
    MAX_SEQ,
    PROTOCOL_VERSION,
    REPORT_STREAM,
    SUBPROTOCOL,
    Message,
)
from app.wire.from_client import (
    CLIENT_MESSAGE,
    ClientMessage,
    ClientMessages,
    CompletionReport,
    ContactReport,
    Hello,
    MaterialisedReport,
    PhaseReport,
    Probe,
    Probed,
    Produced,
    Report,
    ReportBody,
)
from app.wire.from_server import (
    SERVER_MESSAGE,
    Ack,
    Failure,
    Flag,
    HeadsetState,
    ParticipantInfo,
    PhaseOrder,
    ProbeAnswer,
    RefusedReport,
    Resend,
    ServerMessage,
    StreamPosition,
    Welcome,
)

__all__ = [
    "CLIENT_MESSAGE",
    "MAX_SEQ",
    "PROTOCOL_VERSION",
    "REPORT_STREAM",
    "SERVER_MESSAGE",
    "SUBPROTOCOL",
    "Ack",
    "ClientMessage",
    "ClientMessages",
    "CompletionReport",
    "ContactReport",
    "Failure",
    "Flag",
    "HeadsetState",
    "Hello",
    "MaterialisedReport",
    "Message",
    "ParticipantInfo",
    "PhaseOrder",
    "PhaseReport",
    "Probe",
    "ProbeAnswer",
    "Probed",
    "Produced",
    "RefusedReport",
    "Report",
    "ReportBody",
    "Resend",
    "ServerMessage",
    "StreamPosition",
    "Welcome",
]
