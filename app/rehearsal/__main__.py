"""Run a rehearsal for another program: its plan comes on standard input, progress on output.

Input is one line of JSON: the fields of `RehearsalPlan`. Output is lines of JSON: `{"session": id}`
once all devices are paired, `{"step": "3/20 ..."}` at each step, and at the end `{"done": true}` or
`{"error": message}`. If it is terminated or fails, it ends its session first. It exits immediately
when its input is closed, because then the program that started it has ended.
"""

import asyncio
import contextlib
import json
import os
import signal
import sys
import threading
from collections.abc import Coroutine
from dataclasses import fields
from typing import Any

from app.client import Operator, ServerRefusedError, UnreachableError
from app.rehearsal.cast import ENDED, OVERTAKEN, perform
from app.rehearsal.rehearse import RehearsalPlan, assembled

LONGEST_WORDS = 400
ENDS_WITHIN_S = 4.0
STOPPED = "The scripted participant was stopped."


def main() -> int:
    """Rehearse; return 1 if the rehearsal failed."""
    plan = plan_from(json.loads(sys.stdin.readline()))
    return run_to_end(_rehearse(plan))


def run_to_end(rehearsing: Coroutine[Any, Any, None]) -> int:
    """Rehearse, and report the end; return 1 if that failed or was stopped.

    It ends with the process that started this one, and with a termination.
    """
    end_with_the_starter()
    try:
        asyncio.run(_stoppable(rehearsing))
    except asyncio.CancelledError:
        return 1
    except Exception as error:  # noqa: BLE001  # every error is reported
        emit(error=message_of(error))
        return 1
    emit(done=True)
    return 0


async def _stoppable(rehearsing: Coroutine[Any, Any, None]) -> None:
    playing = asyncio.current_task()
    assert playing is not None  # noqa: S101 - this is one
    # Windows has no such signal: there a termination takes effect immediately.
    with contextlib.suppress(NotImplementedError):
        asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, playing.cancel)
    await rehearsing


async def _rehearse(plan: RehearsalPlan) -> None:
    async with assembled(plan, lambda words: emit(step=words)) as cast:
        emit(session=cast.operator.session_id)
        try:
            await perform(cast)
        except BaseException:
            await end_session(cast.operator)
            raise


async def end_session(operator: Operator) -> None:
    """Abort the session, so that no simulated session looks as if somebody were in it.

    The devices' last messages may change the session between the check and the command; then both
    are repeated.
    """
    # If the server does not respond, it is shutting down, too.
    with contextlib.suppress(TimeoutError, ServerRefusedError, UnreachableError):
        async with asyncio.timeout(ENDS_WITHIN_S):
            while (await operator.view())["status"] not in ENDED:
                try:
                    await operator.stop("abort", reason=STOPPED)
                except ServerRefusedError as error:
                    if error.code not in OVERTAKEN:
                        raise


def plan_from(content: dict[str, Any]) -> RehearsalPlan:
    """Return the plan of a decoded line; raise TypeError for unknown fields."""
    valid = {field.name for field in fields(RehearsalPlan)}
    unknown = sorted(set(content) - valid)
    if unknown:
        raise TypeError(f"a rehearsal's plan has no {', '.join(unknown)}")
    return RehearsalPlan(**content)


def emit(**news: object) -> None:
    """Write one line and flush it immediately."""
    sys.stdout.write(json.dumps(news) + "\n")
    sys.stdout.flush()


def message_of(error: BaseException) -> str:
    """Return the message of an error, or of the first in a group."""
    while isinstance(error, BaseExceptionGroup):
        error = error.exceptions[0]
    return (str(error) or type(error).__name__)[:LONGEST_WORDS]


def end_with_the_starter() -> None:
    """Watch the standard input in a thread, and exit as soon as it is closed."""

    def watch() -> None:
        while sys.stdin.readline():
            pass
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


if __name__ == "__main__":
    sys.exit(main())
