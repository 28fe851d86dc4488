"""Check that this program can read a database's content, using the functions that read it later.

A backup may be complete, with the right types of values and with matching checksums, and still have
a snapshot that is no valid state, or an order of conditions that no study has: it would crash the
server at its next start, when the restore cannot be undone. So every text that is parsed later is
parsed once before a restore is committed, by the same functions.

`unfit_rows` checks single values in a file; `require_readable` checks the meaning of rows in a
database that they were just inserted into.
"""

import sqlite3
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, get_args, get_origin, get_type_hints

from sqlalchemy import (
    JSON,
    BigInteger,
    CheckConstraint,
    DateTime,
    Integer,
    String,
    Table,
    func,
    select,
    update,
)
from sqlalchemy.exc import MultipleResultsFound, NoResultFound
from sqlalchemy.orm import Mapped, Session
from sqlalchemy.types import TypeDecorator

from app.database import Base
from app.errors import InvalidInput, ReembodyError
from app.features.design.instruments import instrument_of
from app.features.movement.avatar import typed
from app.features.people.accounts import is_hash, is_username
from app.features.record.ledger import is_code, shortfalls_of
from app.features.record.sessions import (
    MAX_TIME_SCALE,
    PhaseStatus,
    SessionStatus,
    events_of,
    folded,
    read_plan,
    state_of,
)
from app.models import (
    KINDS,
    PURPOSES,
    ROLES,
    Account,
    AlarmRow,
    AvatarVersion,
    InstrumentVersion,
    Invitation,
    Ledger,
    LedgerSlot,
    LoginToken,
    PairingCode,
    Participant,
    Phase,
    Study,
    StudySession,
    StudyVersion,
    Suggestion,
)
from app.protocol import TIMED_KINDS, StudyProtocol, parse_study_json, sha256_of
from app.science.tasks import Limb

FIRST_YEAR, LAST_YEAR = 1970, 2199
MAX_INTEGER = 2**31 - 1
LONGEST_INVITATION = timedelta(days=30)
_SHOWN = 60
ROWS_PER_FETCH = 500
_UNBOUNDED = {(Ledger.__tablename__, "seed")}
"""Integer columns of any size: a study file may have any seed, and SQLite stores it."""
_WORDS: Mapping[Any, Collection[str]] = {
    Account.role: ROLES,
    LoginToken.purpose: PURPOSES,
    PairingCode.kind: ("tablet", "headset"),
    Participant.kind: KINDS,
    StudySession.status: tuple(map(str, SessionStatus)),
    Phase.status: tuple(map(str, PhaseStatus)),
    Phase.kind: TIMED_KINDS,
    Phase.limb: tuple(map(str, Limb)),
    AlarmRow.severity: ("info", "warning", "critical"),
    AlarmRow.state: ("raised", "cleared"),
    Suggestion.status: ("open", "adopted", "declined"),
}
"""The valid words of columns that have no check constraint."""
_UNREADABLE = (
    # Includes pydantic's errors, ConfigError and PlanError.
    ValueError,
    TypeError,
    LookupError,
    AttributeError,
    ArithmeticError,
    RecursionError,
    ReembodyError,
    NoResultFound,
    MultipleResultsFound,
)
"""The errors that parsing an untrusted text can raise."""


@dataclass(frozen=True)
class Lifetimes:
    """The longest lifetimes of restored credentials from `now` on, set by the installation."""

    now: datetime
    login: timedelta
    pairing: timedelta

    def shorten(self, db: Session) -> None:
        """Limit the expiry of logins, pairing codes and invitations to that of new ones."""
        for row, lifetime in (
            (LoginToken, self.login),
            (PairingCode, self.pairing),
            (Invitation, LONGEST_INVITATION),
        ):
            latest = self.now + lifetime
            db.execute(update(row).where(row.expires_at > latest).values(expires_at=latest))


def unfit_rows(driver: sqlite3.Connection) -> Iterator[str]:
    """Yield a sentence on the first row of each table with a value that its column cannot hold.

    Checked are numbers beyond the column's range, times of other centuries, NUL characters, and the
    check constraints of the schema, which SQLite can be told to ignore.
    """
    for table in Base.metadata.sorted_tables:
        conditions = dict(_conditions(table))
        key = ", ".join(f'"{column.name}"' for column in table.primary_key)
        found = ", ".join(f"({one})" for one in conditions)
        # The names are those of the schema, from the models.
        query = f'SELECT {key}, {found} FROM "{table.name}" WHERE {" OR ".join(conditions)} LIMIT 1'  # noqa: S608 - names of our schema
        for row in driver.execute(query):
            length = len(table.primary_key)
            wrong = next(
                what for what, so in zip(conditions.values(), row[length:], strict=True) if so
            )
            yield f"in {table.name} {_row_name(row[:length])}, {wrong}"


def _conditions(table: Table) -> Iterator[tuple[str, str]]:
    """Yield each forbidden condition of a table, in SQL and in words."""
    for column in table.columns:
        kind = column.type.impl_instance if isinstance(column.type, TypeDecorator) else column.type
        name = f'"{column.name}"'
        match kind:
            case BigInteger():
                continue
            case Integer() if (table.name, column.name) not in _UNBOUNDED:
                yield (
                    f"{name} NOT BETWEEN {-MAX_INTEGER - 1} AND {MAX_INTEGER}",
                    f"{column.name} is out of range",
                )
            case DateTime():
                yield (
                    # SQLite compares such a column as a number, but its first characters as text.
                    f"substr({name}, 1, 4) NOT BETWEEN '{FIRST_YEAR}' AND '{LAST_YEAR}'",
                    f"{column.name} is outside {FIRST_YEAR} to {LAST_YEAR}",
                )
            case String():
                yield f"instr({name}, char(0)) > 0", f"{column.name} holds a NUL character"
    for check in table.constraints:
        if isinstance(check, CheckConstraint):
            yield f"NOT ({check.sqltext})", f"this does not hold: {check.sqltext}"


def require_readable(db: Session, *, even_though_altered: bool = False) -> None:
    """Raise InvalidInput, naming table, row and value, for what this program cannot have written.

    `even_though_altered`: texts may differ from their hashes, and sessions from their logs, but
    everything must be readable.
    """
    _check_words(db)
    _check_json(db)
    _check_people(db)
    _check_instruments(db, even_though_altered=even_though_altered)
    protocols = _checked_versions(db, even_though_altered=even_though_altered)
    _check_avatars(db)
    _check_ledgers(db, protocols)
    _check_sessions(db, protocols, even_though_altered=even_though_altered)


def _refused(row: object, key: object, column: str, value: object, why: str) -> InvalidInput:
    table = getattr(row, "__tablename__", row)
    shown = _shortened(value)
    return InvalidInput(
        f"in the backup, {table} {key} has the {column} {shown}, {why}; nothing was changed",
        value=shown,
        remedy="Use another copy of this backup, or another backup.",
    )


def _shortened(value: object) -> str:
    shown = repr(value)
    return shown if len(shown) <= _SHOWN else f"{shown[: _SHOWN - 1]}…"


def _row_name(key: tuple[object, ...]) -> str:
    return _shortened(key[0] if len(key) == 1 else key)


@contextmanager
def _reading(row: object, key: object, column: str, value: object) -> Iterator[None]:
    """Turn any error of parsing a value into InvalidInput for that value."""
    try:
        yield
    except _UNREADABLE as error:
        first = str(error).partition("\n")[0] or type(error).__name__
        raise _refused(
            row, key, column, value, f"which cannot be read ({_shortened(first)})"
        ) from error


def _check_words(db: Session) -> None:
    for column, words in _WORDS.items():
        table: Table = column.class_.__table__
        found = select(*table.primary_key, column).where(column.not_in(words)).limit(1)
        for row in db.execute(found):
            why = f"not one of {', '.join(words)}"
            raise _refused(table.name, _row_name(tuple(row[:-1])), column.key, row[-1], why)


def _check_json(db: Session) -> None:
    """Require a list where the models declare a list, an object where they declare a dict."""
    for mapper in Base.registry.mappers:
        table = mapper.local_table
        hints = get_type_hints(mapper.class_)
        columns = [one for one in table.columns if isinstance(one.type, JSON)]
        if not columns or not isinstance(table, Table):
            continue
        expected = [_json_types(hints[mapper.get_property_by_column(one).key]) for one in columns]
        keys = list(table.primary_key)
        query = select(*keys, *columns).execution_options(yield_per=ROWS_PER_FETCH)
        for row in db.execute(query):
            for column, types, value in zip(columns, expected, row[len(keys) :], strict=True):
                if not isinstance(value, types):
                    key = _row_name(tuple(row[: len(keys)]))
                    why = f"not {' or '.join(sorted(_JSON_NAMES[one] for one in types))}"
                    raise _refused(table.name, key, column.name, value, why)


_JSON_NAMES = {dict: "an object", list: "a list", type(None): "null"}


def _json_types(hint: object) -> tuple[type, ...]:
    (inner,) = get_args(hint) if get_origin(hint) is Mapped else (hint,)
    alternatives = (inner,) if get_origin(inner) in _JSON_NAMES else get_args(inner)
    return tuple(get_origin(one) or one for one in alternatives)


def _check_people(db: Session) -> None:
    for account in db.scalars(select(Account)):
        if not is_username(account.username):
            raise _refused(Account, account.id, "username", account.username, "no user name")
        if not is_hash(account.password_hash):
            # Do not show the hash itself: it could be used to guess the password.
            raise _refused(Account, account.id, "password_hash", "...", "no hash of a password")
    for key, code in db.execute(select(Participant.id, Participant.code)):
        if not is_code(code):
            raise _refused(Participant, key, "code", "...", "no code of a participant")


def _check_instruments(db: Session, *, even_though_altered: bool) -> None:
    for row in db.scalars(select(InstrumentVersion)):
        with _reading(InstrumentVersion, row.id, "canonical_json", row.canonical_json):
            instrument = instrument_of(row)
        if instrument.key != row.key:
            raise _refused(InstrumentVersion, row.id, "key", row.key, f"not {instrument.key!r}")
        if not even_though_altered:
            _check_hash(row)


def _check_hash(row: InstrumentVersion | StudyVersion | AvatarVersion) -> None:
    if sha256_of(row.canonical_json) != row.content_hash:
        key = row.key if isinstance(row, AvatarVersion) else row.id
        why = "not the hash of its canonical_json"
        raise _refused(type(row), key, "content_hash", row.content_hash, why)


def _checked_versions(db: Session, *, even_though_altered: bool) -> dict[str, StudyProtocol]:
    """Return the protocol of every study version, by its id."""
    numbers: dict[str, list[int]] = {}
    protocols: dict[str, StudyProtocol] = {}
    wordings = {
        (key, content_hash)
        for key, content_hash in db.execute(
            select(InstrumentVersion.key, InstrumentVersion.content_hash)
        )
    }
    keys = {study_id: key for study_id, key in db.execute(select(Study.id, Study.key))}  # noqa: C416 - rows are no pairs
    for row in db.scalars(select(StudyVersion)):
        with _reading(StudyVersion, row.id, "canonical_json", row.canonical_json):
            protocol = protocols[row.id] = parse_study_json(row.canonical_json)
        if protocol.key != keys[row.study_id]:
            why = f"not {protocol.key!r}, as its version {row.id!r} says"
            raise _refused(Study, row.study_id, "key", keys[row.study_id], why)
        for key in protocol.instrument_keys:
            if (key, row.instruments.get(key)) not in wordings:
                why = f"which names no stored wording of {key!r}"
                raise _refused(StudyVersion, row.id, "instruments", row.instruments, why)
        if not even_though_altered:
            _check_hash(row)
        numbers.setdefault(row.study_id, []).append(row.number)
    for study_id, key in keys.items():
        found = sorted(numbers.get(study_id, []))
        if not found or found != list(range(1, len(found) + 1)):
            why = "whose versions are not numbered from 1 on"
            raise _refused(Study, study_id, "key", key, f"{why}, but {_shortened(found)}")
    return protocols


def _check_avatars(db: Session) -> None:
    for row in db.scalars(select(AvatarVersion)):
        with _reading(AvatarVersion, row.key, "canonical_json", row.canonical_json):
            typed(row)


def _check_ledgers(db: Session, protocols: Mapping[str, StudyProtocol]) -> None:
    """Require every slot's order to have the design's conditions, and the blocks to be complete."""
    designs: dict[tuple[str, str], list[str]] = {}
    for version in db.scalars(select(StudyVersion)):
        conditions = sorted(one.key for one in protocols[version.id].conditions)
        designs[version.study_id, version.design_hash] = conditions
    slots: dict[str, list[LedgerSlot]] = {}
    for slot in db.scalars(select(LedgerSlot).order_by(LedgerSlot.ledger_id, LedgerSlot.position)):
        slots.setdefault(slot.ledger_id, []).append(slot)
    for ledger in db.scalars(select(Ledger)):
        expected = designs.get((ledger.study_id, ledger.design_hash))
        if expected is None:
            why = "the design of no version of the study"
            raise _refused(Ledger, ledger.id, "design_hash", ledger.design_hash, why)
        ledger_slots = slots.get(ledger.id, [])
        for slot in ledger_slots:
            order: list[object] = slot.sequence
            if (
                not all(isinstance(key, str) for key in order)
                or sorted(map(str, order)) != expected
            ):
                why = f"not each of {', '.join(expected)} once"
                raise _refused(LedgerSlot, slot.id, "sequence", order, why)
        sizes = Counter(slot.block for slot in ledger_slots)
        if (
            [slot.position for slot in ledger_slots] != list(range(len(ledger_slots)))
            or len(sizes) != ledger.blocks
            or len(set(sizes.values())) > 1
            or any(not 0 <= block < ledger.blocks for block in sizes)
        ):
            why = "to which its slots do not fit"
            raise _refused(Ledger, ledger.id, "blocks", ledger.blocks, why)


def _check_sessions(
    db: Session, protocols: Mapping[str, StudyProtocol], *, even_though_altered: bool
) -> None:
    query = select(StudySession.id).order_by(StudySession.created_at, StudySession.id)
    for session_id in db.scalars(query).all():
        session = db.get_one(StudySession, session_id)
        protocol = protocols[session.study_version_id]
        _check_session(db, session, protocol, even_though_altered=even_though_altered)
        db.expunge_all()


def _check_session(
    db: Session, session: StudySession, protocol: StudyProtocol, *, even_though_altered: bool
) -> None:
    def refused(column: str, why: str) -> InvalidInput:
        return _refused(StudySession, session.id, column, getattr(session, column), why)

    with _reading(StudySession, session.id, "snapshot", session.snapshot):
        state = state_of(session)
    with _reading(StudySession, session.id, "study_version_id", session.study_version_id):
        plan = read_plan(db, session)
    with _reading(StudySession, session.id, "shortfalls", session.shortfalls):
        shortfalls_of(session.shortfalls)
    if (str(state.status), state.version) != (session.status, session.version):
        raise refused("snapshot", f"not of {session.status} and version {session.version}")
    steps = [state.current, state.refused_consent, *(one.step for one in state.ended_phases)]
    steps.append(None if state.phase is None else state.phase.step)
    if len(state.steps) != len(plan) or not all(
        step is None or 0 <= step < len(plan) for step in steps
    ):
        raise refused("snapshot", f"not of the {len(plan)} steps of its plan")
    if session.language not in protocol.languages:
        raise refused("language", "in which the study has no texts")
    if not 0 < session.time_scale <= MAX_TIME_SCALE:
        raise refused("time_scale", f"not above 0 and at most {MAX_TIME_SCALE:g}")
    phases = db.scalars(
        select(func.max(Phase.step_index)).where(Phase.session_id == session.id)
    ).one()
    if phases is not None and phases >= len(plan):
        raise _refused(Phase, session.id, "step_index", phases, f"of {len(plan)} steps")
    if even_though_altered:
        return
    log = events_of(db, session.id)
    with _reading(StudySession, session.id, "its log", f"{len(log)} events"):
        replayed = folded(log, len(plan))
    if replayed != state:
        raise refused(
            "snapshot", f"not what its log leads to: {replayed.status}, {replayed.version}"
        )
