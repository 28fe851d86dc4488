"""Consent: check what was given against what the study requires, store it, and show it later.

The record is stored as content next to the event log: it contains a name or a signature, so it must
be erasable, and it is never exported. Statements are identified by their index in the study
version, whose content hash is part of the record, so what was agreed to cannot be changed.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from sqlalchemy.orm import Session

from app.database import referenced_row
from app.errors import InvalidInput
from app.features.design.studies import protocol_of
from app.features.record.sessions.consent.schemas import (
    ConsentForm,
    ConsentGiven,
    ConsentRecord,
    PaperConsent,
    StatementForm,
    StatementRecord,
)
from app.features.record.sessions.contents import content_body, contents_of, store_content
from app.features.record.sessions.engine import ContentRef
from app.features.record.sessions.service import plan_of
from app.models import Participant, SessionContent, StudySession, StudyVersion
from app.platform.context import AppContext
from app.protocol import ConsentStep, Step, StudyProtocol, Text, sha256_of

CONTENT = "consent"


def consent_form(step: Step, language: str) -> ConsentForm | None:
    """Return the requirements of a consent besides its text; None if the step is not a consent."""
    if step.consent is None:
        return None
    return ConsentForm(
        signature=step.consent.signature,
        statements=[
            StatementForm(text=_in(one.text, language), optional=one.optional)
            for one in step.consent.statements
        ],
    )


@dataclass(frozen=True)
class ConsentDesk:
    """Stores the consents of one session in the caller's transaction, on behalf of `actor`."""

    db: Session
    context: AppContext
    session: StudySession
    actor: str

    def from_tablet(self, step: Step, given: ConsentGiven) -> ContentRef:
        """Store the participant's consent; raises InvalidInput if something required is missing."""
        required = _requirements(step)
        _check_ticks(required, given.ticked)
        if required.signature == "typed" and given.name is None:
            raise _missing("name", "the participant's name", "Ask the participant to type it.")
        if required.signature == "drawn" and given.signature is None and given.name is None:
            raise _missing(
                "signature",
                "a drawn signature, or a typed name instead",
                "Ask the participant to sign, or to type their name.",
            )
        signed = required.signature != "none"
        return self._store(
            step,
            mode="tablet",
            ticked=sorted(set(given.ticked)),
            name=given.name if signed else None,
            signature=given.signature if required.signature == "drawn" else None,
        )

    def from_operator(self, step: Step, paper: PaperConsent | None) -> ContentRef:
        """Store a consent on paper, the only kind that an operator can enter."""
        _requirements(step)
        if paper is None:
            raise InvalidInput(
                "only the participant can give consent",
                value=None,
                valid="the form on the tablet, or paper_consent with place and reason",
                remedy="Let the participant agree on the tablet, or have them sign on paper and "
                "record where the sheet is.",
            )
        return self._store(step, mode="paper", ticked=None, paper=paper.model_dump())

    def _store(self, step: Step, *, mode: str, ticked: list[int] | None, **more: Any) -> ContentRef:
        version = referenced_row(self.db, StudyVersion, self.session.study_version_id)
        now = self.context.clock.utc_now()
        body = {
            "study_key": protocol_of(version).key,
            "study_version": version.number,
            "content_hash": version.content_hash,
            "step_index": step.index,
            "text_hash": sha256_of(
                _consent_text(protocol_of(version), step, self.session.language)
            ),
            "language": self.session.language,
            "mode": mode,
            "ticked": ticked,
            "name": None,
            "signature": None,
            "paper": None,
            "device": self.actor,
            "at_utc": now.isoformat(),
            **more,
        }
        return store_content(
            self.db, session_id=self.session.id, kind=CONTENT, body=body, by=self.actor, now=now
        )


def consent_record(db: Session, session: StudySession) -> ConsentRecord | None:
    """Return the latest consent of a session, or None if none was given."""
    rows = contents_of(db, session.id, CONTENT)
    return _record(db, session, rows) if rows else None


def _record(db: Session, session: StudySession, rows: Sequence[SessionContent]) -> ConsentRecord:
    row = rows[-1]
    stored = content_body(row)
    body: dict[str, Any] = stored if isinstance(stored, dict) else {}
    version = referenced_row(db, StudyVersion, session.study_version_id)
    protocol, plan = protocol_of(version), plan_of(db, session)
    language = str(body.get("language", session.language))
    consents = [step for step in plan if step.consent is not None]
    step = next((one for one in consents if one.index == body.get("step_index")), consents[0])
    text, required = _consent_text(protocol, step, language), _requirements(step)
    ticked = body.get("ticked")
    return ConsentRecord(
        session_id=session.id,
        participant_code=db.get_one(Participant, session.participant_id).code,
        simulated=session.kind == "simulated",
        study_key=protocol.key,
        study_title=_in(protocol.title, language),
        study_version=version.number,
        content_hash=version.content_hash,
        language=language,
        title=_in(step.title, language),
        text=text,
        text_hash=str(body.get("text_hash", "")),
        text_matches=body.get("text_hash") == sha256_of(text),
        statements=[
            StatementRecord(
                text=_in(one.text, language),
                optional=one.optional,
                ticked=None if ticked is None else at in ticked,
            )
            for at, one in enumerate(required.statements)
        ],
        signature_wanted=required.signature,
        name=body.get("name"),
        signature=body.get("signature"),
        mode=body.get("mode", "operator"),
        paper=body.get("paper"),
        at=row.created_at,
        by=row.created_by,
        erased=row.body is None,
        records=len(rows),
    )


def _requirements(step: Step) -> ConsentStep:
    if step.consent is None:
        raise InvalidInput(
            "this step is not a consent",
            value=step.key,
            valid="a step of kind consent",
            remedy="Check the current step.",
        )
    return step.consent


def _check_ticks(required: ConsentStep, ticked: Sequence[int]) -> None:
    unknown = [at for at in ticked if at >= len(required.statements)]
    missing = [
        at for at, one in enumerate(required.statements) if not one.optional and at not in ticked
    ]
    if unknown or missing:
        raise InvalidInput(
            "a required statement is not ticked" if missing else "there is no such statement",
            value=sorted(ticked),
            valid=[at for at, one in enumerate(required.statements) if not one.optional],
            remedy="Every statement that is not optional must be ticked to continue.",
        )


def _missing(field: str, valid: str, remedy: str) -> InvalidInput:
    return InvalidInput(f"the {field} is missing", value=None, valid=valid, remedy=remedy)


def _consent_text(protocol: StudyProtocol, step: Step, language: str) -> str:
    return "" if step.text is None else _in(protocol.texts[step.text], language)


def _in(text: Text, language: str) -> str:
    return text.get(language) or next(iter(text.values()), "")
