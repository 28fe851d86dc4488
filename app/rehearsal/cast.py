"""Play a session: an operator who issues commands, a tablet that answers, and a headset."""

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Literal

import numpy as np
from httpx2 import AsyncClient

from app.client import Operator, ServerRefusedError, Tablet, call_with_retry, submit_form
from app.protocol import STEP_KINDS, TIMED_KINDS
from app.rehearsal.answers import agreement, fill_in
from app.rehearsal.headset import WITHDRAWN, Headset
from app.science.simulation import Aspect
from app.simulated_people.body import Person

Json = dict[str, Any]
ENDED = ("completed", "aborted", WITHDRAWN)
OVERTAKEN = ("stale", "not_now")
"""Error codes of a command that came after somebody else's, or the headset's, change."""
LOOK_EVERY_S = 0.1
REDO_REASON = "Rehearsal: the phase is repeated."
WITHDRAWAL_REASON = "Rehearsal: the participant withdraws."
INTERRUPTION_TEXTS = {
    "redo": "is repeated from its beginning",
    "withdraw": "the participant withdraws",
}


@dataclass(frozen=True)
class Interruption:
    """An interruption by the operator half-way through a phase: a repetition or a withdrawal.

    `phase`: its number in the visit, from 1; practice and free movement count.
    """

    kind: Literal["redo", "withdraw"]
    phase: int


class MissedInterruptionError(RuntimeError):
    """The session was completed before the operator could interrupt it; says what to do."""


@dataclass
class Cast:
    """The three devices and their shared state.

    `in_headset`: a client with the headset's token. `aspects`: what items ask about, by instrument;
    simulated answers follow the aspect's curve. `interruptions`: the pending ones, the next
    first.
    """

    operator: Operator
    tablet: Tablet
    headset: Headset
    person: Person
    rng: np.random.Generator
    in_headset: AsyncClient
    aspects: dict[str, dict[str, Aspect]] = field(default_factory=dict)
    say: Callable[[str], None] = lambda _: None
    submitted: set[str] = field(default_factory=set)
    interruptions: list[Interruption] = field(default_factory=list)


async def perform(cast: Cast) -> None:
    """Run all three devices until the session is over; if one fails, the others are cancelled."""
    async with asyncio.TaskGroup() as group:
        group.create_task(cast.headset.run())
        group.create_task(answer(cast))
        group.create_task(operate(cast))


async def operate(cast: Cast) -> None:
    """Play the operator: check the session and issue the next command, until it is over."""
    shown = -1
    while True:
        view = await cast.operator.view()
        if view["status"] in ENDED:
            _require_no_interruption_missed(cast, view)
            return
        current = view["current"]
        if current is not None and current["index"] != shown:
            shown = current["index"]
            cast.say(f"{shown + 1}/{len(view['steps'])} {view['steps'][shown]['title']}")
        try:
            if _is_due(view, cast):
                await _interrupt(view, cast)
            elif (action := _next_action(view, cast.person)) is not None:
                kind, fields = action
                await cast.operator.command(view, kind, **fields)
        except ServerRefusedError as error:
            if error.code not in OVERTAKEN:
                raise
        await asyncio.sleep(LOOK_EVERY_S)


def _is_due(view: Json, cast: Cast) -> bool:
    """Return whether the phase of the next interruption is half over, or was already left."""
    if not cast.interruptions or view["current"] is None:
        return False
    step = _step_of(view, cast.interruptions[0])
    current = view["current"]
    if current["index"] != step["index"]:
        return bool(current["index"] > step["index"])
    running = current["status"] == "running"
    return bool(running and cast.headset.active_s >= step["duration_s"] / 2.0)


async def _interrupt(view: Json, cast: Cast) -> None:
    """Carry out the next interruption; if it is refused, it stays pending."""
    order = cast.interruptions[0]
    if order.kind == "redo":
        step_index = _step_of(view, order)["index"]
        await cast.operator.command(view, "redo", step_index=step_index, reason=REDO_REASON)
    else:
        await cast.operator.stop("withdraw", reason=WITHDRAWAL_REASON)
    cast.say(f"phase {order.phase}: {INTERRUPTION_TEXTS[order.kind]}")
    cast.interruptions.pop(0)


def _step_of(view: Json, order: Interruption) -> Json:
    timed: list[Json] = [step for step in view["steps"] if step["kind"] in TIMED_KINDS]
    return timed[order.phase - 1]


def _require_no_interruption_missed(cast: Cast, view: Json) -> None:
    if cast.interruptions and view["status"] == "completed":
        phase = cast.interruptions[0].phase
        raise MissedInterruptionError(
            f"the session was over before phase {phase} could be interrupted; give a lower --speed"
        )


def _next_action(view: Json, person: Person) -> tuple[str, Json] | None:
    if view["status"] == "planned":
        return "start", {}
    if view["held"] is not None:
        # A simulated participant is never unwell, but this exercises the stop rule.
        return "override_stop", {"reason": "Rehearsal: nobody is unwell."}
    current = view["current"]
    step = view["steps"][current["index"]]
    connected = any(one["kind"] == "headset" and one["connected"] for one in view["devices"])
    spec = STEP_KINDS[step["kind"]]
    if spec.command == "complete_step" and spec.screen == "waiting":
        return "complete_step", _measured(person) if spec.key == "height" else {}
    if spec.family == "timed" and connected:
        if current["status"] == "ready":
            return "begin_phase", {}
        if current["status"] == "paused" and not current["resuming"]:
            return "resume", {}
    return None


def _measured(person: Person) -> Json:
    stated_m, matched_m = round(person.stature_m, 2), round(person.stature_m, 3)
    return {"height_m": {"stated": stated_m, "matched": matched_m}}


async def answer(cast: Cast) -> None:
    """Play the tablet: read, consent and answer until the session is over."""
    try:
        await _answer_while_it_lasts(cast)
    except ServerRefusedError as error:
        if error.code != WITHDRAWN:
            raise


async def _answer_while_it_lasts(cast: Cast) -> None:
    while True:
        state = await cast.tablet.state()
        match state["screen"]:
            case "finished":
                return
            case "consent":
                await cast.tablet.consent(state["step_index"], agreement(state["consent"]))
            case "instructions":
                await cast.tablet.acknowledge(state["step_index"])
            case "form":
                await _fill_in(cast, state["administration"], cast.tablet.submit)
            case "in_headset" | "oral":
                await _fill_in_elsewhere(cast, state["screen"])
                await asyncio.sleep(LOOK_EVERY_S)
            case _:
                await asyncio.sleep(LOOK_EVERY_S)


async def _fill_in_elsewhere(cast: Cast, screen: str) -> None:
    """Answer inside the headset, or aloud: then the operator enters the answers."""
    own = f"/api/sessions/{cast.operator.session_id}"
    client, path, form = {
        "in_headset": (cast.in_headset, "/api/vr/submissions", "/api/vr/form"),
        "oral": (cast.operator.client, f"{own}/submissions", f"{own}/administration"),
    }[screen]
    try:
        administration = await call_with_retry(client, "GET", form)
    except ServerRefusedError as error:
        if error.code != "not_now":
            raise
        return
    if administration is not None:
        await _fill_in(cast, administration, partial(submit_form, client, path))


async def _fill_in(
    cast: Cast, administration: Json, submit: Callable[[Json, Json, str], Awaitable[Json]]
) -> None:
    view = await cast.operator.view()
    step = view["steps"][administration["step_index"]]
    instrument = administration["instrument"]
    answers = fill_in(
        instrument,
        cast.person,
        step["latency_ms"],
        step["limb"],
        cast.rng,
        cast.aspects.get(instrument["key"]),
    )
    await submit(administration, answers, f"rehearsal-{administration['key']}"[:64])
    cast.submitted.add(administration["key"])
