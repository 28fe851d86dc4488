"""Read the walks of `reembody walk` from tracks and captures, each in its scene."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from app.adapters.captures import CaptureError, read_capture_file
from app.adapters.walks.track_table import UNITS_M, TrackReading, TrackTable, read_track_table
from app.cli.people_list import labels_of, require_matched, some_of
from app.cli.walk.people import People
from app.cli.walk.scenes import NamedScenes
from app.science.rig import RigError
from app.science.walking.recording import (
    LeftOut,
    Recorded,
    Walker,
    doubts_about,
    entry_of,
    extent_of,
    rounds_of,
    track_of_motion,
    walks_of,
)
from app.science.walking.records import (
    OPEN_FLOOR,
    Kind,
    PlannedWalk,
    Track,
    WalkingError,
    known_for,
)

MOST_BYTES = 500_000_000
_PERSON_COLUMNS = {"id", "subject", "person", "participant", "ped", "pers_id", "agent"}
_TRACK_COLUMNS = tuple({axis, *(f"{axis}_{unit}" for unit in UNITS_M)} for axis in ("x", "y"))


@dataclass(frozen=True)
class Tables:
    """What tables of tracks do not say themselves.

    Attributes:
        rate_hz: frames a second, for tables whose time is a frame number.
        metres_per_unit: the unit of x and y; None to take it from the columns' names.
        kind: whether people or a program walked; so it is with captures, too.
    """

    rate_hz: float | None = None
    metres_per_unit: float | None = None
    kind: Kind = "human"


def tables_of(rate_hz: float | None, unit: str | None, *, synthetic: bool = False) -> Tables:
    """Return how to read tables; raise ValueError for a rate or a unit that is not valid."""
    if rate_hz is not None and not 1.0 <= rate_hz <= 10_000.0:
        raise ValueError(f"--rate-hz {rate_hz:g}: 1 to 10000 frames a second are valid")
    if unit is not None and unit not in UNITS_M:
        raise ValueError(f"--unit {unit!r}: {', '.join(UNITS_M)} are valid")
    metres_per_unit = None if unit is None else UNITS_M[unit]
    return Tables(rate_hz, metres_per_unit, "synthetic" if synthetic else "human")


@dataclass(frozen=True, eq=False)
class Entries:
    """The walks of some files, each with its path, and the walks that were left out.

    Attributes:
        entries: the walks that are used, in the order of the files.
        names: for each entry, its file, person and number.
        left_out: name and reason of each walk that is not used.
        named_by_file: people who are only known by the name of their file.
        notices: what was assumed about a file, and what makes that doubtful, each with its file.
    """

    entries: list[PlannedWalk] = field(default_factory=list)
    names: list[str] = field(default_factory=list)
    left_out: list[tuple[str, str]] = field(default_factory=list)
    named_by_file: set[str] = field(default_factory=set)
    notices: list[str] = field(default_factory=list)

    @property
    def scenes(self) -> list[str | None]:
        """The key of the scene of each entry, None for the open floor."""
        keys = (entry.walk.scene for entry in self.entries)
        return [None if key == OPEN_FLOOR else key for key in keys]


def read_entries(
    files: Sequence[Path],
    people: People,
    scenes: NamedScenes,
    tables: Tables = Tables(),
    numbers: Sequence[str] = (),
) -> Entries:
    """Read all walks of some files, each with its path in the scene in which it was walked.

    Args:
        files: tables of tracks, and captures.
        people: who walked.
        scenes: the scenes that are named, and that of recordings that name none.
        tables: what tables do not say.
        numbers: the further numbers that each walk needs; a walk without one is left out.

    Raises:
        ValueError: a file cannot be used, or contains no movement from one place to another; no
            walk can be used, because no path connects its ends, say; a number is not known for
            enough walks.
        OSError: a file cannot be opened.
    """
    found, recorded, planners = Entries(), Recorded(), scenes.planned()
    columns: set[str] = set(people.columns)
    labels = labels_of(files)
    read = [(path, _tracks(path, labels[path], people, tables, numbers)) for path in files]
    _announce(scenes, people, read)
    for path, table in read:
        columns |= set(table.columns)
        tracks = [_completed(track, path, people, scenes, table, numbers) for track in table.tracks]
        walks = [walk for track in tracks for walk in walks_of(track)]
        rounds = [walk for track in tracks for walk in rounds_of(track)]
        if not walks and not rounds:
            raise ValueError(f"{path}: {_no_walk(tracks)}")
        found.left_out.extend(_standing(tracks, {walk.subject for walk in (*walks, *rounds)}))
        doubts = doubts_about(walks)
        found.notices.extend(f"{labels[path]}: {text}" for text in (*table.assumed, *doubts))
        if doubts:
            found.notices.append(
                f"{labels[path]}: check the unit of x and y (--unit {', '.join(UNITS_M)})"
                " and the rate"
            )
        counts: Counter[str] = Counter()
        for walk in walks:
            counts[walk.subject] += 1
            name = f"{walk.source}, {walk.subject}, walk {counts[walk.subject]}"
            if objection := recorded.objection(walk, name):
                found.left_out.append((name, objection))
                continue
            try:
                entry = entry_of(walk, planners.planner_of(walk))
            except WalkingError as error:
                found.left_out.append((name, str(error)))
                continue
            if isinstance(entry, LeftOut):
                found.left_out.append((name, entry.reason))
            else:
                found.entries.append(entry)
                found.names.append(name)
                own = labels[path].removesuffix(path.suffix)
                if walk.subject == own and people.subject_of(path) is None:
                    found.named_by_file.add(walk.subject)
        found.left_out.extend(
            (
                f"{walk.source}, {walk.subject}, round {number}",
                f"it goes {walk.length_m:.2f} m and ends within 0.25 m of its start",
            )
            for number, walk in enumerate(rounds, start=1)
        )
    _require_known_people(people, found)
    found.notices.extend(_about_rows(people, read, labels))
    if not found.entries:
        listed = "; ".join(f"{name}: {reason}" for name, reason in found.left_out)
        raise ValueError(f"no walk can be used. {listed}.")
    _require_columns(numbers, columns)
    return _with_numbers(found, numbers)


def _completed(
    track: Track,
    path: Path,
    people: People,
    scenes: NamedScenes,
    table: TrackTable,
    numbers: Sequence[str],
) -> Track:
    """Return a track with the scene and the further numbers of its recording.

    What the table itself says of a row counts before what the list of people says of its file.
    """
    if track.scene is None:
        scene = people.scene_of(path, track.subject, scenes) or scenes.usual
    else:
        at = f"{path}, line {table.scenes[track.scene]}"
        scene = scenes.find(track.scene, path.parent, at)
    others = {name: track.others[name] for name in numbers if name in track.others}
    for name in numbers:
        given = people.number_of(name, path, track.subject)
        if name not in others and given is not None:
            others[name] = np.full(len(track.times_s), given)
    return replace(track, scene=scene, others=others)


def _require_columns(numbers: Sequence[str], columns: set[str]) -> None:
    missing = [name for name in numbers if name not in columns]
    if missing:
        others = ", ".join(sorted(columns)) or "none"
        raise ValueError(
            f"there is no column {', '.join(missing)}, neither in --people nor in a table of"
            f" tracks; columns that a model could depend on are {others}"
        )


def _with_numbers(found: Entries, numbers: Sequence[str]) -> Entries:
    """Leave out the walks that lack one of the numbers; raise WalkingError if they are too many."""
    without = known_for(found.entries, numbers)
    return replace(
        found,
        entries=[one for at, one in enumerate(found.entries) if at not in without],
        names=[one for at, one in enumerate(found.names) if at not in without],
        left_out=[
            *found.left_out,
            *((found.names[at], reason) for at, reason in without.items()),
        ],
    )


_WALK = "a walk ends 0.25 m or farther from its start and is faster than 0.1 m/s"
_IF_NOT_SO = "if that is not so, check the units of x, y and time, and the rate"


def _no_walk(tracks: Sequence[Track]) -> str:
    return (
        f"it contains no walk; {_WALK}. As it was read, people stood still, {extent_of(tracks)}:"
        f" {_IF_NOT_SO}. If it is so, leave the file out."
    )


def _standing(tracks: Sequence[Track], moving: set[str]) -> Iterator[tuple[str, str]]:
    """Return name and reason of each person of a file who goes nowhere in it."""
    standing: dict[str, list[Track]] = {}
    for track in tracks:
        if track.subject not in moving:
            standing.setdefault(track.subject, []).append(track)
    for subject, own in standing.items():
        yield (
            f"{own[0].source}, {subject}",
            f"stood still, {extent_of(own)}; {_WALK}: {_IF_NOT_SO}",
        )


def _require_known_people(people: People, found: Entries) -> None:
    """Raise ValueError if people are listed, but none of them walks: their statures would be lost.

    That happens where files do not name their subject and the list does not name the files.
    """
    walked = sorted({entry.walk.subject for entry in found.entries})
    listed = sorted({*people.statures_m, *(one for own in people.subjects.values() for one in own)})
    if listed and walked and not set(listed) & set(walked):
        raise ValueError(
            f"--people lists {some_of(listed)}, but the walks are of {some_of(walked)}: nobody is"
            " in both. Give the file of each walk in a column `file`, or the same names."
        )


def _announce(scenes: NamedScenes, people: People, read: Sequence[tuple[Path, TrackTable]]) -> None:
    """Read all scenes that are named by their files, so that any row may name them by key."""
    for named in people.scenes.values():
        for name, at in named:
            scenes.announce(name, people.folder, at)
    for path, table in read:
        for name, line in table.scenes.items():
            scenes.announce(name, path.parent, f"{path}, line {line}")
    people.resolve(scenes)


def _about_rows(
    people: People, read: Sequence[tuple[Path, TrackTable]], labels: Mapping[Path, str]
) -> list[str]:
    """Return a notice of each row of the list that is about no recording; raise ValueError."""
    without = [
        labels[path]
        for path, table in read
        if not any(people.mentions(path, track.subject) for track in table.tracks)
    ]
    return require_matched(people.files, [path for path, _ in read], without)


def _tracks(
    path: Path, label: str, people: People, tables: Tables, numbers: Sequence[str]
) -> TrackTable:
    try:
        header = _header(path)
        if all(header & names for names in _TRACK_COLUMNS) or path.suffix.lower() == ".txt":
            return _table(path, label, header, people, tables, numbers)
        subject = people.subject_of(path) or label.removesuffix(path.suffix)
        walker = Walker(subject, label, people.statures_m.get(subject), tables.kind)
        return TrackTable([track_of_motion(read_capture_file(path).motion, walker)], ())
    except (CaptureError, WalkingError, RigError) as error:
        option = " (--rate-hz)" if "frame rate is not specified" in str(error) else ""
        raise ValueError(f"{path}: {error}{option}") from error


def _header(path: Path) -> set[str]:
    """Return the cells of a file's first line in lower case."""
    if path.stat().st_size > MOST_BYTES:
        raise CaptureError(f"larger than {MOST_BYTES} bytes, which is the limit.")
    with path.open("rb") as file:
        first = file.readline(2000).decode("utf-8-sig", errors="replace").lower()
    return {cell.strip().strip('"') for cell in first.replace(";", ",").split(",")}


def _table(
    path: Path,
    label: str,
    header: set[str],
    people: People,
    tables: Tables,
    numbers: Sequence[str],
) -> TrackTable:
    reading = TrackReading(
        rate_hz=tables.rate_hz,
        metres_per_unit=tables.metres_per_unit,
        statures_m=people.statures_m,
        kind=tables.kind,
        numbers=tuple(numbers),
    )
    table = read_track_table(path.read_bytes(), name=label, reading=reading)
    if path.suffix.lower() == ".txt" or header & _PERSON_COLUMNS:
        return table
    # Without a column of people, the file is about one person, named after the file.
    subject = people.subject_of(path) or label.removesuffix(path.suffix)
    stature_m = people.statures_m.get(subject)
    own = [replace(track, subject=subject, stature_m=stature_m) for track in table.tracks]
    return replace(table, tracks=own)
