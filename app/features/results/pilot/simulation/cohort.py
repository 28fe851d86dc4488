"""Simulate the visits of a cohort, in one process or in several.

Every visit follows from the seed and its number alone, so the record is the same bytes however the
work is shared out: its lines stand in the order of the visits' numbers, and a shard has its own.
Times of the machine are not part of it.
"""

import hashlib
import json
import multiprocessing
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from app.features.results.pilot.simulation.plan import PilotStudy, Progress, Sharing, Tell
from app.features.results.pilot.simulation.recorded_reaching import reaching_header
from app.platform.workers import end_with_parent
from app.protocol import StudyProtocol
from app.science.reaching import FittedReaching
from app.science.simulation import Build
from app.simulated_people.visits import (
    AvatarKind,
    PhaseOutcome,
    Visit,
    avatar_kind_of,
    no_pause,
    simulate_visit,
)

FORMAT: Final = 1
KIND: Final = "cohort"
Header = Mapping[str, Any]


@dataclass(frozen=True)
class CohortOrder:
    """Who is simulated.

    `avatar` is that of the study if it is None. `reaching`: how people reach, fitted to recordings;
    None for the simulation's constants.
    """

    participants: int
    seed: int
    avatar: AvatarKind | None = None
    reaching: FittedReaching | None = None


@dataclass(frozen=True)
class Cohort:
    """The visits that were simulated, in the order of their numbers.

    `real_time_factor`: seconds of simulated people for each second of this run's processor time;
    None if nothing was left to compute. `unfinished`: visits of other shards that are not here.
    """

    header: Header
    visits: tuple[Visit, ...]
    real_time_factor: float | None

    @property
    def unfinished(self) -> int:
        """The number of visits that are not simulated yet."""
        return int(self.header["participants"]) - len(self.visits)

    @property
    def sha256(self) -> str:
        """The SHA-256 of the header and of all visits, as the record has them."""
        lines = [self.header, *map(_plain, self.visits)]
        return hashlib.sha256("".join(map(_line, lines)).encode()).hexdigest()


def simulate_cohort(
    study: PilotStudy,
    order: CohortOrder,
    tell: Tell,
    *,
    record: Path | None = None,
    sharing: Sharing | None = None,
    pause: Callable[[], None] = no_pause,
) -> Cohort:
    """Simulate a cohort, and continue its record if there is one.

    `pause` is called between frames if there is one worker, and may wait.

    Raises ValueError if the record is of another cohort, OSError if it cannot be written.
    """
    sharing = sharing or Sharing()
    protocol = study.study.protocol
    kind = order.avatar or avatar_kind_of(protocol)
    header = {
        "format": FORMAT,
        "kind": KIND,
        "simulated": True,
        "study": protocol.key,
        "study_sha256": study.study.content_hash,
        "participants": order.participants,
        "seed": order.seed,
        "avatar": kind,
        # Without recordings the record stays what it was, with the hash that it had.
        **({} if order.reaching is None else {"reaching": reaching_header(order.reaching)}),
    }
    part, parts = sharing.shard
    own = range(part, order.participants, parts)
    done = [] if record is None else _continued(record, header, own)
    missing = own[len(done) :]
    processor_s = 0.0
    tell(Progress("people", len(done), len(own)))
    cast = _Cast(protocol, order.seed, kind, pause, order.reaching)
    with _computing(sharing.workers, cast) as compute:
        for visit, used_s in compute(missing):
            done.append(visit)
            processor_s += used_s
            if record is not None:
                with record.open("a", encoding="utf-8") as file:
                    file.write(_line(_plain(visit)))
            tell(Progress("people", len(done), len(own)))
    simulated_s = sum(visit.simulated_s for visit in done[len(done) - len(missing) :])
    factor = simulated_s / processor_s if missing else None
    return Cohort(header, tuple(done), factor)


def merged_cohort(paths: Sequence[Path]) -> Cohort:
    """Put the records of one cohort together; raises ValueError, OSError."""
    visits: dict[int, Visit] = {}
    first: Header | None = None
    for path in paths:
        header, own, _ = _read(path)
        if first is None:
            first = header
        _require_same(first, header, path)
        visits.update({visit.number: visit for visit in own})
    if first is None:
        raise ValueError("give the records to merge, as --out wrote them")
    return Cohort(first, tuple(visits[number] for number in sorted(visits)), None)


def is_cohort(path: Path) -> bool:
    """Return whether a file is the record of a cohort, by its first line; raises OSError."""
    with path.open("rb") as file:
        line = file.readline(10_000)
    try:
        header = json.loads(line)
    except ValueError:
        return False
    return isinstance(header, dict) and header.get("kind") == KIND


def _continued(path: Path, header: Header, own: Sequence[int]) -> list[Visit]:
    """Return the visits that a record has, and begin it if there is none."""
    if path.exists() and path.stat().st_size:
        found, visits, length = _read(path)
        _require_same(header, found, path)
        if [visit.number for visit in visits] != list(own[: len(visits)]):
            raise ValueError(f"{path} is another shard of this cohort; give each a file of its own")
        # What a killed process had begun to write.
        with path.open("r+b") as file:
            file.truncate(length)
        return visits
    # Renamed when it is whole, so that a record never begins in the middle.
    begun = path.with_name(f"{path.name}.begun")
    begun.write_text(_line(header), encoding="utf-8")
    begun.replace(path)
    return []


def _plain(visit: Visit) -> dict[str, Any]:
    """Return a visit as its line has it: reaches are named only if they are of recordings."""
    plain = asdict(visit)
    if visit.reaches is None:
        del plain["reaches"]
    return plain


def _line(one: Mapping[str, Any]) -> str:
    return f"{json.dumps(one)}\n"


def _read(path: Path) -> tuple[Header, list[Visit], int]:
    """Return header and visits of a record, and how many of its bytes are complete lines."""
    whole, _, _ = path.read_bytes().rpartition(b"\n")
    lines = whole.decode("utf-8", errors="replace").split("\n")
    try:
        header = json.loads(lines[0])
        known = isinstance(header, dict) and header.get("kind") == KIND
        known = known and header.get("format") == FORMAT
        visits = [_visit(json.loads(line)) for line in lines[1:]] if known else []
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(f"{path} is no record of a cohort: {error}") from error
    if not known:
        raise ValueError(f"{path} is no record of a cohort; give a file that --out wrote")
    return header, visits, len(whole) + 1


def _visit(one: dict[str, Any]) -> Visit:
    phases = tuple(PhaseOutcome(**phase) for phase in one["phases"])
    changed = {"build": Build(**one["build"]), "order": tuple(one["order"]), "phases": phases}
    if one.get("reaches") is not None:
        drawn, outside = one["reaches"]
        changed["reaches"] = (int(drawn), int(outside))
    return Visit(**{**one, **changed})


def _require_same(header: Header, found: Header, path: Path) -> None:
    differing = sorted(key for key in {*header, *found} if header.get(key) != found.get(key))
    if differing:
        raise ValueError(
            f"{path} is of another cohort: it differs in {', '.join(differing)}. Use the same "
            "study, seed, avatar, number and file of reaching, or another file"
        )


_Compute = Callable[[Sequence[int]], Iterator[tuple[Visit, float]]]


@dataclass(frozen=True)
class _Cast:
    """What every visit of a cohort has in common."""

    study: StudyProtocol
    seed: int
    kind: AvatarKind
    pause: Callable[[], None] = no_pause
    reaching: FittedReaching | None = None

    def visit(self, number: int) -> tuple[Visit, float]:
        """Simulate one visit; return it with the processor time that it took."""
        began_s = time.process_time()
        visit = simulate_visit(self.study, number, self.seed, self.kind, self.pause, self.reaching)
        return visit, time.process_time() - began_s


@contextmanager
def _computing(workers: int, cast: _Cast) -> Iterator[_Compute]:
    if workers == 1:
        yield lambda numbers: map(cast.visit, numbers)
        return
    # Spawned, because a fork would copy the threads of the progress display half.
    context = multiprocessing.get_context("spawn")
    own = _Cast(cast.study, cast.seed, cast.kind, reaching=cast.reaching)
    with ProcessPoolExecutor(
        workers, mp_context=context, initializer=_begin, initargs=(own,)
    ) as pool:
        yield lambda numbers: pool.map(_compute, numbers)
        pool.shutdown(cancel_futures=True)


_own: _Cast | None = None


def _begin(cast: _Cast) -> None:
    global _own
    end_with_parent()
    _own = cast


def _compute(number: int) -> tuple[Visit, float]:
    assert _own is not None  # noqa: S101 - set before the first visit
    return _own.visit(number)
