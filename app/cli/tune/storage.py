"""Load and store configurations of avatars in the lab's database, for the command `tune`."""

from dataclasses import dataclass
from functools import partial

from sqlalchemy.orm import Session

from app.cli.avatars import written
from app.clock import Clock
from app.database import Database
from app.features.movement.avatar import (
    NewAvatar,
    NewAvatarVersion,
    add_avatar_version,
    avatar_by_key,
    create_avatar,
    newest_numbers,
    newest_version,
    typed,
)
from app.features.movement.humanoids import figure_by_hash
from app.features.movement.tuning import report_json, tuning_note
from app.features.people.audit import COMMAND_LINE
from app.models import AvatarVersion
from app.protocol.avatar import file_of
from app.science.avatar.body import Figure
from app.science.avatar.configuration import Configuration, without_parts
from app.science.avatar.tuning import Followed, TuningReport

_WAIT_S = 600.0
"""How long to wait for the database: a tuning took minutes, and is lost if it cannot be stored."""


def stored_avatar(database: Database, key: str) -> tuple[Configuration, Figure | None, int]:
    """Return the newest version of an avatar without parts that its model lacks.

    With it are returned the model and the version's number. Raises NotFound with the existing keys.
    """
    with database.reading() as db:
        row = newest_version(db, avatar_by_key(db, key))
        configuration = typed(row)
        figure = figure_by_hash(db, configuration.humanoid)
    if figure is not None:
        configuration = without_parts(configuration, frozenset(figure.absent))
    return configuration, figure, row.number


@dataclass(frozen=True)
class SavedTuning:
    """The version of an avatar in which a tuning was stored."""

    key: str
    number: int

    @property
    def name(self) -> str:
        """Return `key, version n`."""
        return f"{self.key}, version {self.number}"


def save_tuned(
    database: Database, key: str, report: TuningReport, tracking: Followed | None
) -> SavedTuning:
    """Store the report under a new key, or as the next version."""
    work = partial(_appended, key=key, report=report, tracking=tracking)
    row = written(database, work, wait_s=_WAIT_S)
    return SavedTuning(row.key, row.number)


def _appended(
    db: Session, key: str, report: TuningReport, tracking: Followed | None
) -> AvatarVersion:
    now, stored = Clock().utc_now(), report_json(report, tracking)
    content = file_of(report.configuration)
    note = tuning_note(report.options, report.stature_m)
    newest = newest_numbers(db).get(key)
    if newest is None:
        new = NewAvatar(key=key, title=key, origin="tuned", note=note, configuration=content)
        return create_avatar(db, COMMAND_LINE, new, now, report=stored)
    more = NewAvatarVersion(based_on=newest, origin="tuned", note=note, configuration=content)
    return add_avatar_version(db, COMMAND_LINE, key, more, now, report=stored)
