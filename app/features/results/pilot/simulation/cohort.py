"""Simulate the visits of a cohort, in one process or in several.

Every visit follows from the seed and its number alone, so the record is the same bytes however the
work is shared out: its lines stand in the order of the visits' numbers, and a shard has its own.
Times of the machine are not part of it.
"""

import hashlib
import multiprocessing
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from app.features.results.pilot.simulation.cohort_record import (
    FORMAT,
    KIND,
    Header,
    line_of,
    merged,
    open_record,
    plain,
)
from app.features.results.pilot.simulation.plan import (
    PilotStudy,
    Progress,
    Sharing,
    Tell,
    missing_shards,
)
from app.features.results.pilot.simulation.recorded_reaching import reaching_header
from app.platform.workers import end_with_parent
from app.protocol import StudyProtocol
from app.science.reaching import FittedReaching
from app.simulated_people.visits import (
    AvatarKind,
    Visit,
    avatar_kind_of,
    no_pause,
    simulate_visit,
)


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
    def missing(self) -> tuple[str, ...]:
        """The shards that are not here, as in 2/3; empty if what is missing is no whole shard."""
        present = {visit.number for visit in self.visits}
        return missing_shards(int(self.header["participants"]), present)

    @property
    def sha256(self) -> str:
        """The SHA-256 of the header and of all visits, as the record has them."""
        lines = [self.header, *map(plain, self.visits)]
        return hashlib.sha256("".join(map(line_of, lines)).encode()).hexdigest()


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

    Raises the errors of `open_record`.
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
    processor_s = 0.0
    with open_record(record, header, own) as opened:
        done = opened.visits
        missing = own[len(done) :]
        tell(Progress("people", len(done), len(own)))
        cast = _Cast(protocol, order.seed, kind, pause, order.reaching)
        with _computing(sharing.workers, cast) as compute:
            for visit, used_s in compute(missing):
                opened.add(visit)
                processor_s += used_s
                tell(Progress("people", len(done), len(own)))
    simulated_s = sum(visit.simulated_s for visit in done[len(done) - len(missing) :])
    factor = simulated_s / processor_s if missing else None
    return Cohort(header, tuple(done), factor)


def merged_cohort(paths: Sequence[Path]) -> Cohort:
    """Put the records of one cohort together; raises the errors of `cohort_record.merged`."""
    header, visits = merged(paths)
    return Cohort(header, visits, None)


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
