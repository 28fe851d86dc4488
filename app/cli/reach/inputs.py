"""Read the inputs of `reembody reach`: hands in captures, and whose they are."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

from app.adapters.captures import CaptureError, read_capture_file
from app.adapters.session_samples import HANDS, is_session_samples, read_session_samples
from app.cli.people_list import (
    file_named,
    labels_of,
    matching,
    read_list,
    require_matched,
    set_once,
    some_of,
)
from app.science.reaching import (
    HandTrack,
    NoReach,
    Reach,
    Reacher,
    ReachingError,
    ReachRules,
    hand_tracks,
    reaches_of,
)
from app.science.retargeting import propose_joint_map
from app.science.rig import RigError, RigMotion

_UXF_SESSION = re.compile(r"S\d{3,}")
_BOXES = (
    "at boxes a hand goes out, along and in, and what is found are parts of its way, quicker than"
    " the whole; use phases in which hands reach freely"
)


@dataclass(frozen=True)
class HandsOrder:
    """The recordings to learn from.

    Attributes:
        files: captures.
        people: table that says whose they are.
        hand: the name of the hand in them, None to find hands by their names.
        synthetic: whether a program moved the hands.
    """

    files: tuple[Path, ...]
    people: Path | None = None
    hand: str | None = None
    synthetic: bool = False


@dataclass(frozen=True)
class _Row:
    """What the table of people says of a recording."""

    subject: str
    width_m: float | None
    stature_m: float | None
    at: str


@dataclass(frozen=True, eq=False)
class RecordedReaches:
    """The reaches of some recordings.

    Attributes:
        reaches: in the order of the files.
        left_out: movements that are no reaches.
        named_by_file: people who are only known by the names of their files or folders.
        notices: recordings that were given twice, in which no hand moves, or that are doubtful.
    """

    reaches: list[Reach] = field(default_factory=list)
    left_out: list[NoReach] = field(default_factory=list)
    named_by_file: set[str] = field(default_factory=set)
    notices: list[str] = field(default_factory=list)


def read_reaches(order: HandsOrder, rules: ReachRules) -> RecordedReaches:
    """Read all reaches of some recordings.

    Raises:
        ValueError: a file cannot be used, or the table of people names none of them.
        OSError: a file cannot be opened.
    """
    people = {} if order.people is None else _read_people(order.people)
    found, known = RecordedReaches(), set[bytes]()
    labels = labels_of(order.files)
    rows = {path: next(iter(matching(path, people)), None) for path in order.files}
    if people and not any(rows.values()):
        raise ValueError(
            f"{order.people} lists {some_of(sorted(people))}, none of which is among the"
            " recordings: give the files' names as they end, as in P7/right.csv."
        )
    without = [labels[path] for path, key in rows.items() if key is None]
    found.notices.extend(
        require_matched({name: row.at for name, row in people.items()}, order.files, without)
    )
    folders: dict[str, list[Path]] = {}
    for path in order.files:
        key = rows[path]
        who = _reacher(path, labels[path], None if key is None else people[key], order)
        if key is None:
            found.named_by_file.add(who.subject)
            folders.setdefault(who.subject, []).append(_folder_of(path))
        if is_session_samples(path):
            tracks = _hands_of_session(path, who, None if key is None else people[key].stature_m)
            found.notices.append(f"{who.source}: {_BOXES}")
        else:
            tracks = _hands(path, who, order.hand)
        if not tracks:
            found.notices.append(f"{who.source}: no hand moves")
        for track in tracks:
            content = track.positions_m.tobytes() + track.times_s.tobytes()
            if content in known:
                found.notices.append(f"{track.name}: given before, sample for sample; left out")
                continue
            known.add(content)
            reaches, left_out = reaches_of(track, rules)
            found.reaches.extend(reaches)
            found.left_out.extend(left_out)
    found.notices.extend(_same_codes(folders))
    return found


def _folder_of(path: Path) -> Path:
    """Return the folder that tells people of one name apart: a person's of UXF, or the file's."""
    uxf = [at for at, part in enumerate(path.parts[:-1]) if _UXF_SESSION.fullmatch(part) and at > 0]
    return Path(*path.parts[: uxf[-1]]) if uxf else path.parent


def _same_codes(folders: dict[str, list[Path]]) -> Iterator[str]:
    """Say which people are in several folders, as in those of two studies, under one code."""
    for subject, found in folders.items():
        places = list(dict.fromkeys(found))
        if len(places) > 1:
            listed = some_of(["/".join(place.parts[-2:]) or "." for place in places])
            yield (
                f"person {subject!r} is in {len(places)} folders ({listed}) and is taken as one"
                " person: if these are different people, say so with --people"
            )


def _hands(path: Path, who: Reacher, hand: str | None) -> list[HandTrack]:
    try:
        motion = read_capture_file(path).motion
        joint_map = propose_joint_map(motion.rig).joint_map if isinstance(motion, RigMotion) else {}
        return hand_tracks(motion, who, joint_map=joint_map, named=hand)
    except (CaptureError, RigError) as error:
        raise ValueError(f"{path}: {error}") from error
    except ReachingError as error:
        raise ValueError(str(error)) from error


def _hands_of_session(path: Path, who: Reacher, stature_m: float | None) -> list[HandTrack]:
    """Return the hands of a session that the product exported, one track for each phase."""
    if stature_m is None:
        raise ValueError(
            f"{path}: an export of samples has rotations, and where hands are depends on the body:"
            " give the person's stature_m in the table of --people."
        )
    session = read_session_samples(path, stature_m)
    if session.simulated:
        who = replace(who, kind="synthetic")
    return [
        HandTrack(phase.times_s, phase.tips_m[:, side], f"phase {phase.phase_id}, {hand}", who,
                  phase.hips_m)
        for phase in session.phases
        for side, hand in enumerate(HANDS)
    ]  # fmt: skip


def _reacher(path: Path, label: str, row: _Row | None, order: HandsOrder) -> Reacher:
    """Return whose recording it is: by the table, by a folder of UXF, or else by its label."""
    parts = path.parts
    uxf = [at for at, part in enumerate(parts[:-1]) if _UXF_SESSION.fullmatch(part) and at > 0]
    source, subject = label, label.removesuffix(path.suffix)
    if uxf:
        # Files of different people and sessions have the same names there.
        begin = max(uxf[-1] - 2, 0)
        source, subject = "/".join(parts[begin:]), parts[uxf[-1] - 1]
    kind: Literal["human", "synthetic"] = "synthetic" if order.synthetic else "human"
    if row is None:
        return Reacher(subject, source, kind)
    return Reacher(row.subject, source, kind, row.width_m)


def _read_people(path: Path) -> dict[str, _Row]:
    """Read a CSV with the columns file, subject and, optionally, width_m and stature_m."""
    rows: dict[str, _Row] = {}
    statures_m: dict[str, float] = {}
    for row in read_list(path, ("file", "subject"), ("width_m", "stature_m")).rows:
        file, subject = file_named(row.cells["file"]), row.cells["subject"]
        if not file or not subject:
            raise ValueError(f"{row.at}: a file or a subject is missing.")
        width_m, stature_m = row.number("width_m"), row.number("stature_m")
        if stature_m is not None:
            if not 0.5 <= stature_m <= 2.6:
                raise ValueError(f"{row.at}: stature_m is {stature_m:g}; give metres, 0.5 to 2.6.")
            set_once(statures_m, subject, stature_m, f"stature_m of {subject!r}", row.at)
        said = _Row(subject, width_m, stature_m, row.at)
        before = rows.setdefault(file, said)
        for name in ("subject", "width_m", "stature_m"):
            old, new = getattr(before, name), getattr(said, name)
            set_once({file: old}, file, new, f"{name} of {file!r}", row.at)
    return rows
