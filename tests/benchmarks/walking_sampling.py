"""Measure draws of steering parameters, as a part of `./run bench walking`.

The space has 5000 entries over the paper's grid, k = 100, and each query is new. `fresh` is one
draw with its search for neighbours: the default mixture (of the multilinear map) and the paper's
method, blended radial basis functions and rejection. `cached` is one of many draws for a prepared
query. The peer, in the same run, is the paper's own pipeline as it describes it: KDTree of
scikit-learn, a weighted sum of maps, scipy's Rbf, rejection one proposal at a time.
"""

import time
from collections.abc import Callable, Iterator

import numpy as np
from scipy.interpolate import Rbf
from sklearn.neighbors import KDTree

from app.science.rotations import FloatArray
from app.science.walking.maps import MAP_FLOATS, BlendingSpace, blending_space
from app.science.walking.models import HEADROOM, MixtureSampler, density_of
from app.science.walking.records import PAPER_GRID, scaling_of
from tests.benchmarks.report import Figure

WALKS, PEOPLE, QUESTIONS, LITERAL, CACHED = 1848, 30, 3000, 40, 20_000
MIXTURE_US, RADIAL_US, CACHED_US, TIMES = 40.0, 100.0, 1.0, 300.0
NAMES = ("length_m", "turning_per_m", "stature_m")


def sampling_figures() -> Iterator[Figure]:
    """Measure the time of draws."""
    rng = np.random.default_rng(1)
    began = time.perf_counter()
    space, vectors = made_up_space(rng)
    yield Figure("sampling", "space of 5000 entries densified", time.perf_counter() - began, "s")
    questions = space.scaling.z(vectors[rng.integers(0, WALKS, QUESTIONS)])
    questions = questions + 0.05 * rng.standard_normal(questions.shape)
    mixture = MixtureSampler(space)
    ours = _median_us(lambda z: mixture.draw_one(z, rng), questions)
    yield Figure("sampling", "fresh, mixture", ours, "us", "at most", MIXTURE_US)
    radial = _median_us(
        lambda z: density_of(space, z, "radial").draw_by_rejection(1, rng), questions
    )
    yield Figure("sampling", "fresh, blended radial, rejection", radial, "us", "at most", RADIAL_US)
    blended = _median_us(lambda z: density_of(space, z).draw_by_rejection(1, rng), questions)
    yield Figure("sampling", "fresh, blended multilinear, rejection", blended, "us")
    density = density_of(space, questions[0])
    density.draw(10, rng)
    began = time.perf_counter()
    density.draw(CACHED, rng)
    each = 1e6 * (time.perf_counter() - began) / CACHED
    yield Figure("sampling", f"cached, each of {CACHED}", each, "us", "at most", CACHED_US)
    literal = Literal(space)
    theirs = _median_us(lambda z: literal.draw_one(z, rng), questions[:LITERAL])
    yield Figure("sampling", "the paper's pipeline, as written", theirs, "us", "ours", ours)
    yield Figure("sampling", "the default is faster by", theirs / ours, "times", "at least", TIMES)


def _median_us(draw: Callable[[FloatArray], object], questions: FloatArray) -> float:
    for z in questions[:3]:
        draw(z)
    took = []
    for z in questions:
        began = time.perf_counter_ns()
        draw(z)
        took.append(time.perf_counter_ns() - began)
    return float(np.median(took)) / 1e3


class Literal:
    """The paper's pipeline, each stage with the function that the paper names."""

    def __init__(self, space: BlendingSpace) -> None:
        self.space, self.tree = space, KDTree(space.z)
        self.maps = space.values.astype(np.float64)

    def draw_one(self, z: FloatArray, rng: np.random.Generator) -> FloatArray:
        """Draw one parameter vector as the paper describes it."""
        apart, indices = self.tree.query(z[None], k=self.space.k)
        weights = 1.0 - apart[0] / apart[0].max()
        weights /= weights.sum()
        blended = np.zeros(self.space.grid.size)
        for weight, index in zip(weights, indices[0], strict=True):
            blended += weight * self.maps[index]
        function = Rbf(*self.space.grid.nodes.T, blended)
        most = HEADROOM * blended.max()
        while True:
            point = rng.uniform(0.1, 2.0, 3)
            if rng.uniform(0.0, most) <= function(*point):
                chosen: FloatArray = point
                return chosen


def made_up_space(rng: np.random.Generator) -> tuple[BlendingSpace, FloatArray]:
    """Return a space of synthetic maps, each with one wide peak moved by the dependencies."""
    lengths = rng.choice(np.arange(0.5, 4.5, 0.5), WALKS) + 0.02 * rng.standard_normal(WALKS)
    turning = rng.choice([0.0, 0.32, 0.51, 0.69], WALKS)
    statures = rng.choice(rng.normal(1.78, 0.07, PEOPLE), WALKS)
    vectors = np.stack([lengths, turning, statures], axis=-1)
    peaks = np.stack(
        [
            0.4 + 0.2 * lengths + 0.1 * rng.standard_normal(WALKS),
            1.2 + 0.3 * rng.standard_normal(WALKS),
            1.5 - turning + 0.2 * rng.standard_normal(WALKS),
        ],
        axis=-1,
    )
    away = (PAPER_GRID.nodes[None] - peaks[:, None]) / np.array([0.25, 0.6, 1.0])
    values = np.exp(-(away**2).sum(axis=-1)).astype(MAP_FLOATS)
    space = blending_space(PAPER_GRID, scaling_of(NAMES, vectors), vectors, values, rng=rng)
    return space, vectors
