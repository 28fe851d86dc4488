"""Exports that are made as a file, as they travel to a page."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, StringConstraints

from app.features.results.analysis import Kind

ExportState = Literal["queued", "making", "ready", "failed"]


class ExportWish(BaseModel):
    """What to export: a study's sessions of one kind, or one session of that kind alone."""

    model_config = ConfigDict(extra="forbid")

    kind: Kind
    session_id: Annotated[str, StringConstraints(min_length=1, max_length=32)] | None = None


class ExportTrouble(BaseModel):
    """Why a file could not be made, and what to do about it."""

    message: str
    remedy: str


class ExportView(BaseModel):
    """An export and how far it is.

    `rows` of movement are written of `rows_total`; other tables are small beside them. `bytes` are
    on the disk; `bytes_expected` is told from the bytes a row has taken so far, `remaining_s` from
    the time, both None while too little is known. `sha256` is of the file. `expires_at`: when the
    server removes it.
    """

    id: str
    study_key: str
    kind: Kind
    session_id: str | None
    file_name: str
    state: ExportState
    asked_at: datetime
    rows: int
    rows_total: int
    sessions: int
    sessions_total: int
    bytes: int
    bytes_expected: int | None
    bytes_per_s: float | None
    elapsed_s: float
    remaining_s: float | None
    sha256: str | None
    fetched_at: datetime | None
    expires_at: datetime | None
    trouble: ExportTrouble | None
