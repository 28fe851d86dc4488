"""The tables that figures and tests are made from: a study's sessions, read once and then filtered.

Reading is slow and does not depend on the filter; filtering is quick. So the worker process keeps
the tables until the data change. Each table is read on first use, because the first figures of a
page need few of them.
"""

from collections import OrderedDict
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import pandas as pd
from sqlalchemy import URL, select
from sqlalchemy.orm import Session

from app.features.design.instruments import instrument_of
from app.features.design.studies import newest_version, protocol_of, study_by_key, versions_of
from app.features.results.analysis.schemas import DashboardKind, FigureFilter
from app.features.results.analysis.tables import (
    alarms_table,
    answers_table,
    contact_spans_table,
    joint_angles_table,
    phases_table,
    present_course_table,
    quality_table,
    road_crossings_table,
    scores_table,
    sessions_table,
)
from app.features.results.analysis.tables.context import Contexts, phase_limbs, shared_contexts
from app.models import InstrumentVersion, StudyVersion
from app.platform.access import hidden_sessions
from app.protocol import Condition, StudyProtocol
from app.science.instruments import Instrument

OWN_BODY = "configuration"
"""The name that stands for the body of the avatar's configuration in the choice of a body."""
MAX_CACHED = 3
"""Number of studies and kinds whose tables are cached; a thousand sessions take about 200 MB."""
READ: Mapping[str, Callable[[Session, str, DashboardKind], pd.DataFrame]] = {
    "sessions": sessions_table,
    "scores": scores_table,
    "answers": answers_table,
    "phases": phases_table,
    "contacts": contact_spans_table,
    "errors": joint_angles_table,
    "courses": present_course_table,
    "quality": quality_table,
    "alarms": alarms_table,
    "crossings": road_crossings_table,
    "limbs": phase_limbs,
}


class Tables(dict[str, pd.DataFrame]):
    """Tables by name, each created by `make` on first use."""

    def __init__(self, make: Callable[[str], pd.DataFrame]) -> None:
        super().__init__()
        self._make = make

    def __missing__(self, name: str) -> pd.DataFrame:
        made = self._make(name)
        self[name] = made
        return made


@dataclass(frozen=True, eq=False)
class Material:
    """The tables of a study's sessions of one kind, with every row, valid or not.

    `instruments` by (key, version). `tables` by the names in `READ`. `hidden`: sessions whose
    condition must stay blinded, whichever version of the study they ran. `conditions`: those of
    each version (number, key). `protocol`: that of the newest version, which sessions may not have
    run yet.

    Figures and tests compare latencies. If conditions share a latency and differ in their bodies,
    each of them covers one body (`of_body`), and others compare the bodies at one latency
    (`at_latency`), so that conditions are never mixed.
    """

    protocol: StudyProtocol
    kind: DashboardKind
    tables: Tables
    instruments: Mapping[tuple[str, int], Instrument]
    hidden: frozenset[str] = frozenset()
    conditions: Mapping[tuple[int, str], Condition] = field(default_factory=dict)

    @cached_property
    def bodies(self) -> tuple[str, ...]:
        """Return the bodies to analyse one at a time; none if latencies tell conditions apart.

        Each session is read by the version that it ran, so the bodies are those of all versions
        that have sessions; without any session, those of the newest version.
        """
        ran = set(self.sessions["study_version"])
        used = [one for (version, _), one in self.conditions.items() if version in ran]
        used = used or list(self.protocol.conditions)
        places = {(one.latency_ms, one.body) for one in used}
        if len({latency_ms for latency_ms, _ in places}) == len(places):
            return ()
        return tuple(dict.fromkeys(one.body or OWN_BODY for one in used))

    @property
    def sessions(self) -> pd.DataFrame:
        """Return the table of sessions, one row per session."""
        return self.tables["sessions"]

    @property
    def scores(self) -> pd.DataFrame:
        """Return the table of scores, one row per score of every form."""
        return self.tables["scores"]

    @property
    def answers(self) -> pd.DataFrame:
        """Return the table of answers, one row per answered item of every form."""
        return self.tables["answers"]

    @property
    def phases(self) -> pd.DataFrame:
        """Return the table of phases, one row per phase."""
        return self.tables["phases"]

    @property
    def contacts(self) -> pd.DataFrame:
        """Return the table of contacts, one row per contact interval, without UTC times."""
        return self.tables["contacts"]

    @property
    def errors(self) -> pd.DataFrame:
        """Return the joint errors that are angles relative to the present pose."""
        return self.tables["errors"]

    @property
    def courses(self) -> pd.DataFrame:
        """Return the joint errors relative to the present pose by bin of active time."""
        return self.tables["courses"]

    @property
    def quality(self) -> pd.DataFrame:
        """Return the table of quality, one row per finished phase and stream."""
        return self.tables["quality"]

    @property
    def alarms(self) -> pd.DataFrame:
        """Return the table of alarms, one row per alarm raised or cleared."""
        return self.tables["alarms"]

    @property
    def crossings(self) -> pd.DataFrame:
        """Return the table of crossings of the study's road, one row per crossing."""
        return self.tables["crossings"]

    @property
    def limbs(self) -> set[str]:
        """Return the limbs with which the tasks of the phases were done."""
        return set(self.tables["limbs"]["limb"].dropna())

    @property
    def blinded(self) -> bool:
        """Return whether operators must not know the latencies of open sessions."""
        return self.protocol.blinding.operator or bool(self.hidden)

    @property
    def visible(self) -> pd.DataFrame:
        """Return the sessions whose measures are shown; if blinded, only completed ones."""
        candidates = self.sessions[~self.sessions["session_id"].isin(list(self.hidden))]
        return candidates[candidates["status"] == "completed"] if self.blinded else candidates

    def chosen(self, chosen: FigureFilter) -> "Material":
        """Return the rows that pass a filter, valid or not."""
        # In a blinded study, a filter by order or body must not reveal that of an open session.
        reveals = chosen.order is not None or chosen.body is not None
        candidates = self.visible if reveals else self.sessions
        sessions = _sessions(candidates, chosen)
        ids = set(sessions["session_id"])
        found = self._of(sessions, ids, chosen.limb)
        return found if chosen.body is None else found.of_body(chosen.body)

    def with_body(self, chosen: FigureFilter) -> FigureFilter:
        """Return the filter with a body chosen, if one has to be chosen."""
        if chosen.body is not None or not self.bodies:
            return chosen
        return chosen.model_copy(update={"body": self.bodies[0]})

    def of_body(self, body: str) -> "Material":
        """Return the rows of phases in which a body was worn, and those outside the blocks."""
        conditions = {
            place for place, one in self.conditions.items() if (one.body or OWN_BODY) == body
        }
        tables = Tables(lambda name: _rows_of(self.tables[name], conditions))
        return replace(self, tables=tables)

    @cached_property
    def shared_latencies_ms(self) -> tuple[float, ...]:
        """Return the latencies at which several bodies were worn, in ascending order."""
        if not self.bodies:
            return ()
        ran = set(self.sessions["study_version"])
        worn: dict[float, set[str | None]] = {}
        for (version, _), one in self.conditions.items():
            if not ran or version in ran:
                worn.setdefault(one.latency_ms, set()).add(one.body)
        return tuple(sorted(at for at, bodies in worn.items() if len(bodies) > 1))

    def at_latency(self, latency_ms: float) -> "Material":
        """Return the rows of conditions with this latency, each with its body (column `body`)."""
        chosen = {
            place: one.body or OWN_BODY
            for place, one in self.conditions.items()
            if one.latency_ms == latency_ms
        }
        tables = Tables(lambda name: _with_bodies(self.tables[name], chosen))
        return replace(self, tables=tables)

    def of_sessions(self, ids: set[str]) -> "Material":
        """Return the rows that belong to these sessions."""
        return self._of(self.sessions[self.sessions["session_id"].isin(ids)], ids, None)

    def _of(self, sessions: pd.DataFrame, ids: set[str], limb: str | None) -> "Material":
        tables = Tables(lambda name: _rows(self.tables[name], ids, limb))
        tables["sessions"] = sessions
        return replace(self, tables=tables)

    def counting(self, rows: pd.DataFrame, *, invalid: bool = False) -> pd.DataFrame:
        """Return the valid rows of visible sessions; with `invalid`, all their rows."""
        seen = rows["session_id"].isin(set(self.visible["session_id"]))
        return rows[seen] if invalid else rows[seen & rows["valid"]]


def read_material(
    db: Session, study_key: str, kind: DashboardKind, names: Collection[str] = READ.keys()
) -> Material:
    """Read these tables immediately, by default all; raise NotFound for an unknown study.

    The others are read on first use, for which the transaction has to be open still.
    """
    material = _Reader(study_key, kind, db).material()
    for name in names:
        material.tables[name]
    return material


@dataclass
class _Reader:
    """Reads tables on demand, in the transaction that is open at that time.

    The context that several tables are joined with (`contexts`) is read once for all of them.
    """

    study_key: str
    kind: DashboardKind
    db: Session
    contexts: Contexts = field(default_factory=dict)

    def material(self) -> Material:
        """Return the material with no table read yet; raise NotFound for an unknown study."""
        study = study_by_key(self.db, self.study_key)
        protocol = protocol_of(newest_version(self.db, study))
        versions = list(versions_of(self.db, study))
        instruments = _instruments(self.db, versions)
        hidden = hidden_sessions(self.db, study)
        conditions = {
            (version.number, one.key): one
            for version in versions
            for one in protocol_of(version).conditions
        }
        return Material(protocol, self.kind, Tables(self._read), instruments, hidden, conditions)

    def _read(self, name: str) -> pd.DataFrame:
        with shared_contexts(self.contexts):
            return READ[name](self.db, self.study_key, self.kind)


@dataclass
class MaterialStore:
    """A cache of tables by database, study and kind, valid until the state of the data changes."""

    _cache: "OrderedDict[tuple[URL, str, str], tuple[object, _Reader, Material]]" = field(
        default_factory=OrderedDict
    )

    def get(self, db: Session, study_key: str, kind: DashboardKind, state: object) -> Material:
        """Return the tables as of `state`, which is the state in the transaction of `db`.

        Tables that were read before are reused; others are read through `db`, which must be open
        when they are first used. If the state has changed, all are read again.
        """
        name = (db.get_bind().engine.url, study_key, kind)
        found = self._cache.pop(name, None)
        if found is None or found[0] != state:
            # Release the old tables first: two sets of a large study's would take too much memory.
            found = None
            reader = _Reader(study_key, kind, db)
            found = (state, reader, reader.material())
        found[1].db = db
        self._cache[name] = found
        while len(self._cache) > MAX_CACHED:
            self._cache.popitem(last=False)
        return found[2]


def _instruments(
    db: Session, versions: Sequence[StudyVersion]
) -> dict[tuple[str, int], Instrument]:
    """Return every instrument by key and version: that of the study, if several have both.

    A release may have mended a file under the same number; older databases may have others.
    """
    rows = db.scalars(
        select(InstrumentVersion).order_by(InstrumentVersion.created_at, InstrumentVersion.id)
    ).all()
    own = {place for version in versions for place in version.instruments.items()}
    found = [instrument_of(row) for row in rows if (row.key, row.content_hash) not in own]
    asked = [instrument_of(row) for row in rows if (row.key, row.content_hash) in own]
    return {(one.key, one.version): one for one in (*found, *asked)}


def _sessions(sessions: pd.DataFrame, chosen: FigureFilter) -> pd.DataFrame:
    mask = pd.Series(data=True, index=sessions.index)
    if chosen.participant:
        mask &= sessions["participant_code"].isin(chosen.participant)
    if chosen.order is not None:
        mask &= sessions["order"] == chosen.order
    days = sessions["created_at_utc"].dt.date
    if chosen.since is not None:
        mask &= days >= chosen.since
    if chosen.until is not None:
        mask &= days <= chosen.until
    return sessions[mask]


def _rows_of(rows: pd.DataFrame, conditions: Collection[tuple[int, str]]) -> pd.DataFrame:
    """Return the rows of these conditions (version, key), and those of no condition."""
    if "condition" not in rows.columns:
        return rows
    places = zip(rows["study_version"], rows["condition"], strict=True)
    chosen = [key is None or (version, key) in conditions for version, key in places]
    return rows[pd.Series(chosen, rows.index, dtype=bool)]


def _with_bodies(rows: pd.DataFrame, bodies: Mapping[tuple[int, str], str]) -> pd.DataFrame:
    """Return the rows of these conditions (version, key), each with the name of its body."""
    if "condition" not in rows.columns:
        return rows
    places = list(zip(rows["study_version"], rows["condition"], strict=True))
    body = pd.Series([bodies.get(place) for place in places], rows.index, dtype=object)
    return rows.assign(body=body)[body.notna()]


def _rows(rows: pd.DataFrame, ids: set[str], limb: str | None) -> pd.DataFrame:
    mask = rows["session_id"].isin(ids)
    if limb is not None and "limb" in rows.columns:
        # Rows without a limb belong to the whole session.
        mask &= rows["limb"].isna() | (rows["limb"] == limb)
    return rows[mask]
