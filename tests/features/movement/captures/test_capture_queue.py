"""Whatever a file does to the process that reads it, it is refused, and the next one is read."""

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
    """The process's own limit, but with less to take."""
    capture_queue.MEMORY_BYTES = LIMITED
    capture_queue.limit_memory()


@pytest.fixture(scope="module")
def bench() -> Iterator[CaptureQueue]:
    """A process with a small memory."""
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
def test_a_hostile_file_hurts_nobody(
    bench: CaptureQueue, task: Callable[[], bytes], why: str
) -> None:
    """It is refused with the reason, and the next file is read by a process that works."""

    async def one_after_the_other() -> bytes:
        # The process takes some seconds to start, which counts.
        assert await bench.run(hostile.answer) == b"done"
        bench.within_s = 2.0 if task is hostile.never_end else 120.0
        with pytest.raises(InvalidInput, match=why):
            await bench.run(task)
        bench.within_s = 120.0
        return await bench.run(hostile.answer)

    bench._turn = asyncio.Lock()
    assert asyncio.run(one_after_the_other()) == b"done"


def test_whoever_waits_too_long_a_line_is_told(
    bench: CaptureQueue, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Rather than to fill the server with requests that wait."""
    monkeypatch.setattr(working_line, "WAITING", 2)

    async def crowd() -> list[bytes | BaseException]:
        return await asyncio.gather(
            *(bench.run(hostile.answer) for _ in range(4)), return_exceptions=True
        )

    bench._turn = asyncio.Lock()
    answers = asyncio.run(crowd())
    assert answers[:2] == [b"done", b"done"]
    assert [type(one) for one in answers[2:]] == [NotDurable, NotDurable]


def test_what_was_computed_is_kept_within_bounds(
    bench: CaptureQueue, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The oldest go first."""
    monkeypatch.setattr(capture_queue, "MAX_CACHED_BYTES", 10)

    async def ask() -> None:
        for n in (4, 5, 6):
            assert await bench.run_cached(bytes, n) == bytes(n)

    bench._turn = asyncio.Lock()
    asyncio.run(ask())
    assert [len(one) for one in bench._cache.values()] == [6]
