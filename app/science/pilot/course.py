"""Who visits, and the course of their level over the blocks of a visit.

A level is what a measure depends on: a trait in logits for ratings, seconds for contact time. It is

    level = mean of limb and condition + carry-over + period + person + reaction + moment

where carry-over is a share of the previous condition's effect (first order), period grows linearly
with the number of blocks before, and person, reaction (person x condition, the same for all limbs)
and moment (each task) are independent normal deviates.

People come one after the other. Whoever stops frees the slot of the ledger, and the next person
takes the lowest free one: the order of somebody who stops is used again, as in a real study.

Jones and Kenward 2014, Design and Analysis of Cross-Over Trials, 3rd edition, chapters 1 and 5.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from app.science.statistics import FloatArray, IntArray

BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Course:
    """The declared parts of a level, all in its own unit except `carry_over`.

    Attributes:
        means: (limbs, k) mean level by limb and condition.
        effects: (limbs, k) the part of `means` that is the condition's effect, against the
            condition without one.
        carry_over: share of the previous condition's effect that is still there.
        period: change from one block to the next.
        persons, reactions, moments: standard deviations.
    """

    means: FloatArray
    effects: FloatArray
    carry_over: float
    period: float
    persons: float
    reactions: float
    moments: float

    def without_effect(self) -> "Course":
        """Return the same course if no condition had an effect."""
        return replace(self, means=self.means - self.effects, effects=np.zeros_like(self.effects))

    def undisturbed(self) -> "Course":
        """Return the same course without carry-over and period, as the question of a study is."""
        return replace(self, carry_over=0.0, period=0.0)


def drawn_courses(course: Course, orders: IntArray, rng: np.random.Generator) -> FloatArray:
    """Draw levels (studies, n, limbs, k conditions) for orders (studies, n, k positions).

    `orders` has the number of the condition at each position.
    """
    studies, n, k = orders.shape
    limbs = course.means.shape[0]
    position = np.argsort(orders, axis=2)
    before = np.take_along_axis(orders, np.maximum(position - 1, 0), axis=2)
    # (limbs, studies, n, k): the effect of the condition before, none in the first block.
    carried = np.where(position == 0, 0.0, course.effects[:, before])
    persons = course.persons * rng.standard_normal((studies, n, 1, 1))
    reactions = course.reactions * rng.standard_normal((studies, n, 1, k))
    moments = course.moments * rng.standard_normal((studies, n, limbs, k))
    levels: FloatArray = (
        course.means
        + course.carry_over * np.moveaxis(carried, 0, 2)
        + course.period * position[:, :, np.newaxis, :]
        + persons
        + reactions
        + moments
    )
    return levels


@dataclass(frozen=True, eq=False)
class Visits:
    """The participants of several simulated studies.

    Attributes:
        orders: (studies, n, k) the number of the condition at each position.
        completed: (studies, n) whether the visit was completed.
    """

    orders: IntArray
    completed: BoolArray


def drawn_visits(
    slots: IntArray, studies: int, n: int, dropout: float, rng: np.random.Generator
) -> Visits:
    """Draw the visits of n people to each of several studies.

    Args:
        slots: (at least n, k) the order of conditions of each slot, in the ledger's order.
        studies: the number of studies.
        n: the number of people who start.
        dropout: the probability of stopping in a block, 0 to 1; in each block the same.
        rng: random generator.
    """
    blocks = slots.shape[1]
    completed: BoolArray = np.asarray((rng.random((studies, n, blocks)) >= dropout).all(axis=2))
    # As slots are freed before the next person comes, the lowest free one follows the completed.
    taken: IntArray = np.cumsum(completed, axis=1) - completed
    return Visits(slots[taken], completed)
