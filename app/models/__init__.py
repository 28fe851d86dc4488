"""The database tables, one family per file. Importing this package registers them all."""

from app.models.accounts import (
    PURPOSES,
    ROLES,
    SERVERS_OWN,
    Account,
    AuditEntry,
    AuditHead,
    Invitation,
    LoginToken,
    StudyMember,
)
from app.models.avatars import Avatar, AvatarTuningRow, AvatarVersion, HumanoidRow
from app.models.captures import CaptureContent, CapturePiece, CaptureRow, SavedJointMap
from app.models.devices import (
    Calibration,
    Device,
    HeadsetTest,
    HeadsetTestBatch,
    LiveDoor,
    LiveLimb,
    PairingCode,
)
from app.models.imports import AnswerImport, ImportedForm
from app.models.ledger import KINDS, Ledger, LedgerSlot, Participant, SlotAttempt
from app.models.quality import AlarmRow, PhaseLatency, PhaseQuality
from app.models.questionnaires import Answer, ScoreValue, Submission
from app.models.rights import AnswerCorrection, CopyMade, Erasure
from app.models.road import RoadChunk, RoadCrossing, RoadRun
from app.models.sessions import Phase, SessionContent, SessionEvent, StudySession
from app.models.studies import InstrumentVersion, PilotRow, Study, StudyVersion, Suggestion
from app.models.telemetry import (
    ClientReport,
    ClockProbe,
    Completion,
    Contact,
    JointErrorCourseRow,
    JointErrorRow,
    TelemetryBatch,
    TelemetryChunk,
    TelemetryStream,
    TrackerAlignment,
    TrackerChunk,
)
from app.models.types import UtcDateTime, new_id
from app.models.walking import WalkingModelRow, WalkingScene, WalkSetRow

__all__ = [
    "KINDS",
    "PURPOSES",
    "ROLES",
    "SERVERS_OWN",
    "Account",
    "AlarmRow",
    "Answer",
    "AnswerCorrection",
    "AnswerImport",
    "AuditEntry",
    "AuditHead",
    "Avatar",
    "AvatarTuningRow",
    "AvatarVersion",
    "Calibration",
    "CaptureContent",
    "CapturePiece",
    "CaptureRow",
    "ClientReport",
    "ClockProbe",
    "Completion",
    "Contact",
    "CopyMade",
    "Device",
    "Erasure",
    "HeadsetTest",
    "HeadsetTestBatch",
    "HumanoidRow",
    "ImportedForm",
    "InstrumentVersion",
    "Invitation",
    "JointErrorCourseRow",
    "JointErrorRow",
    "Ledger",
    "LedgerSlot",
    "LiveDoor",
    "LiveLimb",
    "LoginToken",
    "PairingCode",
    "Participant",
    "Phase",
    "PhaseLatency",
    "PhaseQuality",
    "PilotRow",
    "RoadChunk",
    "RoadCrossing",
    "RoadRun",
    "SavedJointMap",
    "ScoreValue",
    "SessionContent",
    "SessionEvent",
    "SlotAttempt",
    "Study",
    "StudyMember",
    "StudySession",
    "StudyVersion",
    "Submission",
    "Suggestion",
    "TelemetryBatch",
    "TelemetryChunk",
    "TelemetryStream",
    "TrackerAlignment",
    "TrackerChunk",
    "UtcDateTime",
    "WalkSetRow",
    "WalkingModelRow",
    "WalkingScene",
    "new_id",
]
