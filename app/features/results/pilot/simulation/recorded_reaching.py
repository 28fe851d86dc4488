"""What a pilot says of a file of recorded reaching: in its record, its report and its assumptions.

Hands of the cohort then move as recorded ones did; feet, reactions, noise and vision are assumed as
before, and the check of the study keeps its slow person.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from app.science.reaching import FittedReaching
from app.simulated_people.visits import Visit

Recorded = Mapping[str, Any]
"""What a record says of a file of reaching; see `reaching_header`."""


def reaching_header(fit: FittedReaching) -> Recorded:
    """Return what a record says of how people reach: the file, and what it was fitted on."""
    return {
        "sha256": fit.content_hash,
        "people": fit.persons,
        "reaches": len(fit.database),
        "synthetic": fit.synthetic,
        "distances_m": list(fit.distances_m),
        "by_width": fit.by_width,
        "tempo": math.exp(fit.levels.mean),
        "between_people_sd": fit.levels.spread,
    }


def reaching_data(recorded: Recorded, visits: Sequence[Visit]) -> dict[str, Any]:
    """Return what the report says: the header, and how many movements were drawn.

    `outside` counts those over a distance that was not recorded.
    """
    counts = [visit.reaches for visit in visits if visit.reaches is not None]
    return {
        **recorded,
        "movements": sum(drawn for drawn, _ in counts),
        "outside": sum(outside for _, outside in counts),
    }


def reaching_assumptions(recorded: Recorded) -> list[dict[str, Any]]:
    """Return what is assumed of hands, as a report lists assumptions."""
    source = reaching_source(recorded)
    return [
        {
            "name": "reaching.tempo",
            "value": recorded["tempo"],
            "unit": "share of the simulation's usual time, median person",
            "source": source,
        },
        {
            "name": "reaching.between_people",
            "value": recorded["between_people_sd"],
            "unit": "SD of the logarithm of tempo",
            "source": source,
        },
    ]


def reaching_source(recorded: Recorded) -> str:
    """Name a file of reaching: its hash, and on how many people and reaches it was fitted."""
    made = ", SYNTHETIC" if recorded["synthetic"] else ""
    people = recorded["people"]
    return (
        f"fitted to {recorded['reaches']} reaches of {people}"
        f" {'person' if people == 1 else 'people'}{made}; SHA-256 {recorded['sha256']}"
    )


def reaching_lines(recorded: Recorded, visits: Sequence[Visit]) -> Iterator[str]:
    """Yield lines of the printed report."""
    found = reaching_data(recorded, visits)
    yield f"Hands move as recorded: {reaching_source(recorded)}"
    least_m, most_m = recorded["distances_m"]
    if found["outside"]:
        yield (
            f"  {found['outside']} of {found['movements']} movements were over a distance outside"
            f" of the recorded {least_m:.2f} to {most_m:.2f} m: these are guesses"
        )
    else:
        yield f"  all {found['movements']} movements were within {least_m:.2f} to {most_m:.2f} m"
    if not recorded["by_width"]:
        yield "  The recorded targets' widths are not known: times depend on distance alone"
    yield (
        f"  Tempo {recorded['tempo']:.2f} of the usual time, SD between people"
        f" {100.0 * recorded['between_people_sd']:.0f} %. Feet, reactions, noise and vision are"
        " assumed"
    )
