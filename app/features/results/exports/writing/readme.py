"""The README file of an export."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from app import __version__
from app.features.people.audit import TrailHead
from app.protocol import UNCOUNTED_KINDS

MARK = "Reembody export"
"""The first line of an export's README, by which a folder is recognised as an export."""

_BROKEN_OFF = (
    "  Redone phases, superseded forms and broken-off sessions are included: use rows with "
    "valid = true.\n"
)
_NOT_VALID = (
    "  So are completed sessions that do not count by the study's valid_when; reasons_not_valid\n"
    "  in sessions.csv says why.\n"
)
_READING = """\
Reading the files
  codebook.csv describes every column: meaning, unit, type and range.
  CSV in UTF-8, lines end with LF, quoted as in RFC 4180. Missing values are empty cells, booleans
  true and false, times UTC in ISO 8601. Numbers stand in full precision.
  Redone phases, superseded forms and broken-off sessions are included: use rows with valid = true.
  A text that a spreadsheet would run as a formula has an apostrophe in front of it.
  wide.csv, where it is there, has one row per participant who counts and one column per score and
  measure, task and condition, with names that JASP and SPSS take: the values that the statistics
  test. wide_columns.csv says what each column is. Use it or the long tables, not both.
  samples/, where movement was asked for, holds one file per session. Target and actual body stand
  side by side, joined on epoch and seq; the cells of a stream are empty where it has no frame.
  Positions in metres (world: x to the right, y up, -z ahead), quaternions w, x, y, z. Frames stand
  as they came: NaN and Infinity are values that were sent, and such rows are flagged.
  fingers/, where it is there, holds the same for the fingers of sessions that recorded them, joined
  on the same epoch and seq. The values of a hand that was not tracked are NaN.
  trackers/, where it is there, holds what the lab's trackers sent for a session and where its
  headset said that the eyes were, one row per pose, in the axes of each source and with three
  times: the source's own, the arrival, and the first on the server's clock.
  tracker_alignments.csv says how these axes lay in the headset's.
  companions/, where it is there, holds the poses in which the participant was shown another person,
  one row per pose while the headset showed them; events.csv says who that was, and where.
  road/, where it is there, holds the record of each run of the study's road as JSON lines: where
  the participant, cars and walkers were every step, and what was guessed. road_crossings.csv has
  the measures.
  receipts/, where movement was asked for, holds one file per session that says how many frames
  were made, stored and are missing, whether the event log was changed, whether the completions
  follow from the contacts, and which latency the avatar really had. "complete": true means that
  nothing is missing.
  protocol/, unless a condition may not be known yet, holds what was done and asked: the study's
  file as each version had it, and its instruments with the wording, the scales and the formulas of
  their scores.
  imported/, where it is there, holds answers that were collected elsewhere: one file per import,
  one row per form, origin = imported. They are in no table; do not pool them with the sessions.
  The hips carry no latency. latency_ms is what was added to the delay of the equipment, which
  calibrations.csv tells as far as it was measured. headset_tests.csv has what headsets measured of
  themselves. Both are of the lab's equipment, not of this study.
  consent_given and consent_at_utc in sessions.csv say that and when consent was given. The signed
  records hold names: they stay with the lab and are in no export.
  Audit head is the newest entry of the lab's audit trail when this was written. The lab proves with
  it that nothing was cut from the trail since: ./run verify --head SEQ:HASH.
"""
_UNCOUNTED = (
    f"  Rows with phase_kind = {' or '.join(UNCOUNTED_KINDS)} come before the blocks: never "
    "analyse them with\n  those of tasks.\n"
)


@dataclass(frozen=True)
class Origin:
    """The origin of an export; `versions` maps version numbers to content hashes.

    `audit_head`: the newest entry of the audit trail at that moment. `not_valid`: how many
    completed sessions do not count by their study's rules. `blinded`: how many sessions are written
    without their condition.
    """

    study_key: str
    kind: str
    now: datetime
    audit_head: TrailHead
    versions: Mapping[int, str]
    statuses: Mapping[str, int]
    not_valid: int = 0
    blinded: int = 0


@dataclass(frozen=True)
class FileCount:
    """The size and hash of a file; `lines` includes the header and line breaks inside quotes."""

    path: str
    lines: int
    sha256: str


def readme_text(origin: Origin, files: Sequence[FileCount], *, rules: bool = True) -> str:
    """Return the README: Reembody's version, study with content hashes, time, kind, counts, files.

    `rules`: some sessions are of a version that has rules for valid sessions.
    """
    reading = _READING.replace(_BROKEN_OFF, _BROKEN_OFF + _NOT_VALID) if rules else _READING
    reading += _UNCOUNTED
    when = origin.now.astimezone(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")
    statuses = ", ".join(f"{count} {status}" for status, count in sorted(origin.statuses.items()))
    head = [
        MARK,
        "",
        f"Reembody version  {__version__}",
        f"Study             {origin.study_key}",
        *(f"  version {number}, content {hash_}" for number, hash_ in origin.versions.items()),
        f"Exported          {when}",
        f"Kind of sessions  {origin.kind}",
        f"Sessions          {sum(origin.statuses.values())}"
        + (f" ({statuses})" if statuses else ""),
        *([f"Not valid         {origin.not_valid} completed"] if origin.not_valid else ()),
        f"Audit head        {origin.audit_head}",
        *_warning(origin.kind),
        *(_blinded(origin.blinded) if origin.blinded else ()),
        "",
    ]
    listing = [
        f"  {file.sha256}  {file.lines:>9}  {file.path}"
        for file in sorted(files, key=lambda file: file.path)
    ]
    return "\n".join([*head, reading, "Files (SHA-256, lines with the header, name)", *listing, ""])


def _blinded(sessions: int) -> list[str]:
    return [
        "",
        f"The study is blinded. Of {sessions} of these sessions nobody may know the condition yet:",
        "their order, condition, latencies and hashes are empty; contacts, completions, joint",
        "errors and the avatar's frames are left out. Export again once the order is known.",
    ]


def _warning(kind: str) -> list[str]:
    match kind:
        case "simulated":
            return ["", "These data come from a simulation. They say nothing about people."]
        case "test":
            return ["", "These are test sessions. They are not results."]
        case "all":
            return [
                "",
                "These files mix kinds of sessions: never analyse them together (column kind).",
            ]
        case _:
            return []
