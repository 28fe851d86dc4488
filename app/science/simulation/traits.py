"""The movement traits of one simulated person, drawn once, from published data if available.

| quantity | value | source |
|---|---|---|
| reaction time | 0.27 s, SD 0.05 between, 15 % within | assumed, order as in Luce (1986) |
| movement time | .230 + (.169 + 1.03 lag) ID, s | MacKenzie and Ware (1993), with a mouse |
| index of difficulty | ID = log2(D / W + 1), W = 2 near_m | MacKenzie (1992) |
| end point scatter | SD = W / 4.133 | effective width, MacKenzie (1992); applied across the way |
| shape of a movement | minimum jerk | Flash and Hogan (1985) |
| overshoot | 8 % of movements, by 4 to 12 % of the way, corrected after 0.15 s | assumed |
| sides clipped | way-points scatter 1.5 times as widely as end points | assumed |
| foot slower than hand | factor 1.4 | assumed |
| tempo and precision | factors between people, log-normal, SD 15 and 25 % | assumed |

The assumed values are our own: they make rehearsals look alive and are no claim about people.
Figures with a source were taken from the papers' well-known summaries.
"""

import math
from dataclasses import dataclass

import numpy as np

_FASTEST_MEAN_SPEED_M_S = 1.6


@dataclass(frozen=True)
class MovementTraits:
    """One person's way of moving: times in seconds, SDs of log times, factors and probabilities."""

    reaction_s: float = 0.27
    reaction_spread: float = 0.15
    tempo: float = 1.0
    precision: float = 1.0
    movement_spread: float = 0.08
    overshoot_probability: float = 0.08
    correction_s: float = 0.15
    foot_tempo: float = 1.4
    patience_s: float = 1.2

    def reaction(self, rng: np.random.Generator) -> float:
        """Draw a reaction time in seconds, never below 0.12 s."""
        drawn = self.reaction_s * math.exp(self.reaction_spread * rng.standard_normal())
        return max(0.12, drawn)

    def movement_time(
        self, distance_m: float, near_m: float, latency_s: float, rng: np.random.Generator
    ) -> float:
        """Draw the time of a movement over this distance to a target of this half width."""
        difficulty = math.log2(distance_m / (2.0 * near_m) + 1.0)
        mean_s = 0.230 + (0.169 + 1.03 * latency_s) * difficulty
        drawn = self.tempo * mean_s * math.exp(self.movement_spread * rng.standard_normal())
        return max(drawn, distance_m / _FASTEST_MEAN_SPEED_M_S)

    def scatter_m(self, near_m: float) -> float:
        """Return the standard deviation of end points in metres, per axis across the way."""
        return self.precision * 2.0 * near_m / 4.133


def draw_traits(rng: np.random.Generator) -> MovementTraits:
    """Draw the traits of one person."""
    return MovementTraits(
        reaction_s=max(0.15, 0.27 + 0.05 * rng.standard_normal()),
        tempo=math.exp(0.15 * rng.standard_normal()),
        precision=math.exp(0.25 * rng.standard_normal()),
    )
