"""Ratings by the graded response model.

A person of trait theta rates an item at least as high as category j with the probability

    P(X >= j) = 1 / (1 + exp(-a (theta - b_j))),   j = 1 ... m

with the item's discrimination a and its thresholds b_1 < ... < b_m between m + 1 categories.
Samejima 1969, Estimation of Latent Ability Using a Response Pattern of Graded Scores, Psychometrika
Monograph 17. An item that is worded against the trait is rated for -theta.

The discrimination says how much an item tells about the trait; the thresholds, at which trait half
of all people give at least that rating.
"""

from dataclasses import dataclass

import numpy as np

from app.science.statistics import FloatArray


@dataclass(frozen=True)
class GradedItem:
    """The declared parameters of one item.

    Attributes:
        key: the item's key in its instrument.
        ratings: the possible ratings in ascending order.
        thresholds: b, one fewer than ratings, strictly ascending, in logits of the trait.
        discrimination: a, above 0.
        towards: 1, or -1 for an item that is worded against the trait.
    """

    key: str
    ratings: tuple[int, ...]
    thresholds: tuple[float, ...]
    discrimination: float = 1.0
    towards: int = 1


def drawn_ratings(item: GradedItem, traits: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Draw one rating for each trait (...), in the numbers of the item's scale.

    Ratings of people of the same trait are independent, as the model assumes.
    """
    # The model says that a logistic deviate, added to a theta, lies above a b_j.
    latent = item.discrimination * item.towards * traits + rng.logistic(size=traits.shape)
    cuts = item.discrimination * np.asarray(item.thresholds)
    ratings: FloatArray = np.asarray(item.ratings, dtype=np.float64)[np.searchsorted(cuts, latent)]
    return ratings


def expected_rating(item: GradedItem, trait: float) -> float:
    """Return the mean rating of people of one trait."""
    above = item.discrimination * (item.towards * trait - np.asarray(item.thresholds))
    return float(item.ratings[0] + np.diff(item.ratings) @ (1.0 / (1.0 + np.exp(-above))))
