"""The files of an export, each with its content in pieces, in the order in which they are written.

An export as a folder and as an archive writes the same members, so they cannot differ. A member is
read from the database while it is written; the README is written last, because it lists the others.
"""

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import astuple, dataclass, field, fields, replace
from datetime import datetime

import pandas as pd
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.design.studies import instrument_for, study_by_key
from app.features.people.audit import TrailHead, head_of
from app.features.record.receipts import Tallies, receipt_of
from app.features.record.telemetry import epochs_of
from app.features.results.analysis.codebook import codebook_frame
from app.features.results.analysis.questions import WideColumn, wide_table
from app.features.results.analysis.tables import (
    Contexts,
    Kind,
    alarms_table,
    answers_table,
    body_calibrations_table,
    calibrations_table,
    clock_mapping_table,
    clock_probes_table,
    companion_frames,
    completions_table,
    contacts_table,
    corrections_table,
    doubts_table,
    events_table,
    goal_states_table,
    has_companion_frames,
    has_rules,
    has_tracker_samples,
    headset_tests_table,
    joint_error_course_table,
    joint_errors_table,
    n_not_valid,
    phases_table,
    quality_table,
    road_crossings_table,
    road_records,
    scores_table,
    sessions_table,
    shared_contexts,
    tracker_alignments_table,
    tracker_samples,
)
from app.features.results.exports.names import (
    companions_path,
    fingers_path,
    receipt_path,
    road_path,
    samples_path,
    trackers_path,
)
from app.features.results.exports.writing.blinding import without_conditions
from app.features.results.exports.writing.cells import (
    csv_pieces,
    csv_pieces_of_many,
    plain_pieces,
)
from app.features.results.exports.writing.readme import FileCount, Origin, readme_text
from app.features.results.exports.writing.samples import SampleFile
from app.features.results.imports import import_files
from app.models import Study, StudyVersion
from app.platform.access import hidden_sessions, revealed_sessions
from app.wire import FINGER_STREAMS

TABLE_FILES: dict[str, Callable[[Session, str, Kind], pd.DataFrame]] = {
    "sessions": sessions_table,
    "phases": phases_table,
    "answers": answers_table,
    "scores": scores_table,
    "corrections": corrections_table,
    "contacts": contacts_table,
    "completions": completions_table,
    "joint_errors": joint_errors_table,
    "joint_error_course": joint_error_course_table,
    "events": events_table,
    "quality": quality_table,
    "doubts": doubts_table,
    "alarms": alarms_table,
    "clock_probes": clock_probes_table,
    "clock_mapping": clock_mapping_table,
    "goal_states": goal_states_table,
    "body_calibrations": body_calibrations_table,
    "tracker_alignments": tracker_alignments_table,
    "road_crossings": road_crossings_table,
}
EQUIPMENT_FILES: dict[str, Callable[[Session], pd.DataFrame]] = {
    "calibrations": calibrations_table,
    "headset_tests": headset_tests_table,
}
"""The tables of the lab's equipment, which are of no one study."""
README = "README.txt"
FOLDERS = {
    "samples": ".csv",
    "fingers": ".csv",
    "trackers": ".csv",
    "companions": ".csv",
    "road": ".jsonl",
    "receipts": ".json",
    "protocol": ".yaml",
    "imported": ".csv",
}
"""The folders of an export, and the suffixes of their files."""
TOP_LEVEL = frozenset(
    {
        *(f"{name}.csv" for name in (*TABLE_FILES, *EQUIPMENT_FILES, "codebook")),
        *("wide.csv", "wide_columns.csv"),
        README,
    }
)


@dataclass(frozen=True)
class Member:
    """A file of an export: its path inside the export and its bytes in pieces."""

    path: str
    pieces: Iterator[bytes]


@dataclass
class Contents:
    """The members of one export; iterate once, since `files` and `sessions` fill up meanwhile.

    `only`: leave out all other sessions, as for a participant's own copy. `movement`: include the
    frames of every session, which are nearly all of an export's size, and its receipt, which takes
    about a second because it reads every frame. For sessions in `hidden`, nothing that reveals
    their condition is written, whoever the copy is for; `revealed` are open sessions whose
    condition is included because somebody had it shown.
    """

    db: Session
    study_key: str
    kind: Kind
    now: datetime
    only: frozenset[str] | None = None
    movement: bool = True
    files: list[FileCount] = field(default_factory=list)
    sessions: int = 0
    audit_head: TrailHead = field(init=False)
    hidden: frozenset[str] = field(init=False)
    revealed: frozenset[str] = field(default=frozenset(), init=False)
    _contexts: Contexts = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        self.audit_head = head_of(self.db)
        self.hidden = hidden_sessions(self.db, study_by_key(self.db, self.study_key))

    def members(self) -> Iterator[Member]:
        """Yield tables, codebook, each session's frames and receipt, and last the README.

        Each member must be read to its end before the next: a receipt counts what was written.
        """
        sessions = self._table("sessions", sessions_table)
        self.sessions = len(sessions)
        study = study_by_key(self.db, self.study_key)
        used = {int(number) for number in sessions["study_version"].dropna()}
        rules = has_rules(self.db, study, used)
        self.revealed = revealed_sessions(self.db, study) & frozenset(sessions["session_id"])
        for name, table in TABLE_FILES.items():
            frame = sessions if name == "sessions" else self._table(name, table)
            yield self._member(f"{name}.csv", csv_pieces(name, frame, rules=rules))
        yield from self._wide()
        for name, equipment in EQUIPMENT_FILES.items():
            yield self._member(f"{name}.csv", csv_pieces(name, equipment(self.db)))
        described = codebook_frame(rules=rules)
        yield self._member("codebook.csv", csv_pieces("codebook", described))
        # The protocol names the conditions, and a participant's own copy has only sessions.
        if not self.hidden and self.only is None:
            for name, text in self._protocol(study, used).items():
                yield self._member(f"protocol/{name}", iter([text.encode()]))
        rows = sessions[["participant_code", "session_id", "simulated", "avatar"]]
        for code, session_id, simulated, avatar in rows.itertuples(index=False, name=None):
            if self.movement:
                yield from self._movement(code, session_id, bool(simulated), avatar)
        # Imported answers stay apart from the tables; a participant's own copy has only sessions.
        if self.kind in ("people", "all") and self.only is None:
            for name, body in import_files(self.db, study):
                yield self._member(f"imported/{name}", iter([body]))
        yield Member(README, iter([self._readme(study, used, sessions, rules=rules).encode()]))

    def _movement(
        self,
        code: str,
        session_id: str,
        simulated: bool,  # noqa: FBT001 - a column of the table
        avatar: str,
    ) -> Iterator[Member]:
        """Yield what was recorded of a session's movement, and the receipt of the session.

        The movement is the participant's and that of others.
        """
        samples = SampleFile(
            *(self.db, session_id, simulated, avatar), blinded=session_id in self.hidden
        )
        yield self._member(samples_path(code, session_id), samples.pieces())
        if self._has_fingers(session_id):
            fingers = replace(samples, fingers=True)
            yield self._member(fingers_path(code, session_id), fingers.pieces())
        if has_tracker_samples(self.db, session_id):
            sent = tracker_samples(self.db, session_id, simulated=simulated, avatar=avatar)
            pieces = csv_pieces_of_many("trackers", sent)
            yield self._member(trackers_path(code, session_id), pieces)
        if has_companion_frames(self.db, session_id):
            poses = companion_frames(self.db, session_id, simulated=simulated, avatar=avatar)
            pieces = csv_pieces_of_many("companions", poses)
            yield self._member(companions_path(code, session_id), pieces)
        # It has where the avatar was: see `blinding`.
        shown = () if session_id in self.hidden else road_records(self.db, session_id)
        for phase_id, part, record in shown:
            yield self._member(road_path(code, session_id, phase_id, part), iter([record]))
        receipt = self._receipt(session_id, samples.tallies)
        yield self._member(receipt_path(code, session_id), receipt)

    def _table(
        self, name: str, table: Callable[[Session, str, Kind], pd.DataFrame]
    ) -> pd.DataFrame:
        # Tables are joined with the same sessions and phases. Not around `members`: a generator may
        # be continued in another thread, where it would not find what is shared.
        with shared_contexts(self._contexts):
            frame = table(self.db, self.study_key, self.kind)
        own = frame if self.only is None else frame[frame["session_id"].isin(list(self.only))]
        return without_conditions(name, own, self.hidden)

    def _wide(self) -> Iterator[Member]:
        """Yield the tested values in wide form, with what each column means.

        Only for a whole kind: people and simulated ones are never in one analysis.
        """
        if self.kind == "all" or self.only is not None:
            return
        with shared_contexts(self._contexts):
            wide = wide_table(self.db, self.study_key, self.kind)
        rows = wide.frame[wide.names].itertuples(index=False, name=None)
        yield self._member("wide.csv", plain_pieces(wide.names, rows))
        names = [one.name for one in fields(WideColumn)]
        described = pd.DataFrame(map(astuple, wide.columns), columns=names)
        yield self._member("wide_columns.csv", csv_pieces("wide_columns", described))

    def _protocol(self, study: Study, used: set[int]) -> dict[str, str]:
        """Return the files of each version in use, and of its instruments: wording and formulas."""
        files = {}
        for version in self._versions(study, used):
            files[f"{study.key}_version_{version.number}.yaml"] = version.source_yaml
            for key, hash_ in sorted(version.instruments.items()):
                source = instrument_for(self.db, version, key).source_yaml
                files[f"instrument_{key}_{hash_[:8]}.yaml"] = source
        return files

    def _versions(self, study: Study, used: set[int]) -> Sequence[StudyVersion]:
        """Return the versions that the sessions use, or all if there is no session."""
        rows = self.db.scalars(
            select(StudyVersion)
            .where(StudyVersion.study_id == study.id)
            .order_by(StudyVersion.number)
        ).all()
        return [row for row in rows if not used or row.number in used]

    def _has_fingers(self, session_id: str) -> bool:
        return any(epochs_of(self.db, session_id, stream) for stream in FINGER_STREAMS)

    def _receipt(self, session_id: str, tallies: Tallies) -> Iterator[bytes]:
        """Yield the receipt of a session as JSON, computed in the transaction of this export."""
        receipt = receipt_of(
            self.db, session_id, blinded=session_id in self.hidden, tallies=tallies
        )
        yield json.dumps(receipt.as_json(), indent=2).encode() + b"\n"

    def _member(self, path: str, pieces: Iterator[bytes]) -> Member:
        return Member(path, self._counted(path, pieces))

    def _counted(self, path: str, pieces: Iterator[bytes]) -> Iterator[bytes]:
        """Yield the given pieces, then add the file's line count and hash to `files`."""
        digest, lines = hashlib.sha256(), 0
        for piece in pieces:
            digest.update(piece)
            lines += piece.count(b"\n")
            yield piece
        self.files.append(FileCount(path, lines, digest.hexdigest()))

    def _readme(self, study: Study, used: set[int], sessions: pd.DataFrame, *, rules: bool) -> str:
        hashes = {row.number: row.content_hash for row in self._versions(study, used)}
        statuses = {str(key): int(n) for key, n in sessions["status"].value_counts().items()}
        blinded = int(sessions["session_id"].isin(list(self.hidden)).sum())
        origin = Origin(
            study_key=self.study_key,
            kind=self.kind,
            now=self.now,
            audit_head=self.audit_head,
            versions=hashes,
            statuses=statuses,
            not_valid=n_not_valid(sessions),
            blinded=blinded,
        )
        return readme_text(origin, self.files, rules=rules)
