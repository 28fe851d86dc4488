"""Queue jobs for a worker process, which runs one at a time, each with a time limit.

A job that arrives when too many are waiting is refused. Results are cached for a while, so that a
page which repeats a request gets its answer immediately.
"""

import asyncio
import logging
from abc import ABC, abstractmethod
from collections import OrderedDict
from collections.abc import AsyncIterator, Callable, Hashable
from concurrent.futures.process import BrokenProcessPool
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from typing import Any, ClassVar, ParamSpec, Self, TypeVar

from anyio.to_thread import run_sync

from app.errors import InvalidInput, NotDurable
from app.platform.background import Background
from app.platform.context import Part
from app.platform.workers import Worker

log = logging.getLogger(__name__)
WITHIN_S = 120.0
"""The default time limit of a job."""
WAITING = 20
"""Maximum number of waiting jobs; the next is refused."""
P = ParamSpec("P")
T = TypeVar("T")


@dataclass(frozen=True)
class JobMessages:
    """The messages of a queue, worded for the kind of job it runs.

    Attributes:
        busy: why no more jobs may wait.
        cannot: what failed, followed by the reason.
        less: the remedy if the job was too large for the process.
        log: the log message for an unexpected error.
        ended: the reason if the process ended.
        otherwise: the remedy for an unexpected error.
    """

    busy: str
    cannot: str
    less: str
    log: str
    ended: str = "the process that computed it ended"
    otherwise: str = "See the server's log for details."


@dataclass
class JobQueue(Part, ABC):
    """Runs jobs one after the other in a worker process; `within_s` is the time limit of each."""

    messages: ClassVar[JobMessages]
    max_cached: ClassVar[int] = 64
    """Maximum number of cached results."""
    memory_errors: ClassVar[tuple[type[Exception], ...]] = ()
    """Errors after which the process may not have freed its memory: it is restarted."""

    within_s: float = WITHIN_S
    _worker: Worker = field(default_factory=Worker)
    _turn: asyncio.Lock = field(default_factory=asyncio.Lock)
    _waiting: int = 0
    _cache: "OrderedDict[Hashable, Any]" = field(default_factory=OrderedDict)

    def watched_by(self, background: Background, name: str) -> Self:
        """Report the death of the worker process to `background` under a name."""
        self._worker.watched_by(background, name)
        return self

    async def run(self, task: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Run a job and return its result.

        Raises InvalidInput if the job refuses its input, exceeds its time or memory, or fails;
        NotDurable if too many jobs are waiting.
        """
        return await self.run_within(self.within_s, task, *args, **kwargs)

    async def run_within(
        self, within_s: float, task: Callable[P, T], *args: P.args, **kwargs: P.kwargs
    ) -> T:
        """Run a job like `run`, with a shorter time limit of its own."""
        async with self._my_turn():
            return await self._done(within_s, task, *args, **kwargs)

    async def run_cached(self, task: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Run a job with a cached result: it must depend on nothing but its hashable arguments."""
        name = (task, args, tuple(sorted(kwargs.items())))
        if name not in self._cache:
            async with self._my_turn():
                # The preceding job may have computed the same result.
                if name not in self._cache:
                    self._cache[name] = await self._done(self.within_s, task, *args, **kwargs)
                    while self._cache_is_full():
                        self._cache.popitem(last=False)
                answer: T = self._cache[name]
                return answer
        self._cache.move_to_end(name)
        cached: T = self._cache[name]
        return cached

    def stop(self) -> None:
        """End the worker process."""
        self._worker.end()

    def _cache_is_full(self) -> bool:
        """Return whether the oldest cached result has to be evicted."""
        return len(self._cache) > self.max_cached

    @abstractmethod
    def _refusal(self, error: Exception) -> InvalidInput | None:
        """Return the error for the caller if the job raised `error` deliberately, else None."""

    @asynccontextmanager
    async def _my_turn(self) -> AsyncIterator[None]:
        if self._waiting >= WAITING:
            raise NotDurable(
                self.messages.busy,
                value=self._waiting,
                valid=f"up to {WAITING} at once",
                remedy="Try again in a minute.",
            )
        self._waiting += 1
        try:
            async with self._turn:
                yield
        finally:
            self._waiting -= 1

    async def _done(
        self, within_s: float, task: Callable[P, T], *args: P.args, **kwargs: P.kwargs
    ) -> T:
        future = self._worker.submit(task, *args, **kwargs)
        try:
            return await asyncio.wait_for(asyncio.wrap_future(future), within_s)
        except TimeoutError as error:
            await run_sync(self.stop)
            raise self._too_much(f"it took longer than {within_s:g} s") from error
        except self.memory_errors as error:
            await run_sync(self.stop)
            raise self._too_much("it needed too much memory") from error
        except BrokenProcessPool as error:
            raise self._too_much(self.messages.ended) from error
        except Exception as error:
            refusal = self._refusal(error)
            if refusal is not None:
                raise refusal from None
            log.exception(self.messages.log)
            raise InvalidInput(
                f"{self.messages.cannot}: {type(error).__name__}", remedy=self.messages.otherwise
            ) from error

    def _too_much(self, why: str) -> InvalidInput:
        return InvalidInput(f"{self.messages.cannot}: {why}", remedy=self.messages.less)
