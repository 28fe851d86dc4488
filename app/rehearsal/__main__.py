"""A rehearsal for another program: its plan comes on standard input, what happens goes to output.

One line of JSON in: the fields of `RehearsalPlan`. Lines of JSON out, as it goes: `{"session": id}`
once three devices are paired, `{"step": "3/20 ..."}` at each step, and at the end `{"done": true}`
or `{"error": words}`. Asked to terminate, or where it fails, it ends its session first. It ends at
once when its input is closed: whoever started it is gone.
"""

import asyncio
import contextlib
import json
import os
import signal
import sys
import threading
from dataclasses import fields
from typing import Any

from app.client import Operator, ServerRefusedError, UnreachableError
from app.rehearsal.cast import ENDED, OVERTAKEN, perform
from app.rehearsal.rehearse import RehearsalPlan, assembled

LONGEST_WORDS = 400
ENDS_WITHIN_S = 4.0
STOPPED = "The scripted participant was stopped."


def main() -> int:
    """Rehearse; 1 where it failed."""
    plan = plan_from(json.loads(sys.stdin.readline()))
    threading.Thread(target=_end_with_the_starter, daemon=True).start()
    try:
        asyncio.run(_rehearse(plan))
    except asyncio.CancelledError:
        return 1
    except Exception as error:  # noqa: BLE001  # whatever it is, it is told
        tell(error=words_of(error))
        return 1
    tell(done=True)
    return 0


async def _rehearse(plan: RehearsalPlan) -> None:
    playing = asyncio.current_task()
    assert playing is not None  # noqa: S101 - this is one
    # Windows has no such signal: there a termination is one at once.
    with contextlib.suppress(NotImplementedError):
        asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, playing.cancel)
    async with assembled(plan, lambda words: tell(step=words)) as cast:
        tell(session=cast.operator.session_id)
        try:
            await perform(cast)
        except BaseException:
            await end_session(cast.operator)
            raise


async def end_session(operator: Operator) -> None:
    """Leave no simulated session that looks as if somebody were in it.

    What the three devices had sent last may still end it between the look and the order: then both
    are done again.
    """
    # Where nobody answers, the server goes away too.
    with contextlib.suppress(TimeoutError, ServerRefusedError, UnreachableError):
        async with asyncio.timeout(ENDS_WITHIN_S):
            while (await operator.view())["status"] not in ENDED:
                try:
                    await operator.stop("abort", reason=STOPPED)
                except ServerRefusedError as error:
                    if error.code not in OVERTAKEN:
                        raise


def plan_from(told: dict[str, Any]) -> RehearsalPlan:
    """The plan in a decoded line; raises TypeError for fields that a plan does not have."""
    known = {field.name for field in fields(RehearsalPlan)}
    unknown = sorted(set(told) - known)
    if unknown:
        raise TypeError(f"a rehearsal's plan has no {', '.join(unknown)}")
    return RehearsalPlan(**told)


def tell(**news: object) -> None:
    """One line, at once."""
    sys.stdout.write(json.dumps(news) + "\n")
    sys.stdout.flush()


def words_of(error: BaseException) -> str:
    """What the first of the things that went wrong says."""
    while isinstance(error, BaseExceptionGroup):
        error = error.exceptions[0]
    return (str(error) or type(error).__name__)[:LONGEST_WORDS]


def _end_with_the_starter() -> None:
    while sys.stdin.readline():
        pass
    os._exit(1)


if __name__ == "__main__":
    sys.exit(main())
