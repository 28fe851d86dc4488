"""What figures and tests are made of: the tables of a study's sessions, read once and then chosen.

Reading is slow and does not depend on what a reader picks; choosing is quick. So the tables are
kept in the process that draws, for as long as the data stand still. Each is read when it is first
wanted: the first figures of a page need few of them.
"""

from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import pandas as pd
from sqlalchemy import URL, select
from sqlalchemy.orm import Session

from app.features.design.instruments import instrument_of
from app.features.design.studies import newest_version, protocol_of, study_by_key
from app.features.results.analysis.schemas import DashboardKind, FigureFilter
from app.features.results.analysis.tables import (
    alarms_table,
    answers_table,
    contact_spans_table,
    joint_angles_table,
    phases_table,
    present_course_table,
    quality_table,
    scores_table,
    sessions_table,
)
from app.features.results.analysis.tables.context import Contexts, phase_limbs, shared_contexts
from app.models import InstrumentVersion
from app.platform.access import hidden_sessions
from app.protocol import StudyProtocol
from app.science.instruments import Instrument

KEPT = 3
"""Studies and kinds whose tables are kept; those of a thousand sessions take some 200 MB."""
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
    "limbs": phase_limbs,
}


class Tables(dict[str, pd.DataFrame]):
    """Tables by name, each made by `make` when it is first wanted."""

    def __init__(self, make: Callable[[str], pd.DataFrame]) -> None:
        super().__init__()
        self._make = make

    def __missing__(self, name: str) -> pd.DataFrame:
        made = self._make(name)
        self[name] = made
        return made


@dataclass(frozen=True, eq=False)
class Material:
    """The tables of a study's sessions of one kind, every row, valid or not.

    `instruments` by (key, version). `tables` by the names in `READ`. `hidden`: sessions whose
    condition must not be known, whichever version of the study they ran.
    """

    protocol: StudyProtocol
    kind: DashboardKind
    tables: Tables
    instruments: Mapping[tuple[str, int], Instrument]
    hidden: frozenset[str] = frozenset()

    @property
    def sessions(self) -> pd.DataFrame:
        """One row per session."""
        return self.tables["sessions"]

    @property
    def scores(self) -> pd.DataFrame:
        """One row per score of every form."""
        return self.tables["scores"]

    @property
    def answers(self) -> pd.DataFrame:
        """One row per answered item of every form."""
        return self.tables["answers"]

    @property
    def phases(self) -> pd.DataFrame:
        """One row per phase."""
        return self.tables["phases"]

    @property
    def contacts(self) -> pd.DataFrame:
        """One row per contact interval, without UTC."""
        return self.tables["contacts"]

    @property
    def errors(self) -> pd.DataFrame:
        """Of the joint errors, the angles to the present pose."""
        return self.tables["errors"]

    @property
    def courses(self) -> pd.DataFrame:
        """Bins of active time: joint errors to the present pose."""
        return self.tables["courses"]

    @property
    def quality(self) -> pd.DataFrame:
        """One row per phase that was finished and stream."""
        return self.tables["quality"]

    @property
    def alarms(self) -> pd.DataFrame:
        """One row per alarm raised or cleared."""
        return self.tables["alarms"]

    @property
    def limbs(self) -> set[str]:
        """The limbs that phases were done with."""
        return set(self.tables["limbs"]["limb"].dropna())

    @property
    def blinded(self) -> bool:
        """Whether those who run sessions must not know the latencies."""
        return self.protocol.blinding.operator or bool(self.hidden)

    @property
    def visible(self) -> pd.DataFrame:
        """The sessions whose measures are shown: of a blinded study those that are completed."""
        known = self.sessions[~self.sessions["session_id"].isin(list(self.hidden))]
        return known[known["status"] == "completed"] if self.blinded else known

    def chosen(self, chosen: FigureFilter) -> "Material":
        """What a filter leaves; rows stay as they are, valid or not."""
        # In a blinded study the order of an open session is not to be found out by choosing one.
        known = self.visible if chosen.order is not None else self.sessions
        sessions = _sessions(known, chosen)
        ids = set(sessions["session_id"])
        return self._of(sessions, ids, chosen.limb)

    def of_sessions(self, ids: set[str]) -> "Material":
        """What belongs to these sessions."""
        return self._of(self.sessions[self.sessions["session_id"].isin(ids)], ids, None)

    def _of(self, sessions: pd.DataFrame, ids: set[str], limb: str | None) -> "Material":
        tables = Tables(lambda name: _rows(self.tables[name], ids, limb))
        tables["sessions"] = sessions
        return replace(self, tables=tables)

    def counting(self, rows: pd.DataFrame, *, invalid: bool = False) -> pd.DataFrame:
        """The rows of visible sessions that count; with `invalid` the others too."""
        seen = rows["session_id"].isin(set(self.visible["session_id"]))
        return rows[seen] if invalid else rows[seen & rows["valid"]]


def n_not_valid(sessions: pd.DataFrame) -> int:
    """How many sessions were completed and do not count by the rules of their study."""
    return int(((sessions["status"] == "completed") & ~sessions["valid"]).sum())


def read_material(db: Session, study_key: str, kind: DashboardKind) -> Material:
    """Read every table at once; raises NotFound for an unknown study."""
    material = _Reader(study_key, kind, db).material()
    for name in READ:
        material.tables[name]
    return material


@dataclass
class _Reader:
    """Reads tables when they are wanted, by the transaction that is open then.

    What several tables are joined with (`contexts`) is read once for all of them.
    """

    study_key: str
    kind: DashboardKind
    db: Session
    contexts: Contexts = field(default_factory=dict)

    def material(self) -> Material:
        """Without a table yet; raises NotFound for an unknown study."""
        study = study_by_key(self.db, self.study_key)
        protocol = protocol_of(newest_version(self.db, study))
        instruments, hidden = _instruments(self.db), hidden_sessions(self.db, study)
        return Material(protocol, self.kind, Tables(self._read), instruments, hidden)

    def _read(self, name: str) -> pd.DataFrame:
        with shared_contexts(self.contexts):
            return READ[name](self.db, self.study_key, self.kind)


@dataclass
class MaterialStore:
    """Tables by database, study and kind, for as long as the data have the state they show."""

    _kept: "OrderedDict[tuple[URL, str, str], tuple[object, _Reader, Material]]" = field(
        default_factory=OrderedDict
    )

    def get(self, db: Session, study_key: str, kind: DashboardKind, state: object) -> Material:
        """The tables as of `state`, which are those of this transaction.

        Tables that were read before stay; others are read by `db`, which must be open when they
        are first wanted. With another state all are read anew.
        """
        name = (db.get_bind().engine.url, study_key, kind)
        found = self._kept.pop(name, None)
        if found is None or found[0] != state:
            # Let go first: two sets of a large study's tables need not be there at once.
            found = None
            reader = _Reader(study_key, kind, db)
            found = (state, reader, reader.material())
        found[1].db = db
        self._kept[name] = found
        while len(self._kept) > KEPT:
            self._kept.popitem(last=False)
        return found[2]


def _instruments(db: Session) -> dict[tuple[str, int], Instrument]:
    found = [instrument_of(row) for row in db.scalars(select(InstrumentVersion))]
    return {(one.key, one.version): one for one in found}


def _sessions(sessions: pd.DataFrame, chosen: FigureFilter) -> pd.DataFrame:
    kept = pd.Series(data=True, index=sessions.index)
    if chosen.participant:
        kept &= sessions["participant_code"].isin(chosen.participant)
    if chosen.order is not None:
        kept &= sessions["order"] == chosen.order
    days = sessions["created_at_utc"].dt.date
    if chosen.since is not None:
        kept &= days >= chosen.since
    if chosen.until is not None:
        kept &= days <= chosen.until
    return sessions[kept]


def _rows(rows: pd.DataFrame, ids: set[str], limb: str | None) -> pd.DataFrame:
    kept = rows["session_id"].isin(ids)
    if limb is not None and "limb" in rows.columns:
        # Rows of no limb belong to the whole session.
        kept &= rows["limb"].isna() | (rows["limb"] == limb)
    return rows[kept]
