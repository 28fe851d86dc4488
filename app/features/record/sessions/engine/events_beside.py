"""Events that do not move a session on: words, the avatar's model, corrections, an erasure."""

from dataclasses import dataclass

from app.features.record.sessions.engine.event import Event


@dataclass(frozen=True, kw_only=True)
class BlindingLifted(Event):
    """The session's condition was shown to somebody on purpose, for the reason given."""

    type = "blinding_lifted"
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class NoteAdded(Event):
    """The operator wrote a note."""

    type = "note_added"
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class AvatarBuilt(Event):
    """The headset took up a physics avatar: how it behaves, by the hash of its configuration.

    The content holds the stature it was built for and the model itself.
    """

    type = "avatar_built"
    configuration_hash: str
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class CheckOverridden(Event):
    """Somebody goes on although the pre-flight's check `check` was not green.

    The content holds the reason, and what the check had found.
    """

    type = "check_overridden"
    check: str
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class FormRefused(Event):
    """Other answers came for a form that is stored: that one stands, these are kept beside."""

    type = "form_refused"
    submission_id: str
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class AnswersCorrected(Event):
    """A stored answer was corrected: the first one is kept, the newest counts."""

    type = "answers_corrected"
    submission_id: str
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class DataErased(Event):
    """The participant's data are gone; `erasure_id` is the tombstone's.

    `reason_code`: withdrawn, requested, retention or mistake.
    """

    type = "data_erased"
    erasure_id: str
    reason_code: str
