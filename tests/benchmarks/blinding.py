"""Search every output of a blinded study for a condition that the reader must not know.

For each status of a session there is a study (`tests/faults/blinded_world.py`) whose conditions
have names and latencies that occur nowhere else. Every GET of the OpenAPI document is requested by
every role for every study; archives are unpacked; export files are requested, tracked and fetched;
errors are provoked; the pose socket and the live stream are read. Finding the condition where it
must not be known is a leak. Where it may be known it must be found, or the search would prove
nothing.

Out of scope: computing a delay from frames. The avatar's frames themselves count as a leak.
"""

import tempfile
from pathlib import Path

from app.schema_revisions import migrate
from tests.api.people import ROLES
from tests.benchmarks.report import Figure, Report
from tests.faults.blinded_world import (
    WORLDS,
    Search,
    build_world,
    call_errors,
    fetch,
    fetch_jobs,
    get_routes,
    listen,
    people,
)
from tests.features.lab import running_lab

PARTS = ROLES


def measure(parts: frozenset[str]) -> Report:
    """Search everything that each role can fetch."""
    report, search = Report("blinding"), Search()
    with (
        tempfile.TemporaryDirectory(prefix="reembody-blinding-") as folder,
        running_lab(_migrated(Path(folder) / "reembody.sqlite"), data_dir=Path(folder)) as lab,
    ):
        all_ = build_world(lab)
        routes = get_routes(lab)
        for role, client in people(lab).items():
            if role not in parts:
                continue
            before, leaked = search.fetched.total(), len(search.leaks)
            fetch(search, role, client, all_, routes)
            fetch_jobs(search, role, client, all_)
            call_errors(search, role, client, all_)
            for one in all_:
                listen(lab, search, role, client, one)
            report.add(
                Figure(role, "answers and files searched", search.fetched.total() - before, ""),
                Figure(role, "leaks", len(search.leaks) - leaked, "", "at most", 0),
            )
    if parts - {"operator"}:
        found = search.found_where_known
        report.add(Figure("search", "found where it may be known", found, "", "at least", 1))
    report.beside = {
        "routes": len(search.routes),
        "roles": [role for role in ROLES if role in parts],
        "statuses": list(WORLDS),
        "ways_out": dict(search.fetched),
        "answers_by_status": {str(code): n for code, n in sorted(search.statuses.items())},
        "leaks": search.leaks,
    }
    return report


def _migrated(file: Path) -> str:
    url = f"sqlite:///{file}"
    migrate(url)
    return url
