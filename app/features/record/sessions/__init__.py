"""Running a session: its event log, its state, its commands."""

from app.features.record.sessions.capture import (
    closed_sessions,
    erased_session,
    not_erased,
    refusal,
    require_capture,
    require_capture_of,
)
from app.features.record.sessions.consent import ConsentDesk, consent_form, consent_record
from app.features.record.sessions.consent_schemas import (
    ConsentForm,
    ConsentGiven,
    ConsentRecord,
    PaperConsent,
)
from app.features.record.sessions.contents import content_body, contents_of, store_content
from app.features.record.sessions.engine import (
    Command,
    ContentRef,
    SessionState,
    allowed_commands,
    commands,
)
from app.features.record.sessions.engine.commands import (
    CompleteStep,
    CorrectAnswers,
    EraseData,
    HeadsetLost,
    KeepRefusedForm,
    LiftBlinding,
    Materialise,
    OverrideCheck,
    RecordAvatar,
    Report,
    SubmitForm,
)
from app.features.record.sessions.journal import ChainCheck, canonical, events_of, verify_chain
from app.features.record.sessions.service import (
    apply_command,
    is_repeated,
    join,
    plan_of,
    protocol_of_session,
    state_of,
)

__all__ = [
    "ChainCheck",
    "Command",
    "CompleteStep",
    "ConsentDesk",
    "ConsentForm",
    "ConsentGiven",
    "ConsentRecord",
    "ContentRef",
    "CorrectAnswers",
    "EraseData",
    "HeadsetLost",
    "KeepRefusedForm",
    "LiftBlinding",
    "Materialise",
    "OverrideCheck",
    "PaperConsent",
    "RecordAvatar",
    "Report",
    "SessionState",
    "SubmitForm",
    "allowed_commands",
    "apply_command",
    "canonical",
    "closed_sessions",
    "commands",
    "consent_form",
    "consent_record",
    "content_body",
    "contents_of",
    "erased_session",
    "events_of",
    "is_repeated",
    "join",
    "not_erased",
    "plan_of",
    "protocol_of_session",
    "refusal",
    "require_capture",
    "require_capture_of",
    "state_of",
    "store_content",
    "verify_chain",
]
