"""Read the inputs of `reembody walk`: walks from tracks and captures, people, scenes."""

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from app.adapters.captures import CaptureError, read_capture_file
from app.adapters.walks import load_scene, load_shipped, shipped_scenes
from app.adapters.walks.track_table import TrackReading, read_tracks
from app.errors import missing_file
from app.protocol import ConfigError
from app.science.rig import RigError
from app.science.walking.planning import LazyThetaPlanner
from app.science.walking.recording import Walker, planned_walk, track_of_motion, walks_of
from app.science.walking.records import PlannedWalk, Planner, Track, Walk, WalkingError
from app.science.walking.scene import Scene, open_scene

MOST_BYTES = 500_000_000
_PERSON_COLUMNS = {"id", "subject", "person", "participant", "ped", "pers_id", "agent"}
_TRACK_COLUMNS = ({"x", "x_m", "x_cm", "x_mm"}, {"y", "y_m", "y_cm", "y_mm"})


@dataclass(frozen=True)
class People:
    """The people who walked.

    Attributes:
        statures_m: stature by subject.
        subjects: subject by file name, for files that do not name one.
    """

    statures_m: dict[str, float] = field(default_factory=dict)
    subjects: dict[str, str] = field(default_factory=dict)


def read_people(path: Path | None) -> People:
    """Read a CSV with the columns subject, stature_m, and optionally file.

    Raises:
        ValueError: a column is missing, or a stature is not a number.
        OSError: it cannot be opened.
    """
    people = People()
    if path is None:
        return people
    reader = csv.DictReader(io.StringIO(path.read_text(encoding="utf-8-sig")))
    if "subject" not in (reader.fieldnames or ()):
        raise ValueError(f"{path}: needs the columns subject, stature_m and, optionally, file.")
    for row in reader:
        subject, stature = (row["subject"] or "").strip(), (row.get("stature_m") or "").strip()
        if stature:
            try:
                people.statures_m[subject] = float(stature)
            except ValueError:
                raise ValueError(
                    f"{path}, line {reader.line_num}: stature_m is {stature!r}, not a number."
                ) from None
        if name := (row.get("file") or "").strip():
            people.subjects[name] = subject
    return people


def read_scene(key: str | None) -> Scene | None:
    """Read a shipped scene by its key, or a scene file; None stands for open floor.

    Raises:
        ValueError: the file is not a valid scene; lists all its problems, each with its line.
        OSError: it cannot be opened.
    """
    if key is None:
        return None
    if key in shipped_scenes():
        return load_shipped(key)
    path = Path(key)
    if not path.exists():
        shipped = ", ".join(shipped_scenes())
        raise ValueError(f"--scene: {missing_file(path)}; shipped with the product are {shipped}.")
    try:
        return load_scene(path.read_text(encoding="utf-8-sig"))
    except ConfigError as error:
        problems = "; ".join(f"line {one.line}: {one.message}" for one in error.problems)
        raise ValueError(f"{path}: {problems}") from error
    except UnicodeDecodeError as error:
        raise ValueError(f"{path}: not UTF-8 text ({error})") from error


def read_walks(files: Sequence[Path], people: People) -> list[Walk]:
    """Read all walks of some files, in their order.

    Raises:
        ValueError: a file cannot be used, or contains no walk.
        OSError: one cannot be opened.
    """
    walks = []
    for path in files:
        found = [walk for track in _tracks(path, people) for walk in walks_of(track)]
        if not found:
            raise ValueError(
                f"{path}: it contains no walk; a walk ends 0.25 m or farther from its start."
            )
        walks += found
    return walks


def planned(walks: Sequence[Walk], scene: Scene | None) -> list[PlannedWalk]:
    """Plan each walk's path, on open floor if there is no scene.

    Raises:
        ValueError: no path connects a walk's ends, or one of them is in an obstacle.
    """
    planner = None if scene is None else LazyThetaPlanner(scene)
    entries = []
    for number, walk in enumerate(walks, start=1):
        used: Planner = planner or LazyThetaPlanner(open_scene(walk.start_m, walk.goal_m))
        try:
            entries.append(planned_walk(walk, used))
        except WalkingError as error:
            raise ValueError(
                f"walk {number}, of {walk.subject} ({walk.source}): {error}"
            ) from error
    return entries


def _tracks(path: Path, people: People) -> list[Track]:
    try:
        header = _header(path)
        if all(header & names for names in _TRACK_COLUMNS) or path.suffix.lower() == ".txt":
            return _table(path, header, people)
        subject = people.subjects.get(path.name, path.stem)
        walker = Walker(subject, path.name, people.statures_m.get(subject))
        return [track_of_motion(read_capture_file(path).motion, walker)]
    except (CaptureError, WalkingError, RigError) as error:
        raise ValueError(f"{path}: {error}") from error


def _header(path: Path) -> set[str]:
    """Return the cells of a file's first line in lower case."""
    if path.stat().st_size > MOST_BYTES:
        raise CaptureError(f"larger than {MOST_BYTES} bytes, which is the limit.")
    with path.open("rb") as file:
        first = file.readline(2000).decode("utf-8-sig", errors="replace").lower()
    return {cell.strip().strip('"') for cell in first.replace(";", ",").split(",")}


def _table(path: Path, header: set[str], people: People) -> list[Track]:
    reading = TrackReading(statures_m=people.statures_m)
    tracks = read_tracks(path.read_bytes(), name=path.name, reading=reading)
    if path.suffix.lower() == ".txt" or header & _PERSON_COLUMNS:
        return tracks
    # Without a column of people, the file is about one person, named after the file.
    subject = people.subjects.get(path.name, path.stem)
    return [replace(tracks[0], subject=subject, stature_m=people.statures_m.get(subject))]
