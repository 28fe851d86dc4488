"""The order in which items are shown: random, but the same again from the same seed."""

import numpy as np

from app.science.instruments.model import Instrument


def item_order(instrument: Instrument, seed: int) -> tuple[str, ...]:
    """Item keys in the order to show them.

    If the instrument shuffles, all items but those in `last` come in a random order drawn from
    PCG64 seeded with `seed` (>= 0); those in `last` follow as listed. Otherwise the order is
    that of the instrument, again with `last` at the end. Raises ValueError for a negative seed.
    """
    free = [item.key for item in instrument.items if item.key not in instrument.last]
    if instrument.shuffle:
        rng = np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed)))
        free = [free[index] for index in rng.permutation(len(free))]
    return (*free, *instrument.last)
