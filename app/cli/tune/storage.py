"""Load and store configurations of avatars in the lab's database, for the command `tune`."""

from collections.abc import Iterator
from contextlib import contextmanager

from pydantic import TypeAdapter, ValidationError
from sqlalchemy.orm import Session

from app.cli.installation import opened_database, owned_database
from app.cli.tune.output_json import report_json
from app.clock import Clock
from app.database import Database
from app.features.movement.avatar import (
    SHIPPED,
    AvatarKey,
    NewAvatar,
    NewAvatarVersion,
    add_avatar_version,
    add_shipped_avatar,
    avatar_by_key,
    create_avatar,
    newest_numbers,
    newest_version,
    typed,
)
from app.features.movement.humanoids import add_shipped_bodies, figure_by_hash
from app.features.people.audit import COMMAND_LINE
from app.models import AvatarVersion
from app.protocol.avatar import file_of
from app.science.avatar.body import Figure
from app.science.avatar.configuration import Configuration, without_parts
from app.science.avatar.tuning import Followed, TuningReport

_KEY: TypeAdapter[str] = TypeAdapter(AvatarKey)


def check_key(key: str) -> None:
    """Raise ValueError for an invalid key, so that it is reported before the tuning."""
    try:
        _KEY.validate_python(key)
    except ValidationError:
        raise ValueError(
            f"--save {key!r}: a key begins with a lower-case letter and has lower-case letters,"
            " digits, - and _, 80 at most"
        ) from None


@contextmanager
def lab_database(*, saves: bool) -> Iterator[Database]:
    """Open the lab's database, owning it if the tuning `saves` into it.

    Ownership is taken before the tuning, which takes minutes, so that a conflict is reported early.
    """
    with owned_database("tune") if saves else opened_database("tune") as database:
        yield database


def stored_avatar(database: Database, key: str) -> tuple[Configuration, Figure | None]:
    """Return the newest version of an avatar, without parts that its model lacks, and the model.

    Raises NotFound with the existing keys.
    """
    with database.writing() as db:
        # Before the first start of a server, the shipped avatar is not yet stored.
        if SHIPPED not in newest_numbers(db):
            add_shipped_bodies(db, Clock().utc_now())
            add_shipped_avatar(db, Clock().utc_now())
        configuration = typed(newest_version(db, avatar_by_key(db, key)))
        figure = figure_by_hash(db, configuration.humanoid)
    if figure is not None:
        configuration = without_parts(configuration, frozenset(figure.absent))
    return configuration, figure


def save_tuned(
    database: Database, key: str, report: TuningReport, tracking: Followed | None
) -> str:
    """Store the report under a new key, or as the next version; return `key, version n`."""
    with database.writing() as db:
        row = _appended(db, key, report, tracking)
        return f"{row.key}, version {row.number}"


def _appended(
    db: Session, key: str, report: TuningReport, tracking: Followed | None
) -> AvatarVersion:
    now, stored = Clock().utc_now(), report_json(report, tracking)
    content = file_of(report.configuration)
    note = f"tuned by {report.options.heuristic} on a body of {report.stature_m:g} m"
    newest = newest_numbers(db).get(key)
    if newest is None:
        new = NewAvatar(key=key, title=key, origin="tuned", note=note, configuration=content)
        return create_avatar(db, COMMAND_LINE, new, now, report=stored)
    more = NewAvatarVersion(based_on=newest, origin="tuned", note=note, configuration=content)
    return add_avatar_version(db, COMMAND_LINE, key, more, now, report=stored)
