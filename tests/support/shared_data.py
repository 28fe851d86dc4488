"""Where the published data are that tests and benchmarks compare with.

They are not part of the repository. No pytest here: a benchmark should pay for itself alone.
"""

import os
from pathlib import Path

SHARED_DATA_VARIABLE = "REEMBODY_SHARED_DATA"
BESIDE = Path(__file__).resolve().parents[3] / "shared" / "data"


def shared_data_folder() -> Path:
    """The folder that $REEMBODY_SHARED_DATA names, else the one beside the repository.

    Whether it exists is for the caller to find out.
    """
    return Path(os.environ.get(SHARED_DATA_VARIABLE) or BESIDE)
