"""The data that the server passes to worker processes: sources of walks, orders and questions.

They are pickled, so they are plain and frozen, and hashable where results are cached by them.
"""

from dataclasses import dataclass
from typing import Literal

from app.science.walking.records import Kind

LABORATORY = "laboratory"
"""Used instead of a scene's text for the paper's sixteen straight and curved walks."""


class Cannot(Exception):
    """Something cannot be parsed, fitted or predicted; raised in a worker process."""

    def __init__(self, reason: str, remedy: str = "") -> None:
        # All arguments are passed on, because errors are pickled by their arguments.
        super().__init__(reason, remedy)
        self.reason, self.remedy = reason, remedy


@dataclass(frozen=True)
class Store:
    """The source of file contents: the database's URL."""

    url: str


@dataclass(frozen=True)
class TrackSource:
    """A table of tracks.

    Attributes:
        name: The file's name.
        content_hash: The hash under which it is stored.
        rate_hz, metres_per_unit: Values that are missing in the table itself.
        kind: Whether people walked, or the walks are synthetic.
        statures_m: Pairs of subject and stature.
        subjects: Pairs of the table's id and the person, for several tracks of one person.
        titles: Pairs of the table's id and the recording that the track comes from.
        scenes: Pairs of key and text of the scenes in which it was walked, or may have been.
        walked_in: Pairs of the table's id and the key of its scene.
        numbers: Pairs of the table's id and its further numbers, as pairs of name and number.
        reads_columns: Whether the table's columns of scenes and further numbers are read.
    """

    name: str
    content_hash: str
    rate_hz: float | None = None
    metres_per_unit: float | None = None
    kind: Kind = "human"
    statures_m: tuple[tuple[str, float], ...] = ()
    subjects: tuple[tuple[str, str], ...] = ()
    titles: tuple[tuple[str, str], ...] = ()
    scenes: tuple[tuple[str, str], ...] = ()
    walked_in: tuple[tuple[str, str], ...] = ()
    numbers: tuple[tuple[str, tuple[tuple[str, float], ...]], ...] = ()
    reads_columns: bool = False


@dataclass(frozen=True)
class PopulationSource:
    """Synthetic walkers.

    Attributes:
        name: The population's name.
        people, repetitions, seed: How many walkers, how often each walks each path, random seed.
        scene: Text of the scene file whose paths they walk, or `LABORATORY`.
    """

    name: str
    people: int
    repetitions: int
    seed: int
    scene: str = LABORATORY


WalkSource = TrackSource | PopulationSource


@dataclass(frozen=True)
class CapturedWalk:
    """A stored capture from which a person's track is cut."""

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
    """A model to fit.

    Attributes:
        source: The walks.
        scene: Text of the scene of tracks that name none, None for the open floor.
        steps: Values of each steering parameter.
        seed, k, entries: As in `FitOptions`.
        reading: How deviations are converted to suitability; "chosen" selects it by left-out
            people.
        depends_on: Names of the further numbers on which the model depends.
    """

    source: WalkSource
    scene: str | None
    steps: int
    seed: int
    k: int
    entries: int
    reading: Literal["chosen", "paper", "time-aware"]
    depends_on: tuple[str, ...] = ()


@dataclass(frozen=True)
class Question:
    """A prediction to compute.

    Attributes:
        scene: Text of the scene; None for the open floor.
        points_m: A path, or its two ends if `planned`.
        planned: Whether the path between the ends is to be planned.
        stature_m: The walker's stature, None for the mean of the model's people.
        count, seed: Draws of P_prob.
        shown: How many of the draws are followed along the path.
        others: Pairs of name and number of the model's further dependencies that are known.
    """

    scene: str | None
    points_m: tuple[tuple[float, float], ...]
    planned: bool
    stature_m: float | None
    count: int
    seed: int
    shown: int
    others: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class SliceQuestion:
    """A slice of the blended map to compute.

    Attributes:
        dependencies: Pairs of name and value.
        held: The parameter that is fixed.
        value: The value at which it is fixed.
    """

    dependencies: tuple[tuple[str, float], ...]
    held: str
    value: float
