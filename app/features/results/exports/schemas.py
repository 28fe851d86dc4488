"""Request and response models of exports that are made as a file."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, StringConstraints

from app.features.results.analysis import Kind

ExportState = Literal["queued", "making", "ready", "failed"]


class ExportWish(BaseModel):
    """The data to export: a study's sessions of one kind, or only one session of that kind.

    `movement`: also the frames of every session, which are nearly all of the size.
    """

    model_config = ConfigDict(extra="forbid")

    kind: Kind
    session_id: Annotated[str, StringConstraints(min_length=1, max_length=32)] | None = None
    movement: bool = True


class ExportTrouble(BaseModel):
    """The reason why an export failed, and what to do about it."""

    message: str
    remedy: str


class ExportView(BaseModel):
    """An export and its progress.

    `rows` of `rows_total` rows of movement are written; the other tables are small in comparison.
    `bytes` are on the disk; `bytes_expected` is estimated from the bytes per row so far,
    `remaining_s` from the time, both None until there are enough rows. `sha256` is that of the
    file. `expires_at`: when the server removes it.
    """

    id: str
    study_key: str
    kind: Kind
    session_id: str | None
    movement: bool
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
