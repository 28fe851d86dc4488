"""The levels of a study's factor, by latency and body, and the design of their orders."""

from typing import Annotated, Literal

from pydantic import AfterValidator, Field, StringConstraints

from app.protocol.common import Key, Strict, Text, refusal

MAX_LATENCY_MS = 10_000.0
MAX_PERMUTED = 6


def _latency(value: float) -> float:
    if value < 0:
        raise refusal(
            f"The latency is negative ({value:g} ms): the body would move before the participant.",
            value=value,
            valid=f"0 to {MAX_LATENCY_MS:g} ms",
            remedy="Give the latency to add; use 0 for none.",
        )
    if value > MAX_LATENCY_MS:
        raise refusal(
            f"A latency of {value:g} ms is too long for anyone to control a body.",
            value=value,
            valid=f"0 to {MAX_LATENCY_MS:g} ms",
            remedy="Give milliseconds, not microseconds.",
        )
    return value


LatencyMs = Annotated[
    float, AfterValidator(_latency), Field(description="added latency in milliseconds, 0 or more")
]


BodyName = Annotated[
    str,
    StringConstraints(pattern=r"^[a-z][a-z0-9_-]{0,79}$"),
    Field(description="the name of a body, as on the page Bodies"),
]


class Condition(Strict):
    """One level of the factor: the latency added to the target of every delayed body part.

    `body`: the body that participants wear in it; if left out, the avatar configuration's body.
    """

    key: Key
    latency_ms: LatencyMs
    label: Text
    # Left out of the content if not set, so that the hashes of other studies stay the same.
    body: Annotated[BodyName | None, Field(exclude_if=lambda value: value is None)] = None


def _distinct(conditions: tuple[Condition, ...]) -> tuple[Condition, ...]:
    for index, condition in enumerate(conditions):
        for earlier in conditions[:index]:
            if condition.key == earlier.key:
                raise refusal(
                    f"Two conditions have the key {condition.key!r}.",
                    value=condition.key,
                    valid="a key of its own for each condition",
                    remedy="Rename one of them.",
                    at=(index, "key"),
                )
            if (condition.latency_ms, condition.body) == (earlier.latency_ms, earlier.body):
                raise refusal(
                    f"The conditions {earlier.key!r} and {condition.key!r} both add "
                    f"{condition.latency_ms:g} ms, so no analysis can tell them apart.",
                    value=condition.latency_ms,
                    valid="a different latency or a different body for each condition",
                    remedy="Change or remove one of them, or give them different bodies.",
                    at=(index, "latency_ms"),
                )
    return conditions


Conditions = Annotated[tuple[Condition, ...], Field(min_length=1), AfterValidator(_distinct)]


class Orders(Strict):
    """The counterbalancing: the orders, how often each is used, and what follows when all are used.

    `design`: "all_permutations" (n! orders), "williams" (n orders for an even number of conditions,
    2n for an odd one: each condition equally often at each position, each ordered pair of
    neighbours equally often), or "explicit": those listed in `sequences`, by the conditions' keys.
    `replicates`: initial blocks of the ledger; one block contains every order once. `seed`:
    determines how the rows are shuffled within each block. `when_full`: "grow" adds whole blocks,
    "closed" accepts no more participants.
    """

    design: Literal["all_permutations", "williams", "explicit"]
    replicates: Annotated[int, Field(ge=1, le=1000)]
    seed: Annotated[int, Field(ge=0)]
    when_full: Literal["grow", "closed"]
    # Left out of the content if not set, so that the hashes of other designs stay the same.
    sequences: Annotated[
        tuple[tuple[Key, ...], ...] | None, Field(exclude_if=lambda value: value is None)
    ] = None
