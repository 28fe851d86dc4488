"""Use DuckDB as a peer: it writes arrays that are in memory as CSV.

Run by the interpreter of the peer's own environment, this file is also the program that does so:
`python duckdb_csv.py ARRAY.npy OUT.csv` prints the seconds of the writing alone.
"""

import subprocess
import sys
import time
from pathlib import Path

VERSION = "2.0.1"


def seconds_to_write(array: Path, to: Path) -> float:
    """Return the seconds that DuckDB takes to write a stored array (rows, columns) as CSV.

    Raises:
        NoPeer: DuckDB could not be installed.
    """
    from tests.benchmarks.peers.environment import python_peer

    programs = python_peer("duckdb", f"duckdb=={VERSION}", "numpy>=2,<3")
    done = subprocess.run(
        [programs / "python", __file__, array, to], capture_output=True, text=True, check=True
    )
    return float(done.stdout)


def _write(array: str, to: str) -> float:
    import duckdb  # type: ignore[import-not-found]  # only in the peer's environment
    import numpy as np

    values = np.load(array)
    columns = {f"c{number}": np.ascontiguousarray(one) for number, one in enumerate(values.T)}
    connection = duckdb.connect()
    connection.register("samples", columns)
    began_s = time.monotonic()
    connection.execute(f"COPY samples TO '{to}' (HEADER, DELIMITER ',')")
    return time.monotonic() - began_s


if __name__ == "__main__":
    print(_write(*sys.argv[1:]))
