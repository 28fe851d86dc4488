"""Read crossing scenes (YAML or JSON), and make their partners.

All problems of a file are reported together, each with its line.
"""

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from zlib import crc32

import numpy as np
from pydantic import ValidationError

from app.adapters.cosimulation.process_partner import ProcessPartner, ProcessPlan
from app.adapters.cosimulation.sumo_partner import SumoPartner
from app.adapters.walks.model_file import read_model
from app.adapters.walks.track_table import TrackReading, read_track_table
from app.protocol import (
    CarsFile,
    ConfigError,
    ConfigProblem,
    CrossingFile,
    OfStudy,
    PartnerFile,
    PathFile,
    ProcessFile,
    ProcessOfStudy,
    StudyRoad,
    SumoFile,
    WalkerFile,
    WalkerOfStudy,
    explain,
    read_source,
)
from app.science.cosimulation import (
    Cars,
    CosimulationError,
    Lateness,
    Partner,
    RecordedPath,
    Road,
    Walker,
    WalkerPlan,
    departures,
)
from app.science.rotations import FloatArray
from app.science.walking.recording import dependencies_of
from app.science.walking.records import PlannedPath, further_of

SHIPPED = Path(__file__).with_name("scenes")
"""Scenes that are included."""


@dataclass(frozen=True)
class CrossingScene:
    """A scene file that was read.

    Attributes:
        file: its content.
        folder: which other files it names are relative to.
        sha256: of its content, whatever its layout and comments.
    """

    file: CrossingFile
    folder: Path
    sha256: str

    @property
    def road(self) -> Road:
        """The road."""
        return self.file.road.road()


def shipped_scenes() -> dict[str, Path]:
    """Return the included scenes' files by their keys."""
    return {path.stem: path for path in sorted(SHIPPED.glob("*.yaml"))}


def load_scene(path: Path) -> CrossingScene:
    """Read a scene file.

    Raises:
        ConfigError: it is invalid; lists every problem with its line.
        OSError: it cannot be opened.
        UnicodeDecodeError: it is no text.
    """
    source = read_source(path.read_text(encoding="utf-8-sig"))
    if not isinstance(source.tree, dict):
        remedy = "Begin with lines like key: my-road."
        problem = ConfigProblem("", 1, 1, "The file is not a mapping.", remedy=remedy)
        raise ConfigError([*source.problems, problem])
    try:
        # Validated as JSON, so that lists may become tuples but nothing else is converted.
        file = CrossingFile.model_validate_json(json.dumps(source.tree))
    except ValidationError as error:
        found = explain(error, CrossingFile.model_json_schema(), source)
        raise ConfigError([*source.problems, *found]) from error
    if source.problems:
        raise ConfigError(list(source.problems))
    digest = hashlib.sha256(file.model_dump_json().encode()).hexdigest()
    return CrossingScene(file, path.parent, digest)


Made = list[tuple[Partner, Lateness]]


@dataclass(frozen=True)
class _Setting:
    """What all partners of a scene share."""

    road: Road
    step_s: float
    folder: Path
    seed: int
    is_over: Callable[[], bool] = lambda: False


@contextmanager
def partners_of(scene: CrossingScene, seed: int) -> Iterator[tuple[Made, list[str]]]:
    """Make a scene's partners in its order, and end them afterwards.

    Yields:
        The partners, each with what is done when it is late; and what the user has to start: a
        sentence for each process that the scene does not start itself.

    Raises:
        CosimulationError: a partner cannot be made; the message says why and what to do.
        OSError: a file cannot be opened.
    """
    setting = _Setting(scene.road, scene.file.step_s, scene.folder, seed)
    with _made(scene.file.partners, setting) as made:
        yield made


@contextmanager
def partners_of_study(
    road: StudyRoad, seed: int, is_over: Callable[[], bool]
) -> Iterator[tuple[Made, list[str]]]:
    """Make the partners of a study's road, without the participant; see `partners_of`.

    Once `is_over` is true, the scene waits no longer for one that is not there yet.
    """
    setting = _Setting(road.road.road(), road.step_s, Path(), seed, is_over)
    with _made(road.partners, setting) as made:
        yield made


@contextmanager
def _made(
    partners: Sequence[PartnerFile | OfStudy], setting: _Setting
) -> Iterator[tuple[Made, list[str]]]:
    with ExitStack() as closing:
        made: Made = []
        to_start: list[str] = []
        for one in partners:
            partner = _partner(one, setting)
            if isinstance(partner, ProcessPartner | SumoPartner):
                closing.callback(partner.close)
            if isinstance(partner, ProcessPartner) and not partner.is_started_by_us:
                to_start.append(f"waiting for {one.name!r} to connect to {partner.address}")
            made.append((partner, one.late.lateness()))
        yield made, to_start


def _partner(one: PartnerFile | OfStudy, setting: _Setting) -> Partner:
    step_s, road, seed = one.step_s or setting.step_s, setting.road, setting.seed
    # Each partner has its own numbers, whatever others draw.
    rng = np.random.default_rng((seed, crc32(one.name.encode())))
    match one:
        case WalkerOfStudy():
            return Walker(one.name, step_s, _plan(one, setting.folder, rng), road)
        case PathFile():
            return RecordedPath(one.name, step_s, *_recorded(one, setting.folder))
        case CarsFile():
            plan = departures(one.name, tuple(flow.flow() for flow in one.flows), rng)
            return Cars(one.name, step_s, road, plan, one.driver())
        case SumoFile():
            plan = departures(one.name, tuple(flow.flow() for flow in one.flows), rng)
            return SumoPartner(one.name, step_s, road, plan, seed)
        case ProcessOfStudy():
            reached = ProcessPlan(one.name, step_s, (), one.port, one.connect_s)
            return ProcessPartner(reached, road, seed, setting.is_over)
        case ProcessFile():
            own = (one.command, one.port, one.connect_s, setting.folder)
            return ProcessPartner(ProcessPlan(one.name, step_s, *own), road, seed)


def _plan(one: WalkerOfStudy, folder: Path, rng: np.random.Generator) -> WalkerPlan:
    path = PlannedPath(np.array(one.path, dtype=np.float64))
    vector = np.array([one.velocity_m_s, one.acceleration_m_s2, one.angular_per_m])
    if isinstance(one, WalkerFile) and one.model is not None:
        fit, _, _ = read_model(folder / one.model)
        if further := further_of(fit.database.names):
            raise CosimulationError(
                f"The model {one.model} of {one.name!r} depends on {', '.join(further)}, which a"
                " scene does not say of its walkers. Fit a model without --depends-on."
            )
        vector = fit.named("prob").vectors(dependencies_of(path, one.stature_m), 1, rng)[0]
    looking = (one.leaves_s, one.waits_m, one.looks_s, one.accepts_s)
    return WalkerPlan(path, vector, *looking)


def _recorded(one: PathFile, folder: Path) -> tuple[FloatArray, FloatArray]:
    if (one.file is None) == (not one.points):
        raise CosimulationError(f"The path of {one.name!r} needs either points or a file.")
    if one.file is None:
        points = np.array(one.points, dtype=np.float64)
        return points[:, 0], points[:, 1:]
    path = folder / one.file
    reading = TrackReading(scenes=False)
    table = read_track_table(path.read_bytes(), name=path.name, reading=reading)
    if len(table.tracks) != 1:
        raise CosimulationError(f"{path} has the tracks of {len(table.tracks)} people; give one.")
    return table.tracks[0].times_s, table.tracks[0].xy_m
