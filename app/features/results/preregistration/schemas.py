"""Models of a preregistration's queries, and of the answers: its result and the deviations."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel, ConfigDict

from app.features.results.analysis import DashboardKind
from app.protocol import Preregistration, PrimaryNames

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


class PreregistrationQuery(BaseModel):
    """The query of a preregistration: the kind of sessions."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    kind: DashboardKind = "people"


class ReportQuery(PreregistrationQuery):
    """The query of its report, which has one of two forms."""

    form: Literal["markdown", "json"] = "markdown"


class DeclarationView(BaseModel):
    """The declaration, with the first version that made it; `content_hash` identifies the version.

    `section` is the declaration in the study file. `frozen_at`: when the first session of a version
    with this declaration started. `names`: for the keys in its primary test.
    """

    version: int
    content_hash: str
    created_at: datetime
    frozen_at: datetime | None
    registration: str
    alpha: float
    planned_n: int
    section: Preregistration
    names: PrimaryNames
    primary_words: str
    rules: list[str]


class ExclusionView(BaseModel):
    """A session that the primary test leaves out, with the rule and what was found."""

    participant_code: str
    rule: str
    reason: str


class PrimaryResult(BaseModel):
    """The result of the primary test.

    `sentence` is for a paper. `holds`: p is at most alpha. `rows`: single comparisons or the
    effect, under `columns`.
    """

    n: int
    sentence: str
    holds: bool
    columns: list[str]
    rows: list[list[str]]
    method: str


class DeviationView(BaseModel):
    """A deviation of what was done from what was declared, or a note (`is_note`)."""

    code: DeviationCode
    is_note: bool
    text: str


class PreregistrationView(BaseModel):
    """The declaration of a study and the deviations from it, with a result or `why_no_result`."""

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
