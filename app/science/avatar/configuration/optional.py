"""Check the settings that most configurations leave out: layers, own delays, relative masses.

A configuration without them behaves, and is written, as before they existed.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Final

from app.science.avatar.body import COLLIDING, LAYERS, PART_NAMES, SWITCHABLE_LAYERS
from app.science.avatar.configuration.axis_settings import AvatarProblem

MAX_OWN_DELAY_S: Final = 1.0
MS_PER_S: Final = 1e3
PERCENT: Final = 1e2
_SUM_TOLERANCE: Final = 1e-6
_DECIMALS: Final = 9


def layer_problems(colliding: frozenset[frozenset[str]]) -> Iterator[AvatarProblem]:
    """Yield a problem for every pair of layers that cannot differ from the standard matrix."""
    for pair in sorted(map(sorted, colliding ^ COLLIDING)):
        if frozenset(pair) not in SWITCHABLE_LAYERS:
            yield AvatarProblem(
                "layers",
                f"Collisions of {' with '.join(pair)} cannot be switched: they are the same layer,"
                " or overlap in usual poses.",
                value=list(pair),
                valid=[sorted(one) for one in sorted(map(sorted, SWITCHABLE_LAYERS))],
                remedy="Choose one of the valid pairs.",
            )


def delay_problems(delays_s: Mapping[str, float]) -> Iterator[AvatarProblem]:
    """Yield a problem for every delay that is out of range or of no body part."""
    for part, delay_s in delays_s.items():
        path = f"delays_ms.{part}"
        if part not in PART_NAMES:
            yield _no_part(path, part)
        elif not (math.isfinite(delay_s) and 0.0 <= delay_s <= MAX_OWN_DELAY_S):
            yield AvatarProblem(
                path,
                f"{1e3 * delay_s:g} ms is out of range.",
                value=round(MS_PER_S * delay_s, _DECIMALS),
                valid=f"from 0 to {1e3 * MAX_OWN_DELAY_S:g} ms",
                remedy="Give the milliseconds by which the part lags behind the others.",
            )


def mass_problems(relative_masses: Mapping[str, float]) -> Iterator[AvatarProblem]:
    """Yield a problem for every relative mass out of range, and for a sum that is impossible."""
    path = "relative_masses_percent"
    for part, fraction in relative_masses.items():
        if part not in PART_NAMES:
            yield _no_part(f"{path}.{part}", part)
        elif not (math.isfinite(fraction) and 1e-6 <= fraction <= 1.0):
            yield AvatarProblem(
                f"{path}.{part}",
                f"{100 * fraction:g} % is out of range.",
                value=round(PERCENT * fraction, _DECIMALS),
                valid="from 0.0001 to 100 %",
                remedy="Give the part's share of the mass of the whole body.",
            )
    total = math.fsum(relative_masses.values())
    is_complete = set(PART_NAMES) <= set(relative_masses)
    if is_complete and abs(total - 1.0) > _SUM_TOLERANCE:
        yield AvatarProblem(
            path,
            f"The relative masses of all parts add up to {100 * total:.9g} %.",
            value=100 * total,
            valid="100 %",
            remedy="Change some of them, or leave out a part that takes the rest.",
        )
    elif not is_complete and total > 1.0 - _SUM_TOLERANCE:
        yield AvatarProblem(
            path,
            f"These relative masses add up to {100 * total:.9g} %, which leaves nothing for the"
            " other parts.",
            value=100 * total,
            valid=f"less than {100 * (1.0 - _SUM_TOLERANCE):g} %",
            remedy="Make some of them smaller.",
        )


def ordered(values: Mapping[str, float], per_unit: float) -> dict[str, float]:
    """Return values by part in the order of the body, rounded as a file stores them.

    `per_unit`: how many of the file's units are one, such as 1000 ms.
    """
    return {
        part: round(per_unit * values[part], _DECIMALS) / per_unit
        for part in PART_NAMES
        if part in values
    }


def same_layer_problem(pair: tuple[str, str]) -> AvatarProblem | None:
    """Return the problem of a pair that is one layer twice: its own parts never collide."""
    if pair[0] != pair[1]:
        return None
    return AvatarProblem(
        "layers",
        f"The pair is the layer {pair[0]!r} twice. Parts of one layer do not collide.",
        value=list(pair),
        valid="two different layers",
        remedy="Name the other layer.",
    )


def layer_changes(colliding: frozenset[frozenset[str]]) -> tuple[tuple[str, str, bool], ...]:
    """Return the pairs that differ from the standard matrix, each with whether it collides.

    The layers of a pair, and the pairs, are in the order of `LAYERS`.
    """
    pairs = (tuple(sorted(pair, key=LAYERS.index)) for pair in colliding ^ COLLIDING)
    return tuple(
        (first, second, frozenset((first, second)) in colliding)
        for first, second in sorted(pairs, key=lambda pair: tuple(map(LAYERS.index, pair)))
    )


def _no_part(path: str, name: str) -> AvatarProblem:
    return AvatarProblem(
        path,
        f"There is no body part {name!r}.",
        value=name,
        valid=list(PART_NAMES),
        remedy="Name a body part as in Unity's HumanBodyBones.",
    )
