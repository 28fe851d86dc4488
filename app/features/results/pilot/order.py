"""What a pilot may be asked for, as it is checked and as it is passed to its process.

Nothing here loads what computes a pilot.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

from app.protocol import LoadedStudy, StudyProtocol, sequences
from app.science.instruments import Instrument

Kind = Literal["cohort", "power"]
Options = dict[str, Any]
FEWEST_PARTICIPANTS: Final = 2
MOST_PARTICIPANTS: Final = 1000
MOST_SETS: Final = 100_000
SETS: Final = 1000
TARGET: Final = 0.8
_DEFAULT_SHARES: Final = (0.5, 0.75, 1.0, 1.5, 2.0)
"""Numbers of participants if none are given, as shares of the planned number."""


class PilotError(ValueError):
    """A pilot cannot be computed as asked; the message says why and what is valid."""


def most_participants(study: StudyProtocol) -> int | None:
    """Return how many people the study's ledger accepts; None if it grows."""
    if study.orders.when_full == "grow":
        return None
    return study.orders.replicates * len(sequences(study))


def numbers_around(planned: int) -> tuple[int, ...]:
    """Return the numbers of participants of a power run if none are given."""
    return tuple(max(FEWEST_PARTICIPANTS, round(one * planned)) for one in _DEFAULT_SHARES)


def possible_numbers(study: StudyProtocol, planned: int) -> tuple[int, ...]:
    """Return those of `numbers_around` that the ledger can hold; at least one."""
    most = min(most_participants(study) or MOST_PARTICIPANTS, MOST_PARTICIPANTS)
    return tuple(dict.fromkeys(min(one, most) for one in numbers_around(planned)))


def require_numbers(study: StudyProtocol, participants: Sequence[int]) -> tuple[int, ...]:
    """Return numbers of participants in ascending order, each once; raise PilotError."""
    wanted = tuple(sorted(set(participants)))
    most = most_participants(study)
    for n in wanted:
        if not FEWEST_PARTICIPANTS <= n <= MOST_PARTICIPANTS:
            raise PilotError(
                f"{n} participants: {FEWEST_PARTICIPANTS} to {MOST_PARTICIPANTS} are valid"
            )
        if most is not None and n > most:
            raise PilotError(
                f"{n} participants: the study's ledger has {most} slots and is closed when they "
                f"are taken. Ask for at most {most}, or raise orders.replicates or set "
                "orders.when_full to grow in the study"
            )
    return wanted


class CannotSimulate(Exception):
    """A pilot cannot go on; the message says why and what to do."""


@dataclass(frozen=True)
class PilotOrder:
    """A pilot to be computed.

    Attributes:
        kind: simulated people, or the power of the test only.
        study: the study's version, with the instruments that it asks.
        options: of a cohort `participants`, `seed` and `avatar`; of a power run `participants` (a
            list), `seed`, `sets` and `target`.
        assumptions: the file of what is assumed of answers; a cohort may have none.
    """

    kind: Kind
    study: LoadedStudy
    instruments: Mapping[str, Instrument]
    options: Options
    assumptions: str | None
