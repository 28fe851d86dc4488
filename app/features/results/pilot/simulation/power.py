"""Simulate and test data sets by number of participants, in this process or in several."""

import json
import multiprocessing
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, cast

from app.features.results.pilot.order import SETS, TARGET, numbers_around
from app.features.results.pilot.simulation.plan import (
    Chunk,
    PilotPlan,
    PilotStudy,
    Progress,
    Sharing,
    Tell,
    chunks_of,
    make_plan,
    missing_shards,
)
from app.features.results.pilot.simulation.power_record import (
    FORMAT,
    Record,
    RecordFile,
    merged,
    together,
)
from app.features.results.pilot.simulation.simulated_study import SimulatedStudy
from app.platform.workers import end_with_parent
from app.protocol import NO_NAMES, LoadedAssumptions, PrimaryNames, PrimaryTest, primary_names
from app.science.instruments import Instrument
from app.science.pilot import PowerPoint, Results, power_point, smallest_sufficient


@dataclass(frozen=True)
class PowerOrder:
    """What a power run computes.

    Attributes:
        participants: numbers of people who start; empty for numbers around the planned one.
        seed: of all random draws.
        sets: data sets for each number, as many with the effect as without.
        target: the power that is wanted.
    """

    participants: tuple[int, ...] = ()
    seed: int = 1
    sets: int = SETS
    target: float = TARGET


@dataclass(frozen=True)
class Curve:
    """The power by number of participants, with all that it depends on.

    `unfinished`: chunks of other shards that are not in the record. `names`: what the study calls
    what its test names by key; records do not have them. `score_range`:
    the lowest and the highest possible score, if its author states them. `missing`: the shards
    that are not in it, as in 2/3, if whole ones are missing.
    """

    header: Mapping[str, Any]
    points: tuple[PowerPoint, ...]
    unfinished: int
    names: PrimaryNames = NO_NAMES
    score_range: tuple[float, float] | None = None
    missing: tuple[str, ...] = ()


def simulate_power(
    study: PilotStudy,
    loaded: LoadedAssumptions,
    order: PowerOrder,
    tell: Tell,
    *,
    record: Path | None = None,
    sharing: Sharing | None = None,
) -> Curve:
    """Simulate a power curve, and continue its record if there is one.

    Raises PilotError or ValueError if the input does not allow it, OSError if the record cannot be
    written.
    """
    sharing = sharing or Sharing()
    protocol = study.study.protocol
    simulated = SimulatedStudy(protocol, loaded.assumptions, study.instruments)
    planned = simulated.declared.planned_n
    plan = make_plan(
        protocol, order.participants or numbers_around(planned), order.sets, order.seed
    )
    header = {
        "format": FORMAT,
        "study": protocol.key,
        "sha256": study.study.content_hash,
        "assumptions_sha256": loaded.content_hash,
        "participants": list(plan.participants),
        "sets": plan.sets,
        "seed": plan.seed,
        "target": order.target,
        "planned_n": planned,
        "alpha": simulated.declared.alpha,
        "preregistered": protocol.preregistration is not None,
        "test": simulated.declared.primary.model_dump(mode="json"),
        "exclusions": [one.model_dump(mode="json") for one in simulated.declared.exclusions],
        "assumed_difference": simulated.assumed_difference(plan.seed),
        "assumptions": loaded.assumptions.stated(),
    }
    kept = None if record is None else RecordFile(record, header)
    results: dict[Chunk, Results] = {} if kept is None else kept.results
    part, parts = sharing.shard
    own = [chunk for at, chunk in enumerate(chunks_of(plan)) if at % parts == part]
    missing = [chunk for chunk in own if chunk not in results]
    tell(Progress("power", len(own) - len(missing), len(own)))
    with _computing(sharing.workers, simulated, plan.seed) as compute:
        for done, (chunk, tested) in enumerate(compute(missing), start=1):
            if kept is None:
                results[chunk] = tested
            else:
                kept.add(chunk, tested)
            tell(Progress("power", len(own) - len(missing) + done, len(own)))
    names = primary_names(simulated.declared.primary, protocol, study.instruments)
    score_range = _score_range(simulated.declared.primary, study.instruments)
    return replace(curve_of(Record(header, results)), names=names, score_range=score_range)


def _score_range(
    primary: PrimaryTest, instruments: Mapping[str, Instrument]
) -> tuple[float, float] | None:
    instrument = instruments.get(primary.instrument or "")
    for score in () if instrument is None else instrument.scores:
        if score.key == primary.score and None not in (score.minimum, score.maximum):
            return cast("tuple[float, float]", (score.minimum, score.maximum))
    return None


def merged_curve(paths: Sequence[Path]) -> Curve:
    """Put the records of a pilot together; raises ValueError, OSError."""
    return curve_of(merged(paths))


def curve_of(record: Record) -> Curve:
    """Return the curve of all finished chunks; numbers of participants that are unfinished wait."""
    header = record.header
    plan = PilotPlan(tuple(header["participants"]), header["sets"], header["seed"])
    wanted = list(chunks_of(plan))
    points = []
    for n in plan.participants:
        own = [chunk for chunk in wanted if chunk.n == n]
        if any(chunk not in record.results for chunk in own):
            continue
        effect, null = (
            together(record.results[chunk] for chunk in own if chunk.scenario == scenario)
            for scenario in ("effect", "null")
        )
        points.append(power_point(n, effect, null, header["assumed_difference"]))
    unfinished = sum(chunk not in record.results for chunk in wanted)
    present = {at for at, chunk in enumerate(wanted) if chunk in record.results}
    missing = missing_shards(len(wanted), present)
    return Curve(header, tuple(points), unfinished, missing=missing)


def curve_json(curve: Curve) -> str:
    """Return the curve as JSON: the same bytes for the same inputs, however it was computed."""
    return json.dumps(curve_data(curve), indent=2)


def curve_data(curve: Curve) -> dict[str, Any]:
    """Return the curve as plain data, the JSON of `reembody pilot power`."""
    header = {
        key: value for key, value in curve.header.items() if key not in ("format", "assumptions")
    }
    return {
        "simulated": True,
        **header,
        "smallest_sufficient_n": smallest_sufficient(curve.points, curve.header["target"]),
        "failures": sum(point.failures + point.level_failures for point in curve.points),
        "unfinished": curve.unfinished,
        "power": [asdict(point) for point in curve.points],
        "assumptions": curve.header["assumptions"],
    }


@contextmanager
def _computing(
    workers: int, simulated: SimulatedStudy, seed: int
) -> Iterator[Callable[[list[Chunk]], Iterator[tuple[Chunk, Results]]]]:
    if workers == 1:
        yield lambda chunks: ((chunk, simulated.tested(chunk, seed)) for chunk in chunks)
        return
    # Spawned, because a fork would copy the threads of the progress display half.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(
        workers, mp_context=context, initializer=_begin, initargs=(simulated, seed)
    ) as pool:
        yield lambda chunks: zip(chunks, pool.map(_compute, chunks), strict=True)
        pool.shutdown(cancel_futures=True)


_own: tuple[SimulatedStudy, int] | None = None


def _begin(simulated: SimulatedStudy, seed: int) -> None:
    global _own
    end_with_parent()
    _own = (simulated, seed)


def _compute(chunk: Chunk) -> Results:
    assert _own is not None  # noqa: S101 - set before the first chunk
    simulated, seed = _own
    return simulated.tested(chunk, seed)
