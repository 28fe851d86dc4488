"""What a study says of simulated participants: which curve their answers to each item follow.

A rehearsal answers Likert items with the agreement that was published for an aspect of embodiment
at that latency (`app.science.simulation.answers`). What an item asks about cannot be told from its
instrument's scores: an item may be in none, or in one whose name means something else. So the study
names it; the items of the instruments that come with the product are named in the rehearsal.
"""

from collections.abc import Iterator, Mapping
from typing import Annotated, Literal

from pydantic import Field

from app.protocol.common import Key, Strict
from app.protocol.source import Plain
from app.science.instruments import DefinitionProblem, Instrument

Aspect = Literal["agency", "ownership", "simultaneity"]


class Simulation(Strict):
    """How rehearsals answer; it has no effect on people.

    `aspects`: by instrument and item, the aspect whose published agreement simulated answers
    follow. Items that are not named follow ownership.
    """

    aspects: Annotated[
        dict[Key, dict[Key, Aspect]],
        Field(description="instrument -> item -> agency, ownership or simultaneity"),
    ]


def simulation_problems(
    tree: Mapping[str, Plain], instruments: Mapping[str, Instrument], asked: set[str]
) -> Iterator[DefinitionProblem]:
    """Yield a problem for every instrument that the study does not ask, and every unknown item."""
    simulation = tree.get("simulation")
    aspects = simulation.get("aspects") if isinstance(simulation, dict) else None
    for key, items in aspects.items() if isinstance(aspects, dict) else ():
        path = ("simulation", "aspects", key)
        if key not in asked:
            yield DefinitionProblem(
                path,
                f"The study does not ask {key!r}.",
                key,
                sorted(asked),
                f"Name an instrument that the study asks: {', '.join(sorted(asked)) or 'none'}.",
            )
        elif key in instruments and isinstance(items, dict):
            likert = [item.key for item in instruments[key].items if item.type == "likert"]
            for item in items:
                if item not in likert:
                    yield DefinitionProblem(
                        (*path, item),
                        f"{key!r} has no Likert item {item!r}.",
                        item,
                        likert,
                        "Name Likert items of the instrument; other items have no curve.",
                    )
