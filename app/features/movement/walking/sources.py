"""Where walks come from, and what is asked about them, as the processes are told it.

Everything here travels between processes: plain, frozen, hashable where an answer is kept by it.
"""

from dataclasses import dataclass
from typing import Literal

from app.science.walking.records import Kind

LABORATORY = "laboratory"
"""In place of a scene's text: the paper's sixteen straight and curved walks."""


class Cannot(Exception):  # an error is named after what happened
    """Something cannot be read, fitted or answered: the process tells the server why."""

    def __init__(self, reason: str, remedy: str = "") -> None:
        # All of them as they came: errors travel between processes by their arguments.
        super().__init__(reason, remedy)
        self.reason, self.remedy = reason, remedy


@dataclass(frozen=True)
class Store:
    """Where contents are: the address of the database."""

    url: str


@dataclass(frozen=True)
class TrackSource:
    """A table of tracks.

    Attributes:
        name: of the file.
        content_hash: under which it is stored.
        rate_hz, metres_per_unit: what the table does not say.
        kind: whether people walked.
        statures_m: subject and height, in pairs.
        subjects: where one person has several tracks, the table's name and who it is.
        titles: the same, and the recording that it comes from.
    """

    name: str
    content_hash: str
    rate_hz: float | None = None
    metres_per_unit: float | None = None
    kind: Kind = "human"
    statures_m: tuple[tuple[str, float], ...] = ()
    subjects: tuple[tuple[str, str], ...] = ()
    titles: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class PopulationSource:
    """Made-up walkers.

    Attributes:
        name: of the population.
        people, repetitions, seed: whom of it, and how often each walks each path.
        scene: text of the scene file whose paths they walk, or `LABORATORY`.
    """

    name: str
    people: int
    repetitions: int
    seed: int
    scene: str = LABORATORY


WalkSource = TrackSource | PopulationSource


@dataclass(frozen=True)
class CapturedWalk:
    """A stored capture whose person's way is wanted."""

    name: str
    content_hash: str
    companion_name: str | None
    companion_hash: str | None
    metres_per_unit: float | None
    up: Literal["x", "y", "z"] | None
    body: str | None
    max_bytes: int


@dataclass(frozen=True)
class FitOrder:
    """What is to be fitted.

    Attributes:
        source: the walks.
        scene: text of the scene in which tracks were walked, None for the open floor.
        steps: values of each steering parameter.
        seed, k, entries: as in `FitOptions`.
        reading: how maps are read; "chosen" by people left out.
    """

    source: WalkSource
    scene: str | None
    steps: int
    seed: int
    k: int
    entries: int
    reading: Literal["chosen", "paper", "time-aware"]


@dataclass(frozen=True)
class Question:
    """What a model is asked.

    Attributes:
        scene: text of the scene; None for the open floor.
        points_m: a path, or where `planned` its two ends.
        planned: whether the way between them is to be found.
        stature_m: of who walks, None for the mean of the model's people.
        count, seed: draws of P_prob.
        shown: how many of them walk along the path.
    """

    scene: str | None
    points_m: tuple[tuple[float, float], ...]
    planned: bool
    stature_m: float | None
    count: int
    seed: int
    shown: int


@dataclass(frozen=True)
class SliceQuestion:
    """Which slice of the blended map is wanted.

    Attributes:
        dependencies: name and value, in pairs.
        held: the parameter that is held.
        value: where.
    """

    dependencies: tuple[tuple[str, float], ...]
    held: str
    value: float
