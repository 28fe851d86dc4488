"""Run `reembody pilot power`: simulate and test data sets, in this process or in several."""

import json
import multiprocessing
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from app.cli.errors import require_folder_of
from app.cli.pilot.inputs import StudyFile, read_assumptions, read_study
from app.cli.pilot.record import FORMAT, Record, RecordFile, merged, together
from app.features.results.pilot import (
    Chunk,
    PilotPlan,
    SimulatedStudy,
    chunks_of,
    make_plan,
)
from app.platform.workers import end_with_parent
from app.science.pilot import PowerPoint, Results, power_point, smallest_sufficient

_DEFAULT_SHARES = (0.5, 0.75, 1.0, 1.5, 2.0)
"""Numbers of participants without --participants, as shares of the planned number."""


@dataclass(frozen=True)
class PowerOrder:
    """The options of `pilot power`; `shard` is the number of this part, from 0, and of all."""

    study: str
    assumptions: Path | None
    participants: tuple[int, ...]
    seed: int
    sets: int
    target: float
    workers: int
    shard: tuple[int, int]
    out: Path | None


@dataclass(frozen=True)
class Curve:
    """The power by number of participants, with all that it depends on.

    `unfinished`: chunks of other shards that are not in the record.
    """

    header: Mapping[str, Any]
    points: tuple[PowerPoint, ...]
    unfinished: int


def carry_out_power(order: PowerOrder, now: Callable[[str], None]) -> Curve:
    """Compute a power curve; `now` is told what is being done.

    Raises ValueError if the input does not allow it, OSError if the record cannot be written.
    """
    _check(order)
    require_folder_of(order.out)
    return power_of(read_study(order.study), order, now)


def power_of(file: StudyFile, order: PowerOrder, now: Callable[[str], None]) -> Curve:
    """Compute the power curve of a study that was read; raises the same errors."""
    loaded = read_assumptions(order.assumptions, file)
    protocol = file.study.protocol
    simulated = SimulatedStudy(protocol, loaded.assumptions, file.instruments)
    planned = simulated.declared.planned_n
    wanted = order.participants or tuple(max(2, round(one * planned)) for one in _DEFAULT_SHARES)
    plan = make_plan(protocol, wanted, order.sets, order.seed)
    header = {
        "format": FORMAT,
        "study": protocol.key,
        "sha256": file.study.content_hash,
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
    record = None if order.out is None else RecordFile(order.out, header)
    results: dict[Chunk, Results] = {} if record is None else record.results
    part, parts = order.shard
    own = [chunk for at, chunk in enumerate(chunks_of(plan)) if at % parts == part]
    missing = [chunk for chunk in own if chunk not in results]
    with _computing(order.workers, simulated, plan.seed) as compute:
        for done, (chunk, tested) in enumerate(compute(missing), start=1):
            if record is None:
                results[chunk] = tested
            else:
                record.add(chunk, tested)
            now(f"simulating {protocol.key}: {len(own) - len(missing) + done} of {len(own)} parts")
    return curve_of(Record(header, results))


def carry_out_merge(paths: list[Path]) -> Curve:
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
    return Curve(header, tuple(points), unfinished)


def as_json(curve: Curve) -> str:
    """Return the curve as JSON: the same bytes for the same inputs, however it was computed."""
    header = {
        key: value for key, value in curve.header.items() if key not in ("format", "assumptions")
    }
    return json.dumps(
        {
            "simulated": True,
            **header,
            "smallest_sufficient_n": smallest_sufficient(curve.points, curve.header["target"]),
            "failures": sum(point.failures + point.level_failures for point in curve.points),
            "unfinished": curve.unfinished,
            "power": [asdict(point) for point in curve.points],
            "assumptions": curve.header["assumptions"],
        },
        indent=2,
    )


def _check(order: PowerOrder) -> None:
    if not 1 <= order.workers <= 64:
        raise ValueError(f"--workers {order.workers}: 1 to 64 are valid")
    if not 0.0 < order.target < 1.0:
        raise ValueError(f"--target {order.target:g}: give a power between 0 and 1, as in 0.8")
    if order.shard[1] > 1 and order.out is None:
        raise ValueError("--shard needs --out, the file whose parts `pilot merge` puts together")


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
