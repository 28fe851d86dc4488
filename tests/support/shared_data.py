"""Locate the published data that tests and benchmarks compare with.

They are not part of the repository. This module does not import pytest, since a benchmark should
not spend time on that.
"""

import os
from pathlib import Path

SHARED_DATA_VARIABLE = "REEMBODY_SHARED_DATA"
BESIDE = Path(__file__).resolve().parents[3] / "shared" / "data"


def shared_data_folder() -> Path:
    """Return the folder that $REEMBODY_SHARED_DATA names, else the one next to the repository.

    The caller must check whether it exists.
    """
    return Path(os.environ.get(SHARED_DATA_VARIABLE) or BESIDE)
