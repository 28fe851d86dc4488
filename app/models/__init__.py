"""The tables, one family a file. Importing this package registers them all."""

from app.models.accounts import Account, LoginToken
from app.models.devices import Device, PairingCode
from app.models.ledger import Ledger, LedgerSlot, Participant, SlotAttempt
from app.models.quality import AlarmRow, PhaseLatency, PhaseQuality
from app.models.questionnaires import Answer, ScoreValue, Submission
from app.models.sessions import Phase, SessionContent, SessionEvent, StudySession
from app.models.studies import InstrumentVersion, Study, StudyVersion
from app.models.telemetry import (
    ClientReport,
    ClockProbe,
    Completion,
    Contact,
    JointErrorRow,
    TelemetryBatch,
    TelemetryChunk,
    TelemetryStream,
)

__all__ = [
    "Account",
    "AlarmRow",
    "Answer",
    "ClientReport",
    "ClockProbe",
    "Completion",
    "Contact",
    "Device",
    "InstrumentVersion",
    "JointErrorRow",
    "Ledger",
    "LedgerSlot",
    "LoginToken",
    "PairingCode",
    "Participant",
    "Phase",
    "PhaseLatency",
    "PhaseQuality",
    "ScoreValue",
    "SessionContent",
    "SessionEvent",
    "SlotAttempt",
    "Study",
    "StudySession",
    "StudyVersion",
    "Submission",
    "TelemetryBatch",
    "TelemetryChunk",
    "TelemetryStream",
]
