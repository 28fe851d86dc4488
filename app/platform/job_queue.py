"""A line before a process: one thing is done after the other, each within its time.

Whoever comes when too many wait is told to come again. What was computed is kept for a while, so
that a page which asks again gets it at once.
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
"""The longest that anything may take, unless a line says otherwise."""
WAITING = 20
"""How many may wait for their turn before the next is told to come again."""
P = ParamSpec("P")
T = TypeVar("T")


@dataclass(frozen=True)
class Words:
    """What a line says of the work it is for.

    Attributes:
        busy: why nobody else may wait.
        cannot: what did not go through, before the reason.
        ended: the reason, where the process ended.
        less: what to do where it was too much for the process.
        otherwise: what to do where nobody foresaw it.
        log: what the log says then.
    """

    busy: str
    cannot: str
    ended: str
    less: str
    otherwise: str
    log: str


@dataclass
class WorkingLine(Part, ABC):
    """Has one thing done after the other; `within_s` is the time for each."""

    words: ClassVar[Words]
    fill_the_process: ClassVar[tuple[type[Exception], ...]] = ()
    """Errors after which the process may not have its memory back: it is ended."""

    within_s: float = WITHIN_S
    _worker: Worker = field(default_factory=Worker)
    _turn: asyncio.Lock = field(default_factory=asyncio.Lock)
    _waiting: int = 0
    _kept: "OrderedDict[Hashable, Any]" = field(default_factory=OrderedDict)

    def watched_by(self, background: Background, name: str) -> Self:
        """Have it noticed under a name when its process dies."""
        self._worker.watched_by(background, name)
        return self

    async def run(self, task: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Have a task done.

        Raises InvalidInput where it says that it cannot be, runs out of time or of memory, or
        fails; and NotDurable where too many wait.
        """
        async with self._my_turn():
            return await self._done(task, *args, **kwargs)

    async def computed(self, task: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """The same for what may be kept: the answer depends on nothing but hashable arguments."""
        name = (task, args, tuple(sorted(kwargs.items())))
        if name not in self._kept:
            async with self._my_turn():
                # Whoever was before may have asked for the same.
                if name not in self._kept:
                    self._kept[name] = await self._done(task, *args, **kwargs)
                    while self._keeps_too_much():
                        self._kept.popitem(last=False)
                answer: T = self._kept[name]
                return answer
        self._kept.move_to_end(name)
        kept: T = self._kept[name]
        return kept

    def stop(self) -> None:
        """Let the process go."""
        self._worker.end()

    @abstractmethod
    def _keeps_too_much(self) -> bool:
        """Whether the oldest of what is kept has to go."""

    @abstractmethod
    def _refusal(self, error: Exception) -> InvalidInput | None:
        """What a task told on purpose, for whoever asked; None for any other error."""

    @asynccontextmanager
    async def _my_turn(self) -> AsyncIterator[None]:
        if self._waiting >= WAITING:
            raise NotDurable(
                self.words.busy,
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

    async def _done(self, task: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        future = self._worker.submit(task, *args, **kwargs)
        try:
            return await asyncio.wait_for(asyncio.wrap_future(future), self.within_s)
        except TimeoutError as error:
            await run_sync(self.stop)
            raise self._too_much(f"it takes longer than {self.within_s:g} s") from error
        except self.fill_the_process as error:
            await run_sync(self.stop)
            raise self._too_much("it takes too much memory") from error
        except BrokenProcessPool as error:
            raise self._too_much(self.words.ended) from error
        except Exception as error:
            told = self._refusal(error)
            if told is not None:
                raise told from None
            log.exception(self.words.log)
            raise InvalidInput(
                f"{self.words.cannot}: {type(error).__name__}", remedy=self.words.otherwise
            ) from error

    def _too_much(self, why: str) -> InvalidInput:
        return InvalidInput(f"{self.words.cannot}: {why}", remedy=self.words.less)
