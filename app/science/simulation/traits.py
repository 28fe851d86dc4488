"""The movement traits of one simulated person, drawn once, from published data if available.

| quantity | value | source |
|---|---|---|
| reaction time | 0.27 s, SD 0.05 between, 15 % within | assumed, order as in Luce (1986) |
| pace that is chosen | .230 + .169 ID, s | MacKenzie and Ware (1993), a mouse without lag |
| index of difficulty | ID = log2(D / W + 1), W = 2 near_m | MacKenzie (1992) |
| shape of a movement | minimum jerk | Flash and Hogan (1985) |
| motor noise | SD of the end along the way = .012 s x mean speed | assumed, form: Schmidt (1979) |
| its ellipse | half as wide across the way | order as in van Beers et al. (2004) |
| delay of vision | 0.12 s | assumed, order as in Saunders and Knill (2003) |
| correction by vision | 1 of the seen error per second | assumed |
| learning from it | 0.06 of the seen error per second | assumed |
| foot slower than hand | factor 1.4 | assumed |
| tempo and precision | factors between people, log-normal, SD 15 and 25 % | assumed |

The added latency is not among them: a person does not know it. It shows in what they see (`vision`)
and in when a touch counts, and only through these in what they do.

Pace and shape of a hand's movements can be learnt from recordings instead (`ReachingPeople`,
fitted by the package `reaching`): tempo, spread and shape of the table are then not used for hands.

The assumed values are our own: they make rehearsals look alive and are no claim about people.
Figures with a source were taken from the papers' well-known summaries.
"""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

_FASTEST_MEAN_SPEED_M_S = 1.6
_INTERCEPT_S, _SLOPE_S_PER_BIT = 0.230, 0.169
TEMPO_SPREAD = 0.15
"""SD of the logarithm of tempo between people (assumed)."""


def difficulty_bits(distance_m: float, near_m: float) -> float:
    """Return the index of difficulty of a movement to a target of this half width, in bits."""
    return math.log2(distance_m / (2.0 * near_m) + 1.0)


def usual_time_s(distance_m: float, near_m: float) -> float:
    """Return the time that the pace of the table gives a movement to a target's half width."""
    return _INTERCEPT_S + _SLOPE_S_PER_BIT * difficulty_bits(distance_m, near_m)


def shortest_time_s(distance_m: float) -> float:
    """Return the time below which nobody moves a hand over a distance (assumed)."""
    return distance_m / _FASTEST_MEAN_SPEED_M_S


class ReachingPerson(Protocol):
    """Protocol of how one person's hands move, learnt from recordings."""

    @property
    def counts(self) -> tuple[int, int]:
        """How many movements were drawn, and how many of them outside the recorded distances."""
        ...

    def movement(
        self, distance_m: float, near_m: float, rng: np.random.Generator
    ) -> tuple[float, float]:
        """Draw a movement to a target of this half width: its time in seconds, and its skew."""
        ...


class ReachingPeople(Protocol):
    """Protocol of how people's hands move, learnt from recordings."""

    def person(self, rng: np.random.Generator) -> ReachingPerson:
        """Draw one person."""
        ...


@dataclass(frozen=True)
class MovementTraits:
    """One person's way of moving: times in seconds, SDs of log times, and factors.

    `noise_s`: SD of a movement's end along its way, over its mean speed. `vision_s`: how late the
    person perceives what they see. `correction_per_s`: share of the seen error that they correct
    in a second, `learning_per_s`: that they keep for later movements. `patience_s`: how long a
    limb rests without effect before the person tries again, `caught_s`: how long if it is seen to
    be caught on its way. `reaching`: how the hands move, None for tempo and spread.
    """

    reaction_s: float = 0.27
    reaction_spread: float = 0.15
    tempo: float = 1.0
    precision: float = 1.0
    movement_spread: float = 0.08
    noise_s: float = 0.012
    vision_s: float = 0.12
    correction_per_s: float = 1.0
    learning_per_s: float = 0.06
    foot_tempo: float = 1.4
    patience_s: float = 1.2
    caught_s: float = 0.4
    reaching: ReachingPerson | None = None

    def reaction(self, rng: np.random.Generator) -> float:
        """Draw a reaction time in seconds, never below 0.12 s."""
        drawn = self.reaction_s * math.exp(self.reaction_spread * rng.standard_normal())
        return max(0.12, drawn)

    def movement_time(self, distance_m: float, near_m: float, rng: np.random.Generator) -> float:
        """Draw the planned time of a movement over this distance to this half width."""
        mean_s = usual_time_s(distance_m, near_m)
        drawn = self.tempo * mean_s * math.exp(self.movement_spread * rng.standard_normal())
        return max(drawn, shortest_time_s(distance_m))

    def scatter_m(self, distance_m: float, duration_s: float) -> float:
        """Return the SD of the end of a movement along its way, in metres."""
        return self.precision * self.noise_s * distance_m / duration_s


def draw_traits(rng: np.random.Generator) -> MovementTraits:
    """Draw the traits of one person."""
    return MovementTraits(
        reaction_s=max(0.15, 0.27 + 0.05 * rng.standard_normal()),
        tempo=math.exp(TEMPO_SPREAD * rng.standard_normal()),
        precision=math.exp(0.25 * rng.standard_normal()),
    )
