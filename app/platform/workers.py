"""Run long computations in a separate process, which ends with the server.

In a thread of the server they would hold up every running session, because Python computes in one
thread at a time. The process has a lower priority than running sessions, and is started with its
first task. A process that has died is replaced at the next task.
"""

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from functools import partial
from typing import ParamSpec, Self, TypeVar

from app.gc_tuning import relax_gc
from app.platform.background import Background

NICENESS = 5
"""The process's niceness, so that running sessions get the processor first."""
P = ParamSpec("P")
T = TypeVar("T")


@dataclass
class Worker:
    """One process that runs one task after the other.

    `prepare` runs in the process before its first task; it and every task must be functions of a
    module, their arguments and results picklable.
    """

    prepare: Callable[[], None] | None = None
    _pool: ProcessPoolExecutor | None = None
    _watched: tuple[Background, str] | None = None
    _lock: threading.RLock = field(default_factory=threading.RLock)

    def watched_by(self, background: Background, name: str) -> Self:
        """Report the process to `background` under a name if it dies without being ended."""
        self._watched = (background, name)
        return self

    def submit(self, task: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> "Future[T]":
        """Queue a task; its future fails with BrokenProcessPool if the process dies."""
        with self._lock:
            if self._pool is None:
                context = multiprocessing.get_context("spawn")
                self._pool = ProcessPoolExecutor(
                    1, mp_context=context, initializer=_begin, initargs=(self.prepare,)
                )
            pool = self._pool
            try:
                future = pool.submit(task, *args, **kwargs)
            except BrokenProcessPool:
                self._forget(pool)
                return self.submit(task, *args, **kwargs)
        future.add_done_callback(lambda done: self._look(pool, done))
        return future

    def end(self) -> None:
        """Kill the process with its current task; the next task gets a new process."""
        self.let_go()()

    def let_go(self) -> Callable[[], None]:
        """Give the next task a new process; return what kills the one until now.

        The tasks of that process fail while it is killed, and whatever waits for their results runs
        meanwhile: call it without holding a lock that this needs.
        """
        with self._lock:
            pool, self._pool = self._pool, None
        return partial(_kill, pool)

    def _look(self, pool: ProcessPoolExecutor, done: "Future[T]") -> None:
        if done.cancelled():
            return
        error = done.exception()
        if isinstance(error, BrokenProcessPool):
            if self._forget(pool) and self._watched is not None:
                background, name = self._watched
                background.failed(name, error)
        elif self._watched is not None:
            # Whatever the outcome of the task, the process works.
            background, name = self._watched
            background.recovered(name)

    def _forget(self, pool: ProcessPoolExecutor) -> bool:
        """Discard a pool whose process has died.

        Return False if it was already discarded, or was ended on purpose.
        """
        with self._lock:
            is_current = self._pool is pool
            if is_current:
                self._pool = None
            return is_current


def _kill(pool: ProcessPoolExecutor | None) -> None:
    if pool is None:
        return
    for process in list((getattr(pool, "_processes", None) or {}).values()):
        # Killed, not terminated: it may be stuck where Python does not handle signals.
        process.kill()
    pool.shutdown(wait=True, cancel_futures=True)


def _begin(prepare: Callable[[], None] | None) -> None:
    end_with_parent()
    # Ctrl-C reaches every process of a terminal, but the server decides when this one ends.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(os, "nice"):
        os.nice(NICENESS)
    relax_gc()
    if prepare is not None:
        prepare()


def end_with_parent() -> None:
    """Exit as soon as the parent process has ended: if killed, it cannot end its processes."""
    threading.Thread(target=_exit_after_parent, daemon=True).start()


def _exit_after_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
