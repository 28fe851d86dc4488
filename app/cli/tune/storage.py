"""Configurations of avatars in the lab's database, for the command `tune`."""

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
from app.features.movement.humanoids import figure_by_hash
from app.features.people.audit import COMMAND_LINE
from app.models import AvatarVersion
from app.protocol.avatar import file_of
from app.science.avatar.body import Figure
from app.science.avatar.configuration import Configuration, without_parts
from app.science.avatar.tuning import Followed, TuningReport

_KEY: TypeAdapter[str] = TypeAdapter(AvatarKey)


def check_key(key: str) -> None:
    """Say before the tuning that a key cannot be one; raises ValueError."""
    try:
        _KEY.validate_python(key)
    except ValidationError:
        raise ValueError(
            f"--save {key!r}: a key begins with a small letter and has small letters, digits,"
            " - and _, 80 at most"
        ) from None


@contextmanager
def lab_database(*, saves: bool) -> Iterator[Database]:
    """The lab's database. Where the tuning `saves` into it, nobody else has it from now until then:
    that is said before the tuning takes minutes.
    """
    with owned_database("tune") if saves else opened_database("tune") as database:
        yield database


def stored_avatar(database: Database, key: str) -> tuple[Configuration, Figure | None]:
    """The newest version of an avatar, without parts that its model lacks, and the model.

    Raises NotFound with the keys there are.
    """
    with database.writing() as db:
        # A server that was never started has not put the product's own there yet.
        if SHIPPED not in newest_numbers(db):
            add_shipped_avatar(db, Clock().utc_now())
        configuration = typed(newest_version(db, avatar_by_key(db, key)))
        figure = figure_by_hash(db, configuration.humanoid)
    if figure is not None:
        configuration = without_parts(configuration, frozenset(figure.absent))
    return configuration, figure


def save_tuned(
    database: Database, key: str, report: TuningReport, tracking: Followed | None
) -> str:
    """Store it under a new key, or as the next version of one; return `key, version n`."""
    with database.writing() as db:
        row = _appended(db, key, report, tracking)
        return f"{row.key}, version {row.number}"


def _appended(
    db: Session, key: str, report: TuningReport, tracking: Followed | None
) -> AvatarVersion:
    now, told = Clock().utc_now(), report_json(report, tracking)
    content = file_of(report.configuration)
    note = f"tuned by {report.options.heuristic} on a body of {report.stature_m:g} m"
    newest = newest_numbers(db).get(key)
    if newest is None:
        new = NewAvatar(key=key, title=key, origin="tuned", note=note, configuration=content)
        return create_avatar(db, COMMAND_LINE, new, now, report=told)
    more = NewAvatarVersion(based_on=newest, origin="tuned", note=note, configuration=content)
    return add_avatar_version(db, COMMAND_LINE, key, more, now, report=told)
