"""Suggestions: written about a step of a study version, decided once, otherwise never changed."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.database import referenced_row
from app.errors import Conflict, InvalidInput, NotFound
from app.features.design.studies import newest_version, protocol_of, study_by_key
from app.models import Participant, Study, StudySession, StudyVersion, Suggestion, new_id
from app.platform.access import session_by_id
from app.protocol import Step, compile_plan, sequences

Status = Literal["open", "adopted", "declined"]


class NewSuggestion(BaseModel):
    """A suggestion about a version of a study.

    `about` is a step's key, or empty for the whole study. With a `session_id`, the version is that
    of the session, so `version` may be left out.
    """

    model_config = ConfigDict(extra="forbid")

    version: int | None = Field(default=None, ge=1, lt=2**31)
    session_id: str | None = Field(default=None, max_length=36)
    about: str = Field(default="", max_length=80)
    body: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=4000)]


class Decision(BaseModel):
    """The decision on a suggestion; `adopted_in` is the number of the version that contains it."""

    model_config = ConfigDict(extra="forbid")

    status: Literal["adopted", "declined"]
    adopted_in: int | None = Field(default=None, ge=1, lt=2**31)


class SuggestionView(BaseModel):
    """A suggestion with the decision on it. `about_title`: the step's title in the study."""

    id: str
    version: int
    session_id: str | None
    participant_code: str | None
    about: str
    about_title: str | None
    body: str
    status: Status
    adopted_in: int | None
    by: str
    at: datetime
    decided_by: str | None
    decided_at: datetime | None


def add_suggestion(
    db: Session, key: str, wish: NewSuggestion, *, by: str, now: datetime
) -> SuggestionView:
    """Store a suggestion about a version of a study.

    Raises NotFound for an unknown study or session, or a session of another study, and InvalidInput
    for an unknown version or step.
    """
    study = study_by_key(db, key)
    version = _version(db, study, wish)
    titles = _titles(version)
    if wish.about and wish.about not in titles:
        raise InvalidInput(
            f"version {version.number} has no step {wish.about!r}",
            value=wish.about,
            valid=sorted(titles),
            remedy="Name a step by its key, or leave it empty for the whole study.",
        )
    row = Suggestion(
        id=new_id(),
        study_version_id=version.id,
        session_id=wish.session_id,
        about=wish.about,
        body=wish.body,
        status="open",
        by=by,
        at=now,
    )
    db.add(row)
    db.flush()
    return _view(db, row)


def suggestions_of(db: Session, key: str) -> list[SuggestionView]:
    """Return all suggestions for a study: newest version first, then in the order written."""
    study = study_by_key(db, key)
    rows = db.scalars(
        select(Suggestion)
        .join(StudyVersion, StudyVersion.id == Suggestion.study_version_id)
        .where(StudyVersion.study_id == study.id)
        .order_by(StudyVersion.number.desc(), Suggestion.at, Suggestion.id)
    )
    return [_view(db, row) for row in rows]


def decide_suggestion(
    db: Session, suggestion_id: str, decision: Decision, *, by: str, now: datetime
) -> SuggestionView:
    """Adopt or decline a suggestion.

    Raises NotFound, InvalidInput, or Conflict if it was already decided.
    """
    row = db.get(Suggestion, suggestion_id, with_for_update=True)
    if row is None:
        raise NotFound("there is no such suggestion", value=suggestion_id)
    if row.status != "open":
        raise Conflict(
            f"the suggestion was already {row.status}",
            value=row.status,
            remedy="Write a new suggestion if it should be reconsidered.",
        )
    row.status, row.decided_by, row.decided_at = decision.status, by, now
    row.adopted_in = _adopted_in(db, row, decision)
    db.flush()
    return _view(db, row)


def _adopted_in(db: Session, row: Suggestion, decision: Decision) -> int | None:
    """Return the adopting version, which must be later than the one the suggestion is about."""
    if decision.adopted_in is None:
        return None
    about = referenced_row(db, StudyVersion, row.study_version_id)
    numbers = _numbers(db, about.study_id)
    later = [number for number in numbers if number > about.number]
    if decision.status == "declined" or decision.adopted_in not in later:
        raise InvalidInput(
            f"version {decision.adopted_in} cannot have adopted it",
            value=decision.adopted_in,
            valid=later if decision.status == "adopted" else None,
            remedy=f"Name a version after {about.number}, or none if it does not exist yet.",
        )
    return decision.adopted_in


def _version(db: Session, study: Study, wish: NewSuggestion) -> StudyVersion:
    if wish.session_id is not None:
        session = session_by_id(db, wish.session_id)
        if session.study_id != study.id:
            raise NotFound("there is no such session", value=wish.session_id)
        version = referenced_row(db, StudyVersion, session.study_version_id)
    elif wish.version is None:
        version = newest_version(db, study)
    else:
        found = db.scalar(
            select(StudyVersion).where(
                StudyVersion.study_id == study.id, StudyVersion.number == wish.version
            )
        )
        if found is None:
            raise _no_version(db, study, wish.version)
        version = found
    if wish.version not in (None, version.number):
        raise InvalidInput(
            f"the session follows version {version.number}",
            value=wish.version,
            valid=version.number,
            remedy="Leave version out when a session is given.",
        )
    return version


def _no_version(db: Session, study: Study, number: int) -> InvalidInput:
    return InvalidInput(
        f"the study has no version {number}", value=number, valid=_numbers(db, study.id)
    )


def _numbers(db: Session, study_id: str) -> list[int]:
    query = select(StudyVersion.number).where(StudyVersion.study_id == study_id)
    return list(db.scalars(query.order_by(StudyVersion.number)))


def _steps(version: StudyVersion) -> tuple[Step, ...]:
    protocol = protocol_of(version)
    return compile_plan(protocol, sequences(protocol)[0])


def _titles(version: StudyVersion) -> dict[str, str]:
    """Return the titles of a version's steps by key; every order has the same keys."""
    return {
        step.key: step.title.get("en") or next(iter(step.title.values()))
        for step in _steps(version)
    }


def _view(db: Session, row: Suggestion) -> SuggestionView:
    version = referenced_row(db, StudyVersion, row.study_version_id)
    code = None
    if row.session_id is not None:
        session = db.get_one(StudySession, row.session_id)
        code = db.get_one(Participant, session.participant_id).code
    return SuggestionView(
        id=row.id,
        version=version.number,
        session_id=row.session_id,
        participant_code=code,
        about=row.about,
        about_title=_titles(version).get(row.about),
        body=row.body,
        status=row.status,
        adopted_in=row.adopted_in,
        by=row.by,
        at=row.at,
        decided_by=row.decided_by,
        decided_at=row.decided_at,
    )
