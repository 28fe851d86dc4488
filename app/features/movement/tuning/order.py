"""What a tuning is asked to do, as it is passed to its process; and why it may refuse."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from app.errors import InvalidInput
from app.protocol.avatar import parse_avatar_json
from app.protocol.humanoid import parse_figure
from app.science.avatar.body import Figure
from app.science.avatar.configuration import Configuration
from app.science.avatar.tuning import TuningError, TuningOptions

Json = dict[str, Any]


class CannotTune(Exception):
    """A tuning, its curves or its comparison cannot be computed; the message says why.

    `value` and `valid` are what was given and what would do, where that is known.
    """

    def __init__(self, message: str, value: object = None, valid: object = None) -> None:
        # All of them are arguments of the base, so that they survive the way between processes.
        super().__init__(message, value, valid)
        self.value, self.valid = value, valid

    def __str__(self) -> str:
        return str(self.args[0])


@dataclass(frozen=True)
class TunedBody:
    """A configuration and its body, picklable and hashable.

    Attributes:
        canonical_json: the configuration, without parts that its model lacks.
        figure: the model that it names, as stored; None for a body of the stature.
        stature_m: the stature of the body.
    """

    canonical_json: str
    figure: str | None
    stature_m: float

    def configuration(self) -> Configuration:
        """Return the configuration."""
        return parse_avatar_json(self.canonical_json)

    def parsed_figure(self) -> Figure | None:
        """Return the model's figure."""
        return None if self.figure is None else parse_figure(self.figure)


@dataclass(frozen=True)
class TuningOrder:
    """A body to be tuned, and the stored options of its tuning."""

    body: TunedBody
    options: Json


def tuning_options(stored: Mapping[str, Any]) -> TuningOptions:
    """Return the options of a tuning from those of a request; raise InvalidInput."""
    axes = stored.get("axes")
    try:
        return TuningOptions(**{**stored, "axes": None if axes is None else tuple(axes)})
    except TuningError as error:
        raise InvalidInput(
            f"the avatar cannot be tuned like this: {error}",
            remedy="Change the option that is named; nothing was started.",
        ) from None
