"""What every encoding takes and gives back, and how it says that a chunk is damaged."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


class DamagedChunkError(ValueError):
    """The bytes of a chunk are not what was written; says what gave it away and what to do."""

    def __init__(self, what: str) -> None:
        super().__init__(
            f"a chunk of movement is damaged: {what}; restore it from a backup of the database"
        )


@dataclass(frozen=True)
class Columns:
    """The frames of a chunk: `times_s` (n,), `flags` (n,), `values` (n, w), of any bits at all."""

    times_s: NDArray[np.float64]
    flags: NDArray[np.uint8]
    values: NDArray[np.float32]
