"""A PostgreSQL with durable settings: committed data survive a power loss."""

from collections.abc import Iterator
from contextlib import contextmanager

from tests.benchmarks.load.scenario import Store
from tests.support.postgres import SETTINGS, Cluster, start_keeper, stop_keeper
from tests.support.shared_run import close_run, open_run, run_folder

# The settings of the tests, without those that trade durability for speed.
DURABLE = {**SETTINGS, "fsync": "on", "full_page_writes": "on", "synchronous_commit": "on"}
DATABASE = "reembody"


@contextmanager
def durable_postgres() -> Iterator[Store]:
    """Yield an empty database in a cluster of its own, removed afterwards."""
    open_run()
    folder = run_folder() / "durable"
    try:
        keeper_pid = start_keeper(folder, DURABLE)
        try:
            cluster = Cluster(folder)
            cluster.execute("CREATE DATABASE {}", DATABASE)
            yield Store(cluster.url(DATABASE), {"PostgreSQL": keeper_pid})
        finally:
            stop_keeper(keeper_pid, folder)
    finally:
        close_run()
