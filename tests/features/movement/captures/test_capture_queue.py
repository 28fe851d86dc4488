"""Tests that a file which breaks the reading process is refused, and the next one is read."""

import asyncio
from collections.abc import Callable, Iterator

import pytest

from app.errors import InvalidInput, NotDurable
from app.features.movement.captures import capture_queue
from app.features.movement.captures.capture_queue import CaptureQueue
from app.platform import job_queue as working_line
from app.platform.workers import Worker
from tests.features.movement.captures import hostile

LIMITED = 512 * 2**20


def limit_to_little() -> None:
    """Set the process's usual memory limit to a smaller value."""
    capture_queue.MEMORY_BYTES = LIMITED
    capture_queue.limit_memory()


@pytest.fixture(scope="module")
def bench() -> Iterator[CaptureQueue]:
    """Yield a capture queue whose process has little memory."""
    bench = CaptureQueue(_worker=Worker(limit_to_little))
    yield bench
    bench.stop()


@pytest.mark.parametrize(
    ("task", "why"),
    [
        (hostile.never_end, "longer than"),
        (hostile.fill_the_memory, "memory"),
        (hostile.die, "ended"),
        (hostile.fail, "KeyError"),
    ],
)
def test_a_hostile_file_is_refused_and_the_next_is_read(
    bench: CaptureQueue, task: Callable[[], bytes], why: str
) -> None:
    """A file that blocks, exhausts or kills the process is refused, and the next one is read."""

    async def one_after_the_other() -> bytes:
        # Starting the process takes some seconds, which count towards the limit.
        assert await bench.run(hostile.answer) == b"done"
        bench.within_s = 2.0 if task is hostile.never_end else 120.0
        with pytest.raises(InvalidInput, match=why):
            await bench.run(task)
        bench.within_s = 120.0
        return await bench.run(hostile.answer)

    bench._turn = asyncio.Lock()
    assert asyncio.run(one_after_the_other()) == b"done"


def test_a_full_queue_refuses_further_requests(
    bench: CaptureQueue, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A full capture queue refuses further requests."""
    monkeypatch.setattr(working_line, "WAITING", 2)

    async def crowd() -> list[bytes | BaseException]:
        return await asyncio.gather(
            *(bench.run(hostile.answer) for _ in range(4)), return_exceptions=True
        )

    bench._turn = asyncio.Lock()
    answers = asyncio.run(crowd())
    assert answers[:2] == [b"done", b"done"]
    assert [type(one) for one in answers[2:]] == [NotDurable, NotDurable]


def test_the_cache_of_results_is_bounded(
    bench: CaptureQueue, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The cache of computed results is bounded and evicts the oldest first."""
    monkeypatch.setattr(capture_queue, "MAX_CACHED_BYTES", 10)

    async def ask() -> None:
        for n in (4, 5, 6):
            assert await bench.run_cached(bytes, n) == bytes(n)

    bench._turn = asyncio.Lock()
    asyncio.run(ask())
    assert [len(one) for one in bench._cache.values()] == [6]
