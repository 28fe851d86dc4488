"""Replay the events of a trace on an emulated disk and return its states after a power loss."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from app.platform.space_reserve import NAME as RESERVE
from tests.faults.power.files import Choice, Rng, TracedFile
from tests.faults.tracing.events import NEVER, Event

Image = dict[str, bytes]
"""The contents of a folder's files, by path."""
REBUILT = "-shm"
"""The suffix of the file that is rebuilt regardless of its contents."""
MOODS = ("nothing", "everything", "scattered", "most", "few", "later first", "earlier first")
"""The ways in which the disk treats data that were not synced."""


@dataclass
class _Name:
    """The files that a name may refer to: the certain one, if any, then one for each change."""

    certain: TracedFile | None = None
    changes: list[tuple[int, TracedFile | None]] = field(default_factory=list)

    @property
    def now(self) -> TracedFile | None:
        return self.changes[-1][1] if self.changes else self.certain

    def sync(self, began: int) -> None:
        """Mark all changes that were complete before a sync began at `began` as certain."""
        while self.changes and self.changes[0][0] < began:
            self.certain = self.changes.pop(0)[1]

    def could_be(self) -> list[TracedFile | None]:
        return [self.certain, *(file for _, file in self.changes)]


@dataclass
class Disk:
    """An emulated folder that was empty before the trace. Call `replay`, then take images.

    A subfolder exists as soon as it has a file: empty folders do not matter.
    """

    folder: str
    _names: dict[str, _Name] = field(default_factory=dict)

    def begin(self, event: Event) -> None:
        """Apply a call that has begun: from now on it may have taken effect."""
        if Path(event.path).name == RESERVE:
            return  # Reserved space without data: it is never read.
        if event.what in ("write", "truncate"):
            name = self._names.get(event.path)
            # A removed file that is still open does not matter.
            if name is not None and name.now is not None:
                name.now.changes.append(event)
        elif event.what == "create":
            self._name(event.path).changes.append((event.ended, TracedFile()))
        elif event.what == "unlink":
            self._name(event.path).changes.append((event.ended, None))
        elif event.what == "rename":
            moved = self._name(event.path).now
            self._name(event.to_path).changes.append((event.ended, moved))
            self._name(event.path).changes.append((event.ended, None))
        elif event.what == "other":
            raise ValueError(f"{event.call} on {event.path} is not emulated")

    def end(self, event: Event) -> None:
        """Apply a call that has returned: a sync makes earlier completed calls certain."""
        if event.what != "sync":
            return
        synced = self._names.get(event.path)
        if synced is None:
            for path, name in self._names.items():
                if str(Path(path).parent) == event.path:
                    name.sync(event.began)
        elif synced.now is not None:
            synced.now.sync(event.began)

    def certain(self) -> Image:
        """Return only the data that no power loss can remove."""
        return {
            self._in_folder(path): bytes(name.certain.certain)
            for path, name in self._names.items()
            if name.certain is not None and not path.endswith(REBUILT)
        }

    def after_power_loss(self, rng: Rng, mood: str) -> Image:
        """Return one of the many possible states of the disk after a power loss."""
        found: Image = {}
        sector = int(rng.choice((512, 4096)))
        for path, name in sorted(self._names.items()):
            if path.endswith(REBUILT):
                if rng.random() < 0.5:
                    found[self._in_folder(path)] = rng.bytes(32768)
                continue
            versions = name.could_be()
            file = versions[_which(rng, mood, len(versions))]
            if file is not None:
                found[self._in_folder(path)] = _torn(file, sector, rng, mood)
        return found

    def _in_folder(self, path: str) -> str:
        return str(Path(path).relative_to(self.folder))

    def _name(self, path: str) -> _Name:
        return self._names.setdefault(path, _Name())


def _which(rng: Rng, mood: str, count: int) -> int:
    if mood == "nothing":
        return 0
    return count - 1 if mood == "everything" else int(rng.integers(count))


def _torn(file: TracedFile, sector: int, rng: Rng, mood: str) -> bytes:
    sizes = file.sizes()
    noise = rng.random() < 0.5
    fill = rng.bytes(max(sizes)) if noise else bytes(max(sizes))
    choose = _choice(rng, mood, len(file.changes))
    return file.image(sector, choose, _size(sizes, rng, mood), fill)


def _size(sizes: list[int], rng: Rng, mood: str) -> int:
    if mood == "nothing":
        return sizes[0]
    # Data beyond the file's size are not visible, so the largest size is chosen often.
    if mood != "scattered" or rng.random() < 0.5:
        return sizes[-1]
    return sizes[int(rng.integers(len(sizes)))]


def _choice(rng: Rng, mood: str, count: int) -> Choice:
    """Return the function that selects the version of each sector in this mood of the disk."""
    cut = int(rng.integers(count + 1))

    def choose(places: list[int]) -> int:
        latest = len(places)
        match mood:
            case "nothing":
                return 0
            case "everything":
                return latest
            case "most":
                return latest if rng.random() < 0.9 else int(rng.integers(latest + 1))
            case "few":
                return latest if rng.random() < 0.1 else 0
            case "later first":
                return latest if places[-1] >= cut else 0
            case "earlier first":
                return int(np.searchsorted(places, cut))
            case _:
                return int(rng.integers(latest + 1))

    return choose


def timeline(events: Sequence[Event]) -> list[tuple[int, bool, Event]]:
    """Return (stamp, whether it is the return, event) for every successful call, in order."""
    moments = [(event.began, False, event) for event in events if not event.failed]
    moments += [
        (event.ended, True, event) for event in events if not event.failed and event.ended != NEVER
    ]
    return sorted(moments, key=lambda moment: moment[:2])


def replay(disk: Disk, moments: Iterable[tuple[int, bool, Event]]) -> None:
    """Apply a part of a timeline to the disk."""
    for _, returned, event in moments:
        if returned:
            disk.end(event)
        else:
            disk.begin(event)
