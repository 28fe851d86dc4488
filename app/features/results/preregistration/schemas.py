"""A preregistration beside what came of it, as it travels."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

from app.protocol import Preregistration

DeviationCode = Literal[
    "declared_late",
    "changed_since_start",
    "declaration_changed",
    "n_short",
    "n_over",
    "left_out_by_hand",
    "not_judged",
    "missing_values",
    "corrected",
    "still_open",
    "not_registered",
    "exploratory",
]


class DeclarationView(BaseModel):
    """What is declared, by the first version that said just this; `content_hash` names it.

    `section` is the study file's own. `frozen_at`: when the first session of that version started.
    """

    version: int
    content_hash: str
    created_at: datetime
    frozen_at: datetime | None
    registration: str
    alpha: float
    planned_n: int
    section: Preregistration
    primary_words: str
    rules: list[str]


class ExclusionView(BaseModel):
    """A session that the primary test leaves out: by which rule, and what was found."""

    participant_code: str
    rule: str
    reason: str


class PrimaryResult(BaseModel):
    """The declared test, made. `sentence` is for a paper; `holds`: p is at most alpha.

    `rows`: single comparisons or the effect, under `columns`.
    """

    n: int
    sentence: str
    holds: bool
    columns: list[str]
    rows: list[list[str]]
    method: str


class DeviationView(BaseModel):
    """A difference between what was declared and what was done; notes are none, but told too."""

    code: DeviationCode
    is_note: bool
    text: str


class PreregistrationView(BaseModel):
    """Declared, done, and how the two differ. `why_no_result`: instead of a result."""

    study_key: str
    kind: str
    simulated: bool
    as_of: datetime
    declaration: DeclarationView | None
    sessions: int
    excluded: list[ExclusionView]
    included: int
    result: PrimaryResult | None
    why_no_result: str | None
    deviations: list[DeviationView]
