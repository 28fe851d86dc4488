"""Rehearse with several people for another program, some of them at the same time.

Input is one line of JSON: `{"at_once": n, "plans": [...]}`, each plan with the fields of
`RehearsalPlan`. Output is lines of JSON: `{"person": number, "session": id}` when a session begins,
`{"person": number, "through": true}` when it is over, counted from 1, and at the end
`{"done": true}` or `{"error": message}`. If one fails, the others end their sessions. It exits
immediately when its input is closed, because then the program that started it has ended.
"""

import asyncio
import json
import sys
from collections.abc import Sequence
from typing import Any

from app.rehearsal.__main__ import emit, end_session, plan_from, run_to_end
from app.rehearsal.cast import perform
from app.rehearsal.rehearse import RehearsalPlan, assembled


def main() -> int:
    """Rehearse with everybody; return 1 if a rehearsal failed or was stopped."""
    order: dict[str, Any] = json.loads(sys.stdin.readline())
    plans = [plan_from(plan) for plan in order["plans"]]
    return run_to_end(rehearse_several(plans, int(order["at_once"])))


async def rehearse_several(plans: Sequence[RehearsalPlan], at_once: int) -> None:
    """Run one rehearsal a plan.

    Args:
        plans: the visits; the reports count people from 1, in this order.
        at_once: how many people are in their visit at the same time.

    Raises:
        ExceptionGroup: a rehearsal failed, and the others have ended their sessions.
    """
    places = asyncio.Semaphore(at_once)

    async def visit(person: int, plan: RehearsalPlan) -> None:
        async with places, assembled(plan, lambda _: None) as cast:
            emit(person=person, session=cast.operator.session_id)
            try:
                await perform(cast)
            except BaseException:
                await asyncio.shield(end_session(cast.operator))
                raise
        emit(person=person, through=True)

    async with asyncio.TaskGroup() as group:
        for person, plan in enumerate(plans, start=1):
            group.create_task(visit(person, plan))


if __name__ == "__main__":
    sys.exit(main())
