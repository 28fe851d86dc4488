"""Counterbalancing: the orders of the conditions, and the rows of the ledger that contain them.

All n! orders together are balanced by construction, and so are the few of a Williams design: each
condition is equally often at each position, and each ordered pair of neighbours occurs equally
often. The balance of an explicit list is up to its author. A *block* of the ledger contains every
order once; its rows are shuffled, so that nobody can predict the next order. Blocks are drawn
independently from the study's seed: adding one never changes existing ones.
"""

from itertools import permutations
from typing import NamedTuple

import numpy as np

from app.protocol.study import StudyProtocol
from app.science.williams import williams

Sequence = tuple[str, ...]
"""One order of the conditions, by their keys."""


class LedgerRow(NamedTuple):
    """One slot of the ledger: an order, and the number of its replicate (from 1)."""

    sequence: Sequence
    replicate: int


def sequences(protocol: StudyProtocol) -> tuple[Sequence, ...]:
    """Return every order of the study's design; permutations follow the conditions' file order."""
    keys = [condition.key for condition in protocol.conditions]
    match protocol.orders.design:
        case "all_permutations":
            return tuple(permutations(keys))
        case "williams":
            return tuple(tuple(keys[at] for at in row) for row in williams(len(keys)))
        case "explicit":
            return protocol.orders.sequences or ()


def ledger_block(protocol: StudyProtocol, block_index: int) -> tuple[LedgerRow, ...]:
    """Return the rows of one block, in the order in which they are assigned.

    `block_index` counts from 0 and is the replicate minus one. The rows depend only on the
    conditions' keys, the seed and the index (PCG64 seeded with SeedSequence([seed, block_index])).
    Raises ValueError for a negative index.
    """
    if block_index < 0:
        raise ValueError(f"Block {block_index} does not exist. Blocks count from 0.")
    orders = sequences(protocol)
    seeds = np.random.SeedSequence([protocol.orders.seed, block_index])
    rng = np.random.Generator(np.random.PCG64(seeds))
    return tuple(LedgerRow(orders[at], block_index + 1) for at in rng.permutation(len(orders)))
