"""Parse the head of a Motive CSV: the take's settings, and the meaning of each column."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from app.adapters.captures.capture import CaptureError, Limits

_LABELS = frozenset({"type", "name", "id", "parent"})
_MEASURED = frozenset({"rotation", "position"})
_AXES = frozenset("XYZW")
_MOST_HEAD_ROWS = 24
_MOST_CELLS = 40  # per track; rotation, position and quality of a rigid body take eight
_Row = tuple[int, list[str]]


@dataclass
class Track:
    """A bone, rigid body or marker, and the columns of its numbers by axis."""

    kind: str
    name: str
    parent: str
    place: dict[str, int] = field(default_factory=dict)
    turn: dict[str, int] = field(default_factory=dict)

    @property
    def placed(self) -> bool:
        """Whether the columns of all three coordinates exist."""
        return set(self.place) == set("XYZ")

    @property
    def turned(self) -> bool:
        """Whether the columns of a complete rotation exist: Euler angles or a quaternion."""
        return set(self.turn) in ({*"XYZ"}, {*"XYZW"})


@dataclass(frozen=True)
class Head:
    """The head of a take: its settings by their lower-case keys, and its tracks in file order."""

    settings: Mapping[str, str]
    tracks: tuple[Track, ...]
    line: int

    @property
    def local(self) -> bool:
        """Whether bones are given relative to their parents instead of the world."""
        return self.settings.get("coordinate space", "").lower() == "local"

    def rate(self, key: str) -> float | None:
        """Return a frame rate in Hz; None if it is missing or invalid."""
        try:
            value = float(self.settings.get(key, ""))
        except ValueError:
            return None
        return value if 0.01 <= value <= 1e5 else None


def read_head(rows: Iterator[_Row], limits: Limits) -> Head:
    """Parse the head of a take, up to and including the row that begins with "Frame".

    Raises:
        CaptureError: the row is missing, or columns are not labelled.
    """
    _, first = next(rows, (0, []))
    settings = {
        key.strip().lower(): value.strip()
        for key, value in zip(first[::2], first[1::2], strict=False)
        if key.strip()
    }
    above: list[_Row] = []
    for line, row in rows:
        if row and row[0].strip().lower() == "frame":
            return Head(settings, _tracks(above, row, line, limits), line)
        if len(row) > _MOST_CELLS * limits.tracks:
            raise CaptureError(f"{len(row)} columns are too many.", line=line)
        if any(row):
            above.append((line, row))
        if len(above) > _MOST_HEAD_ROWS:
            break
    raise CaptureError("no row begins with 'Frame': the columns of the take are not named.")


def _tracks(above: list[_Row], axes: list[str], line: int, limits: Limits) -> tuple[Track, ...]:
    kinds, names, whats, parents = _head_rows(above, line)
    tracks: list[Track] = []
    open_track: Track | None = None
    for column in range(2, len(axes)):
        kind, name, what = (_cell(row, column) for row in (kinds, names, whats))
        axis = axes[column].strip().upper()
        if not kind or axis not in _AXES or what.lower() not in _MEASURED:
            continue
        new = open_track is None or (open_track.kind, open_track.name) != (kind, name)
        columns = _columns(open_track, what) if open_track is not None and not new else {}
        if open_track is None or new or axis in columns:
            if len(tracks) == 8 * limits.tracks:
                raise CaptureError(f"more than {8 * limits.tracks} tracks.", line=line)
            open_track = Track(kind, name, _cell(parents, column))
            tracks.append(open_track)
        _columns(open_track, what)[axis] = column
    if not tracks:
        raise CaptureError("no column contains a position or rotation.", line=line)
    return tuple(tracks)


def _columns(track: Track, what: str) -> dict[str, int]:
    return track.turn if what.lower() == "rotation" else track.place


def _head_rows(
    above: list[_Row], line: int
) -> tuple[Sequence[str], Sequence[str], Sequence[str], Sequence[str]]:
    """Find the rows of types, names, kinds and parents: by label, or else by their order."""
    by_label = {_cell(row, 1).lower(): row for _, row in above if _cell(row, 1).lower() in _LABELS}
    if len(above) < 3:
        raise CaptureError(
            f"{len(above)} rows above 'Frame': types, names and kinds of columns are needed.",
            line=line,
        )
    rows = [row for _, row in above]
    return (
        by_label.get("type", rows[0]),
        by_label.get("name", rows[1]),
        rows[-1],
        by_label.get("parent", []),
    )


def _cell(row: Sequence[str], column: int) -> str:
    return row[column].strip() if column < len(row) else ""
