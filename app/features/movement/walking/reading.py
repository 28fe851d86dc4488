"""Read walks from stored tables and captures, or synthesise them; runs in the worker process."""

import io
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from sqlalchemy import make_url
from sqlalchemy.orm import Session

from app.adapters.captures import CaptureError, Limits, Reading, read_capture
from app.adapters.walks import load_scene
from app.adapters.walks.track_table import TrackReading, TrackTable, read_track_table
from app.database import make_engine
from app.features.movement.files import plain_pieces
from app.features.movement.walking.sources import (
    LABORATORY,
    Cannot,
    CapturedWalk,
    PopulationSource,
    Store,
    TrackSource,
    WalkSource,
)
from app.protocol import ConfigError
from app.science.rig import RigError
from app.science.walking.planning import WalkedScenes
from app.science.walking.recording import (
    LeftOut,
    Recorded,
    TrackingOptions,
    Walker,
    entry_of,
    extent_of,
    track_of_motion,
    walks_of,
)
from app.science.walking.records import OPEN_FLOOR, PlannedWalk, Track, Walk, WalkingError
from app.science.walking.scene import Scene
from app.science.walking.synthetic import POPULATIONS, Sample, laboratory_scenes, synthetic_walks

MAX_WALKS = 5000
_REMEDY = "Choose the scene in which these walks took place, or none."


def content_of(store: Store, content_hash: str) -> bytes:
    """Return a stored file; raise Cannot if it was deleted."""
    pooled = make_url(store.url).get_backend_name() != "sqlite"
    engine = make_engine(store.url, pooled=pooled)
    try:
        with Session(engine) as db:
            data = b"".join(plain_pieces(db, content_hash))
    finally:
        engine.dispose()
    if not data:
        raise Cannot("the file is no longer stored", "Upload the walks again.")
    return data


def scene_of(text: str) -> Scene:
    """Parse a scene, which was validated when it was uploaded; raise Cannot."""
    try:
        return load_scene(text)
    except ConfigError as error:
        raise Cannot(f"the scene cannot be read: {error}", "Correct the scene's file.") from None


def scenes_of(source: TrackSource, usual: str | None) -> WalkedScenes:
    """Return the scenes of a table; `usual` is the text of the scene of tracks that name none.

    Raises:
        Cannot: a scene cannot be read.
    """
    scenes = {key: scene_of(text) for key, text in source.scenes}
    if usual is None:
        return WalkedScenes(scenes)
    scene = scene_of(usual)
    return WalkedScenes({**scenes, scene.name: scene}, scene.name)


def planned_walks(store: Store, source: WalkSource, scene: str | None) -> list[PlannedWalk]:
    """Return all walks of a source with the paths planned for them; raise Cannot."""
    try:
        if isinstance(source, PopulationSource):
            return _synthetic(source)
        tracks = tracks_of(content_of(store, source.content_hash), source)
        return planned(walks_in(tracks), scenes_of(source, scene))
    except WalkingError as error:
        raise Cannot(str(error)) from None


def tracks_of(data: bytes, source: TrackSource) -> list[Track]:
    """Return the tracks of a table; raise Cannot with the line."""
    return table_of(data, source).tracks


def table_of(data: bytes, source: TrackSource) -> TrackTable:
    """Return the tracks of a table with what was assumed; raise Cannot with the line."""
    reading = TrackReading(
        rate_hz=source.rate_hz,
        metres_per_unit=source.metres_per_unit,
        kind=source.kind,
        numbers=None if source.reads_columns else (),
        scenes=source.reads_columns,
    )
    try:
        found = read_track_table(data, name=source.name, reading=reading)
        subjects, titles = dict(source.subjects), dict(source.titles)
        statures_m, walked_in = dict(source.statures_m), dict(source.walked_in)
        numbers = dict(source.numbers)
        _check_scenes(found, source)
        tracks = []
        for track in found.tracks:
            subject = subjects.get(track.subject, track.subject)
            title = titles.get(track.subject, track.source)
            stature_m = statures_m.get(subject)
            scene = walked_in.get(track.subject, track.scene)
            others = {
                name: np.full(len(track.times_s), number)
                for name, number in numbers.get(track.subject, ())
            }
            own = replace(track, subject=subject, source=title, stature_m=stature_m)
            tracks.append(replace(own, scene=scene, others={**track.others, **others}))
        return replace(found, tracks=tracks)
    except CaptureError as error:
        at = f"line {error.line}: " if error.line else ""
        raise Cannot(f"in {source.name}, {at}{error.reason}", "Correct the table.") from None
    except WalkingError as error:
        raise Cannot(f"in {source.name}: {error}", "Correct the table.") from None


def _check_scenes(table: TrackTable, source: TrackSource) -> None:
    """Raise Cannot if a table names a scene that there is not."""
    known = [key for key, _ in source.scenes]
    for scene, line in table.scenes.items():
        if scene not in known and scene != OPEN_FLOOR:
            raise Cannot(
                f"in {source.name}, line {line}: there is no scene {scene!r}; scenes are"
                f" {', '.join(known) or 'none'}, and {OPEN_FLOOR!r}",
                "Correct the column scene, or add the scene's file first.",
            )


def walks_in(tracks: Sequence[Track]) -> list[Walk]:
    """Return the walks of all tracks; raise Cannot if there are none or too many."""
    walks = [walk for track in tracks for walk in walks_of(track)]
    if not walks:
        raise Cannot(
            f"there are no walks in {len(tracks)} track(s): people stood still,"
            f" {extent_of(tracks)}",
            "A walk must go at least 0.25 m from where it begins, faster than 0.1 m/s: check the "
            "unit of x and y, and the rate.",
        )
    _check_count(len(walks))
    return walks


def planned(walks: Sequence[Walk], scenes: WalkedScenes) -> list[PlannedWalk]:
    """Find the path of each walk in its scene; raise Cannot."""
    entries, recorded = [], Recorded()
    for number, walk in enumerate(walks, start=1):
        name = walk_name(number, walk)
        if objection := recorded.objection(walk, f"walk {number}, of {walk.subject}"):
            raise Cannot(f"{name}: {objection}", "Correct the table, or leave the walk out.")
        try:
            entry = entry_of(walk, scenes.planner_of(walk))
        except WalkingError as error:
            raise Cannot(f"{name}: {error}", _REMEDY) from None
        if isinstance(entry, LeftOut):
            raise Cannot(f"{name}: {entry.reason}", _REMEDY)
        entries.append(entry)
    return entries


def walk_name(number: int, walk: Walk) -> str:
    """Return what a walk is called in messages: its number in its set, its person, its source."""
    where = "" if walk.scene is None else f", in {walk.scene}"
    return f"walk {number}, of {walk.subject} ({walk.source}{where})"


def table_of_captures(store: Store, captures: Sequence[tuple[str, CapturedWalk]]) -> bytes:
    """Return the tracks of captured people as one table, with the names as ids; raise Cannot."""
    text = io.StringIO()
    text.write("id,time_s,x_m,y_m\n")
    for name, capture in captures:
        track = _track_of_capture(store, name, capture)
        rows = zip(track.times_s.tolist(), track.xy_m.tolist(), strict=True)
        text.writelines(f"{name},{time!r},{x!r},{y!r}\n" for time, (x, y) in rows)
    return text.getvalue().encode()


def _track_of_capture(store: Store, name: str, capture: CapturedWalk) -> Track:
    companions = {}
    if capture.companion_name is not None and capture.companion_hash is not None:
        companions = {capture.companion_name: content_of(store, capture.companion_hash)}
    reading = Reading(metres_per_unit=capture.metres_per_unit, up=capture.up, companions=companions)
    try:
        found = read_capture(
            content_of(store, capture.content_hash),
            name=capture.name,
            reading=reading,
            limits=Limits(bytes=capture.max_bytes),
        )
        options = TrackingOptions(body=capture.body)
        return track_of_motion(found.motion, Walker(name, capture.name), options)
    except CaptureError as error:
        raise Cannot(f"in {capture.name}: {error.reason}") from None
    except (WalkingError, RigError) as error:
        raise Cannot(f"in {capture.name}: {error}") from None


def _synthetic(source: PopulationSource) -> list[PlannedWalk]:
    population = next((one for one in POPULATIONS if one.name == source.name), None)
    if population is None:
        names = ", ".join(one.name for one in POPULATIONS)
        raise Cannot(f"there is no population {source.name!r}", f"There are {names}.")
    scenes = laboratory_scenes() if source.scene == LABORATORY else [scene_of(source.scene)]
    paths = sum(len(scene.paths) for scene in scenes)
    if not paths:
        raise Cannot("the scene names no paths to walk", "Add paths to its file.")
    _check_count(paths * source.people * source.repetitions)
    sample = Sample(source.people, source.repetitions, source.seed)
    return list(synthetic_walks(population, scenes, sample))


def _check_count(count: int) -> None:
    if count > MAX_WALKS:
        raise Cannot(
            f"{count} walks are too many for one model",
            f"Take up to {MAX_WALKS}: fewer people, or fewer repetitions.",
        )
