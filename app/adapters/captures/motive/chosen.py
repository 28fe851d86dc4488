"""Choose the tracks of a take to read: a skeleton, else rigid bodies, else markers."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from app.adapters.captures.capture import CaptureError, Limits
from app.adapters.captures.motive.head import Head, Track
from app.adapters.captures.motive.hierarchy import asset_of, bone_names, bone_parents


@dataclass(frozen=True)
class Chosen:
    """The tracks to read, and their names.

    Attributes:
        kind: the kind of all the tracks together.
        tracks, names: the tracks and their names, in file order.
        parents: the parents of a skeleton's bones, -1 for the root.
        notes: notes on what was left out.
    """

    kind: Literal["skeleton", "bodies", "markers"]
    tracks: tuple[Track, ...]
    names: tuple[str, ...]
    parents: tuple[int, ...] = ()
    notes: tuple[str, ...] = ()


def choose(head: Head, limits: Limits) -> Chosen:
    """Choose the tracks of the take to read.

    Raises:
        CaptureError: nothing in the file moves, names are duplicated, or there are too many tracks.
    """
    bones = [t for t in head.tracks if t.kind.lower() == "bone" and t.placed and t.turned]
    bodies = [t for t in head.tracks if t.kind.lower() == "rigid body" and t.placed and t.turned]
    if bones:
        chosen = _skeleton(bones, local=head.local)
    elif bodies:
        chosen = Chosen("bodies", tuple(bodies), tuple(body.name for body in bodies))
    else:
        chosen = _markers([t for t in head.tracks if t.placed], head.line)
    if len(chosen.tracks) > limits.tracks:
        raise CaptureError(
            f"{len(chosen.tracks)} tracks, up to {limits.tracks} are read.", line=head.line
        )
    double = [name for name, count in Counter(chosen.names).items() if count > 1]
    if double:
        raise CaptureError(f"{double[0]!r} is the name of two tracks.", line=head.line)
    return _with_rest(chosen, head.tracks)


def _skeleton(bones: Sequence[Track], *, local: bool) -> Chosen:
    """Return the bones of the take's first skeleton."""
    assets = list(dict.fromkeys(asset_of(bone) for bone in bones))
    own = [bone for bone in bones if asset_of(bone) == assets[0]]
    notes = (
        [f"Skeleton {assets[0]!r} was read; also in the take: {', '.join(assets[1:])}."]
        if len(assets) > 1
        else []
    )
    names = bone_names(own)
    parents = bone_parents(own, names)
    if parents is not None:
        return Chosen("skeleton", tuple(own), tuple(names), tuple(parents), tuple(notes))
    if local:
        raise CaptureError(
            "the bones are relative to parents that the file does not name: export again with"
            " Coordinate Space Global, or with Motive 3, which names them."
        )
    notes.append("The file does not tell which bone hangs on which: read as rigid bodies.")
    return Chosen("bodies", tuple(own), tuple(names), (), tuple(notes))


def _markers(placed: Sequence[Track], line: int) -> Chosen:
    markers = [t for t in placed if t.kind.lower() == "marker"] or list(placed)
    labelled = [t for t in markers if not t.name.lower().startswith("unlabeled")] or markers
    if not labelled:
        raise CaptureError("no columns contain a complete position.", line=line)
    short = [marker.name.rpartition(":")[2] for marker in labelled]
    names = short if len(set(short)) == len(short) else [marker.name for marker in labelled]
    return Chosen("markers", tuple(labelled), _numbered(names))


def _numbered(names: Sequence[str]) -> tuple[str, ...]:
    """Number duplicate names: a marker found again after a gap may have the same name."""
    seen: Counter[str] = Counter()
    unique = []
    for name in names:
        seen[name] += 1
        unique.append(name if seen[name] == 1 else f"{name} ({seen[name]})")
    return tuple(unique)


def _with_rest(chosen: Chosen, tracks: Sequence[Track]) -> Chosen:
    chosen_ids = {id(track) for track in chosen.tracks}
    counts = Counter(track.kind.lower() for track in tracks if id(track) not in chosen_ids)
    if not counts:
        return chosen
    listed = ", ".join(f"{count} x {kind}" for kind, count in counts.items())
    return Chosen(
        chosen.kind,
        chosen.tracks,
        chosen.names,
        chosen.parents,
        (*chosen.notes, f"Left out: {listed}."),
    )
