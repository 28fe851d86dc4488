"""Generate data sets of the study without any effect, to measure the error rates of tests.

A test at 5 % should reject in 5 of 100 such data sets, and an interval of 95 % contain the truth in
95 of them. Exact tests guarantee this, most others only for many participants; and the study has a
dozen or two. So each test is tried on data like the study's own:

    n participants (whole blocks of the six orders of three latencies), two limbs per period;
    a continuous measure, participant's level + error, both normal;
    one item of a questionnaire from 1 to 7: participant's level + logistic error cut at thresholds
    at which most people agree, as they do with agency, so that many answers are equal;
    a scale of several such items from one administration, for its consistency.

*Reactions* are effects of a latency that differ between people. With reactions, a participant's
level turns towards another, independent one as the latency grows,

    level(latency) = level cos(a) + other sin(a),    a = arcsin(reaction) latency / 350 ms,

so that each latency has the same distribution over people, and nothing has an effect, but 0 and 350
ms resemble each other less than 0 and 125 ms. Without reactions every order of a participant's
values is equally likely, which is what rank tests assume; with them it is not, and a model with
only random intercepts is wrong. Both are tried.

Pure simulation: all randomness comes from the given generator.
"""

from dataclasses import dataclass

import numpy as np

from app.science.statistics import FloatArray, IntArray
from app.science.williams import williams

LATENCIES_MS = (0, 125, 350)
LIMBS = ("hand", "foot")
_TRUTH_PEOPLE = 400_000


@dataclass(frozen=True)
class NullDesign:
    """The design of a study without effects.

    Attributes:
        participants: a multiple of six.
        level_sd: SD of participants' levels, in error SDs of the continuous measure and on the
            logistic scale of items.
        reaction: 0 to 1, the share of another level in a participant's level at 350 ms.
        items: the number of items of the scale.
        thresholds: six, on the logistic scale.
    """

    participants: int
    level_sd: float = 1.2
    reaction: float = 0.0
    items: int = 5
    thresholds: tuple[float, ...] = (-4.0, -3.0, -2.2, -1.4, -0.4, 1.0)


@dataclass(frozen=True, eq=False)
class NullData:
    """One data set of n participants.

    Attributes:
        measure: (n, latencies, limbs) continuous.
        item: (n, latencies, limbs) answers 1 to 7.
        scale: (n, items) answers 1 to 7.
        periods: (n, latencies) the period, from 1, in which the participant had each latency.
    """

    measure: FloatArray
    item: IntArray
    scale: IntArray
    periods: IntArray


def null_data(design: NullDesign, rng: np.random.Generator) -> NullData:
    """Draw a data set.

    Raises:
        ValueError: the number of participants is not a multiple of six.
    """
    orders = np.array(williams(len(LATENCIES_MS)))
    if design.participants < 1 or design.participants % len(orders):
        raise ValueError(f"{design.participants} participants are no blocks of {len(orders)}.")
    n, shape = design.participants, (design.participants, len(LATENCIES_MS), len(LIMBS))
    share = np.array(LATENCIES_MS)[:, np.newaxis] / max(LATENCIES_MS)
    angle = np.arcsin(design.reaction) * share

    def levels() -> FloatArray:
        level, other = rng.normal(size=(n, 1, 1)), rng.normal(size=(n, 1, 1))
        turned: FloatArray = np.cos(angle) * level + np.sin(angle) * other
        return design.level_sd * turned

    return NullData(
        measure=levels() + rng.normal(size=shape),
        item=answers(design, levels() + rng.logistic(size=shape)),
        scale=_scale(design, n, rng),
        periods=np.argsort(np.tile(orders, (n // len(orders), 1)), axis=1) + 1,
    )


def answers(design: NullDesign, hidden: FloatArray) -> IntArray:
    """Convert latent values, of any shape, into answers from 1 on by their thresholds."""
    return np.searchsorted(design.thresholds, hidden).astype(np.int64) + 1


def population_alpha(design: NullDesign, rng: np.random.Generator) -> float:
    """Return Cronbach's alpha of the scale in a population of 400,000: the true value."""
    covariance = np.cov(_scale(design, _TRUTH_PEOPLE, rng), rowvar=False)
    share = float(np.trace(covariance)) / float(covariance.sum())
    return design.items / (design.items - 1) * (1.0 - share)


def _scale(design: NullDesign, people: int, rng: np.random.Generator) -> IntArray:
    level = design.level_sd * rng.normal(size=(people, 1))
    return answers(design, level + rng.logistic(size=(people, design.items)))
