"""Find what would break a study, before anybody takes part.

The file itself is validated first, as everywhere. What is looked for here needs a body or a number
of participants: boxes that a short or tall person cannot reach, phases in which a slow person
completes nothing, latencies that no buffer keeps, orders that are not balanced, and tests that
cannot be significant.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final

from app.features.results.pilot.order import most_participants
from app.features.results.pilot.simulation.plan import PilotStudy, Progress, Tell, lowest_p
from app.protocol import StudyProtocol, imbalances, sequences
from app.science.delay import LONGEST_DELAY_S
from app.science.tasks import Laterality
from app.simulated_people.walkthrough import Walkthrough, walk_through

BODIES: Final = {"the 5th percentile of women": 1.518, "the 95th percentile of men": 1.869}
"""Statures in m: Huston 2009, Principles of Biomechanics; segments have fixed proportions."""
_MS_PER_S = 1000.0
_WHERE_HANDS = "Move it nearer, up or down; the participant stands at the start square."


@dataclass(frozen=True)
class Finding:
    """One thing that would break the study: its kind, its place in the file, and what to do."""

    kind: str
    path: str
    message: str
    remedy: str


@dataclass(frozen=True)
class Reached:
    """How one body got through the first task of a limb at the longest latency."""

    limb: str
    hand: str
    body: str
    stature_m: float
    latency_ms: float
    out_of_reach: tuple[str, ...]
    completion_s: float | None


@dataclass(frozen=True)
class Checked:
    """What was found in a study, and what the simulated bodies did."""

    study: str
    sha256: str
    findings: tuple[Finding, ...]
    reached: tuple[Reached, ...]


def check_study(study: PilotStudy, tell: Tell, of_scene: Sequence[Finding] = ()) -> Checked:
    """Check a study; `of_scene`: what was found in the scene of its walks."""
    protocol = study.study.protocol
    findings = [*of_scene, *_buffers(protocol), *_orders(protocol), *_tests(protocol)]
    reached = list(_walks(protocol, tell))
    findings += _reach(protocol, reached)
    findings += _durations(protocol, reached)
    return Checked(protocol.key, study.study.content_hash, tuple(findings), tuple(reached))


def _buffers(study: StudyProtocol) -> Iterator[Finding]:
    for at, one in enumerate(study.conditions):
        if one.latency_ms > LONGEST_DELAY_S * _MS_PER_S:
            yield Finding(
                "latency_over_buffer",
                f"conditions[{at}].latency_ms",
                f"{one.latency_ms:g} ms is longer than the {LONGEST_DELAY_S * _MS_PER_S:g} ms of "
                "movement that a delayed copy, and an avatar that gives way, keep.",
                f"Use at most {LONGEST_DELAY_S * _MS_PER_S:g} ms.",
            )


def _orders(study: StudyProtocol) -> Iterator[Finding]:
    declared, block = study.preregistration, len(sequences(study))
    slots = most_participants(study)
    found = imbalances(sequences(study)) if len(study.conditions) > 1 else []
    if found:
        yield Finding(
            "unbalanced_orders",
            "orders",
            f"However many take part, the orders are not balanced: {'; '.join(found)}.",
            "Use the design williams or all_permutations, or list further sequences.",
        )
    if declared is None:
        return
    if slots is not None and declared.planned_n > slots:
        yield Finding(
            "unbalanced_orders",
            "orders.replicates",
            f"{declared.planned_n} participants are planned, but the closed ledger has "
            f"{slots} slots.",
            f"Raise replicates to {-(-declared.planned_n // block)}, or let the ledger grow.",
        )
    elif declared.planned_n % block:
        yield Finding(
            "unbalanced_orders",
            "preregistration.planned_n",
            f"{declared.planned_n} participants do not fill {block} orders equally.",
            f"Plan {declared.planned_n // block * block or block} or "
            f"{(declared.planned_n // block + 1) * block}.",
        )


def _tests(study: StudyProtocol) -> Iterator[Finding]:
    declared = study.preregistration
    if declared is None:
        return
    p = lowest_p(study, declared, declared.planned_n)
    if p is not None and p > declared.alpha:
        yield Finding(
            "never_significant",
            "preregistration.planned_n",
            f"With {declared.planned_n} participants the p of {declared.primary.test} is {p:.3g} "
            f"at best, so it can never be at most {declared.alpha:g}.",
            "Plan more participants; ./run pilot power says how many.",
        )


def _walks(study: StudyProtocol, tell: Tell) -> Iterator[Reached]:
    latency_ms = max(one.latency_ms for one in study.conditions)
    latency_s = min(latency_ms / _MS_PER_S, LONGEST_DELAY_S)
    limbs = list(dict.fromkeys(phase.limb for phase in study.procedure.block.phases))
    walks = list(product(limbs, BODIES.items(), Laterality))
    for at, (limb, (body, stature_m), hand) in enumerate(walks):
        tell(Progress("check", at, len(walks)))
        done: Walkthrough = walk_through(study.tasks.layout(limb), hand, stature_m, latency_s)
        yield Reached(
            limb.value,
            hand.value,
            body,
            stature_m,
            latency_s * _MS_PER_S,
            done.out_of_reach,
            done.completion_s,
        )


def _reach(study: StudyProtocol, reached: list[Reached]) -> Iterator[Finding]:
    missed: dict[tuple[str, str], list[Reached]] = {}
    for one in reached:
        for surface in one.out_of_reach:
            missed.setdefault((one.limb, surface), []).append(one)
    for (limb, surface), who in missed.items():
        x, y, z = study.tasks.layout(limb).by_key[surface].center_m
        bodies = " and ".join(dict.fromkeys(f"{one.body} ({one.stature_m:g} m)" for one in who))
        yield Finding(
            "out_of_reach",
            _place(limb, surface, study),
            f"{surface} at [{x:.2f}, {y:.2f}, {z:.2f}] m is out of reach for {bodies}.",
            _WHERE_HANDS,
        )


def _place(limb: str, surface: str, study: StudyProtocol) -> str:
    """Return where the file says where a surface is."""
    _, box, *_ = surface.split("/")
    task = study.tasks.hand if limb == "hand" else study.tasks.foot
    numbers = [str(one.number) for one in task.boxes] if task is not None else []
    what = f"boxes[{numbers.index(box)}]" if box in numbers else box
    return f"tasks.{limb}.{what}"


def _durations(study: StudyProtocol, reached: list[Reached]) -> Iterator[Finding]:
    for at, phase in enumerate(study.procedure.block.phases):
        own = [one.completion_s for one in reached if one.limb == phase.limb]
        longest_s = max((one for one in own if one is not None), default=0.0)
        if phase.duration_s < longest_s:
            yield Finding(
                "phase_too_short",
                f"procedure.block.phases[{at}].duration_s",
                f"In {phase.duration_s:g} s a slow person completes no {phase.limb} task at the "
                f"longest latency: the first one takes {longest_s:.0f} s.",
                f"Give at least {longest_s:.0f} s; several tasks make a measure less coarse.",
            )
