"""Store avatar configurations, named by a key, as versions that are never edited.

Like captures, they belong to the lab, not to a study. A session refers to the configuration it
used by its hash, so it can be looked up however the avatar is tuned later.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from datetime import datetime
from functools import lru_cache
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidConfig, InvalidInput, NotFound, StaleVersion
from app.features.movement.avatar.schemas import NewAvatar, NewAvatarVersion, Origin
from app.features.movement.humanoids import (
    asked_terms,
    humanoid_by_hash,
    is_known,
    licence_is_read,
)
from app.features.people.audit import record
from app.models import Avatar, AvatarVersion
from app.plain_titles import NO_NAMES
from app.platform.config_problems import StoredFault, require_sound, stored_fault
from app.protocol.avatar import (
    AvatarFile,
    LoadedAvatar,
    check_pieces,
    configuration_of,
    loaded,
    parse_avatar_json,
)
from app.resources import bodies_dir
from app.science.avatar.configuration import (
    AvatarProblem,
    AvatarSettingsError,
    Configuration,
    missing_part_problems,
)
from app.science.avatar.mjcf import default_configuration

SHIPPED = "standard"
"""The key of the configuration that comes with the product."""
_GAINS_BY_RULE = (
    "Gains by rule, not tuned: the natural frequency chosen for each body part, with the inertia"
    " that each axis moves in a body of 1.75 m and 72 kg (app/science/avatar/mjcf/gains.py)."
    " Torque limits are estimates."
)
_GAINS_BY_RELAY = (
    "Gains by relay tuning of the neutral body, 1.75 m and 72 kg: rule critical, left side copied"
    " to the right, 89 axes tuned, none flagged, overshoot of 1.2 % at most. The relay's torques"
    " were computed from the inertia of each axis, and were up to four times its torque limit; the"
    " present tuning, which finds them by a ramp within the limits, gives a kp within 10 % and a"
    " kd within 5 % on every axis. Torque limits are estimates."
)
SHIPPED_GAINS_FROM = (_GAINS_BY_RULE, _GAINS_BY_RELAY)
"""Where the gains of each shipped version come from, as its note tells."""
_SHIPPED_TITLE = "Standard"
_PRODUCT = "system"


def create_avatar(
    db: Session,
    actor: str,
    request: NewAvatar,
    now: datetime,
    *,
    report: Mapping[str, Any] | None = None,
) -> AvatarVersion:
    """Save an avatar configuration under a new key.

    Raises InvalidInput if the key reads as another value, Conflict if it is taken, InvalidConfig
    with every problem of the configuration.
    """
    if request.key in NO_NAMES:
        raise InvalidInput(
            f"no avatar can have the key {request.key!r}: study files and tables read that as a "
            "value of their own",
            value=request.key,
            valid=f"any other key than {', '.join(sorted(NO_NAMES))}",
            remedy="Choose another key.",
        )
    content = _buildable(db, request.configuration)
    if db.get(Avatar, request.key) is not None:
        raise Conflict(
            f"there is an avatar {request.key!r} already",
            value=request.key,
            remedy="Save a new version of it, or give the new one another key.",
        )
    db.add(Avatar(key=request.key, title=request.title, by=actor, at=now))
    db.flush()
    row = _append(
        db, request.key, 1, content, request.origin, request.note, actor, now, report=report
    )
    _note(db, actor, row, "avatar.created", now)
    return row


def add_avatar_version(
    db: Session,
    actor: str,
    key: str,
    request: NewAvatarVersion,
    now: datetime,
    *,
    report: Mapping[str, Any] | None = None,
) -> AvatarVersion:
    """Append a version, or return the newest one if it is the same: a request may be sent twice.

    Raises InvalidInput if it is based on a version that there is not, StaleVersion if somebody
    saved one meanwhile, Conflict if the newest one has this content and another note, which would
    be lost, InvalidConfig, NotFound.
    """
    content = _buildable(db, request.configuration)
    avatar = avatar_by_key(db, key, lock=True)
    newest = newest_version(db, avatar)
    if newest.content_hash == content.content_hash:
        if request.note in ("", newest.note):
            return newest
        raise Conflict(
            f"nothing new was saved: {key}@{newest.number} has these settings already, with"
            " another note",
            value=request.note,
            valid=newest.note,
            remedy="Use that version, whose note stays as it is; or save with the note what changes"
            " something.",
        )
    if request.based_on > newest.number:
        raise InvalidInput(
            f"the avatar {key!r} has no version {request.based_on}",
            value=request.based_on,
            valid=f"1 to {newest.number}",
            remedy="Give the version that the settings were edited from. Nothing was saved.",
        )
    if request.based_on != newest.number:
        raise StaleVersion(
            "somebody else has changed this avatar in the meantime",
            value=request.based_on,
            valid=newest.number,
            remedy="Check the current version, then decide. Nothing was saved.",
        )
    number = newest.number + 1
    row = _append(db, key, number, content, request.origin, request.note, actor, now, report=report)
    _note(db, actor, row, "avatar.version", now)
    return row


def shipped_configurations() -> tuple[Configuration, ...]:
    """Return all versions of the standard avatar that releases have shipped, oldest first.

    The first has simple colliders and no model; the second is the neutral body with mesh colliders
    and gains that were tuned for it.
    """
    text = (bodies_dir() / "standard.json").read_text(encoding="utf-8")
    return default_configuration(), parse_avatar_json(text)


def add_shipped_avatar(db: Session, now: datetime) -> None:
    """Store the shipped configuration, unless the lab has saved its own version under its key.

    A new installation gets the versions of earlier releases as well, because studies name them. The
    body must have been stored before (`add_shipped_bodies`). Each version's note says where its
    gains come from; a version that an earlier release stored without one gets it now.
    """
    contents = [loaded(configuration) for configuration in shipped_configurations()]
    content = contents[-1]
    notes = {one.content_hash: note for one, note in zip(contents, SHIPPED_GAINS_FROM, strict=True)}
    avatar = db.get(Avatar, SHIPPED)
    if avatar is None:
        db.add(Avatar(key=SHIPPED, title=_SHIPPED_TITLE, by=_PRODUCT, at=now))
        db.flush()
        for number, one in enumerate(contents, start=1):
            _append(db, SHIPPED, number, one, "shipped", notes[one.content_hash], _PRODUCT, now)
        return
    for row in db.scalars(select(AvatarVersion).filter_by(key=SHIPPED, origin="shipped", note="")):
        row.note = notes.get(row.content_hash, "")
    newest = newest_version(db, avatar)
    if newest.origin == "shipped" and newest.content_hash != content.content_hash:
        note = notes[content.content_hash]
        _append(db, SHIPPED, newest.number + 1, content, "shipped", note, _PRODUCT, now)


def avatar_by_key(db: Session, key: str, *, lock: bool = False) -> Avatar:
    """Return the avatar with this key; raise NotFound if there is none.

    `lock` locks its row, so that concurrent writers wait.
    """
    query = select(Avatar).where(Avatar.key == key)
    avatar = db.scalar(query.with_for_update() if lock else query)
    if avatar is None:
        keys = list(db.scalars(select(Avatar.key).order_by(Avatar.key)))
        raise NotFound(
            f"there is no avatar {key!r}",
            value=key,
            valid=keys,
            remedy="Name one of these, or make it on the page Avatars.",
        )
    return avatar


def newest_numbers(db: Session) -> dict[str, int]:
    """Return the number of the newest version of every avatar, by key."""
    rows = db.execute(
        select(AvatarVersion.key, func.max(AvatarVersion.number)).group_by(AvatarVersion.key)
    )
    return {key: number for key, number in rows}  # noqa: C416 - rows are not tuples to mypy


def all_versions(db: Session) -> list[tuple[Avatar, list[AvatarVersion]]]:
    """Return every avatar by key, with its versions, oldest first."""
    rows = list(db.scalars(select(AvatarVersion).order_by(AvatarVersion.number)))
    return [
        (avatar, [row for row in rows if row.key == avatar.key])
        for avatar in db.scalars(select(Avatar).order_by(Avatar.key))
    ]


def newest_version(db: Session, avatar: Avatar) -> AvatarVersion:
    """Return the newest version of an avatar."""
    return db.scalars(
        select(AvatarVersion)
        .where(AvatarVersion.key == avatar.key)
        .order_by(AvatarVersion.number.desc())
        .limit(1)
    ).one()


def version_of(db: Session, key: str, number: int | None) -> AvatarVersion:
    """Return a version by its number, or the newest for None; raise NotFound if there is none."""
    avatar = avatar_by_key(db, key)
    if number is None:
        return newest_version(db, avatar)
    row = db.get(AvatarVersion, (key, number))
    if row is None:
        raise NotFound(
            f"the avatar {key!r} has no version {number}",
            value=number,
            valid=f"1 to {newest_version(db, avatar).number}",
            remedy="Name a version that was saved, or leave it out for the newest.",
        )
    return row


def configuration_by_hash(db: Session, content_hash: str) -> Configuration:
    """Return the configuration with this hash; raise NotFound if there is none."""
    query = select(AvatarVersion).where(AvatarVersion.content_hash == content_hash).limit(1)
    row = db.scalar(query)
    if row is None:
        raise NotFound("no avatar has this content", value=content_hash)
    return typed(row)


def configurations(db: Session) -> Callable[[str, int], Configuration | None]:
    """Return a function from an avatar's key and version to its configuration, or None."""

    def configured(key: str, number: int) -> Configuration | None:
        row = db.get(AvatarVersion, (key, number))
        return None if row is None else typed(row)

    return configured


def typed(version: AvatarVersion) -> Configuration:
    """Return the parsed configuration of an avatar version.

    Raises NotDurable if its content does not have its hash, because the database was damaged.
    """
    return _parsed(version.content_hash, version.canonical_json)


@lru_cache(maxsize=64)
def _parsed(content_hash: str, canonical_json: str) -> Configuration:
    require_sound(canonical_json, content_hash)
    return parse_avatar_json(canonical_json)


def faulty_avatars(db: Session) -> tuple[int, list[StoredFault]]:
    """Return how many versions of avatars are stored, and what is wrong with some of them."""
    query = select(AvatarVersion).order_by(AvatarVersion.key, AvatarVersion.number)
    rows = list(db.scalars(query))
    found = (
        stored_fault(
            row.key,
            row.number,
            (row.canonical_json, row.content_hash),
            parse_avatar_json,
            lambda one: (problem.message for problem in missing_part_problems(one)),
        )
        for row in rows
    )
    return len(rows), [one for one in found if one is not None]


def checked(db: Session, file: AvatarFile) -> LoadedAvatar:
    """Return the validated configuration of a file; raise InvalidConfig with every problem."""
    try:
        configuration = configuration_of(file)
        check_pieces(configuration)
        problems = tuple(unknown_humanoid(db, configuration))
        if problems:
            raise AvatarSettingsError(problems)
        return loaded(configuration)
    except AvatarSettingsError as error:
        raise _invalid(error.problems) from None


def _buildable(db: Session, file: AvatarFile) -> LoadedAvatar:
    """Return the validated configuration of a file of which a body can be built."""
    content = checked(db, file)
    problems = tuple(missing_part_problems(content.configuration))
    if problems:
        raise _invalid(problems)
    return content


def _invalid(problems: Iterable[AvatarProblem]) -> InvalidConfig:
    return InvalidConfig(
        "the avatar's configuration contradicts itself",
        remedy="Correct what is named below; nothing was saved.",
        details=[
            {
                "path": f"configuration.{one.path}",
                "message": one.message,
                "value": one.value,
                "valid": one.valid,
                "remedy": one.remedy,
            }
            for one in problems
        ],
    )


def unknown_humanoid(db: Session, configuration: Configuration) -> Iterator[AvatarProblem]:
    """Yield a problem if the configuration refers to a body that is missing or must not be worn.

    A body must not be worn before its licence has been read, and the terms in it that restrict
    wearing are confirmed. Configurations that are stored already are not checked again.
    """
    content_hash = configuration.humanoid
    if content_hash is None:
        return
    if not is_known(db, content_hash):
        yield AvatarProblem(
            "humanoid",
            "There is no such humanoid model here.",
            value=content_hash,
            valid="the hash of an uploaded model",
            remedy="Upload the model's file first, or leave 'humanoid' out.",
        )
        return
    row = humanoid_by_hash(db, content_hash)
    if not licence_is_read(row):
        yield AvatarProblem(
            "humanoid",
            "The licence of this body was never read, because an earlier release stored the body.",
            value=content_hash,
            valid="a body whose licence has been read",
            remedy="Measure it again on the page Bodies, which reads the licence from its file.",
        )
    elif asked_terms(row):
        yield AvatarProblem(
            "humanoid",
            "The licence of this body restricts who may wear it, and nobody has confirmed that "
            "participants may.",
            value=content_hash,
            valid="a body that participants may wear",
            remedy="Confirm its terms on the page Bodies, or choose another body.",
        )


def _append(
    db: Session,
    key: str,
    number: int,
    content: LoadedAvatar,
    origin: Origin,
    note: str,
    by: str,
    now: datetime,
    *,
    report: Mapping[str, Any] | None = None,
) -> AvatarVersion:
    humanoid = content.configuration.humanoid
    if humanoid is not None:
        # Whoever deletes a body waits for this lock, and finds the configuration then.
        humanoid_by_hash(db, humanoid, lock=True)
    row = AvatarVersion(
        key=key,
        number=number,
        content_hash=content.content_hash,
        canonical_json=content.canonical_json,
        origin=origin,
        note=note,
        report=None if report is None else dict(report),
        by=by,
        at=now,
    )
    db.add(row)
    db.flush()
    return row


def _note(db: Session, actor: str, row: AvatarVersion, action: str, now: datetime) -> None:
    record(
        db,
        actor=actor,
        action=action,
        subject=f"avatar:{row.key}",
        details={"version": row.number, "origin": row.origin, "content": row.content_hash[:12]},
        now=now,
    )
