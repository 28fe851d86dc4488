"""Browser test of a visit in the headset's page in which the wearer crosses the study's road."""

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.features.record.headset.site import Site
from tests.rehearsal.test_road import short_study
from tests.support.browser import ContextFactory
from tests.support.vr_visit import QUICK, Visit, begun, journey_script, ok

MOST_PICTURES = 6
Json = dict[str, Any]


def _pictured(visit: Visit, folder: str | None) -> Callable[[Json], bool]:
    """Return what ends nothing, and saves what both eyes see now and then on the road."""
    taken = 0

    def look(view: Json) -> bool:
        nonlocal taken
        current = view["current"]
        if folder is None or current is None:
            return False
        if view["steps"][current["index"]]["kind"] == "road_crossing" and taken < MOST_PICTURES:
            taken += 1
            (Path(folder) / f"road-{taken}.png").write_bytes(visit.headset.picture())
        return False

    return look


def test_a_wearer_crosses_the_road_between_cars_and_walks_back_without(
    headset_site: Site, new_context: ContextFactory, tmp_path: Path
) -> None:
    """The page says where the wearer is at every step, so that crossings and gaps are measured.

    The first block ends on the other side; the second begins on the start square all the same.
    With REEMBODY_PICTURES set to a folder, what both eyes see on the way is saved there.
    """
    server, operator = headset_site.server, headset_site.operator
    ok(operator.post("/api/studies", json={"yaml": short_study()}))
    visit, tablet = begun(
        operator,
        new_context(),
        journey_script(tmp_path),
        server.url,
        "road-short",
        time_scale=10.0,
        traits=QUICK,
    )
    with tablet:
        view = visit.perform(until=_pictured(visit, os.environ.get("REEMBODY_PICTURES")))
    assert tablet.error is None
    assert view["status"] == "completed"
    crossed = [one for one in view["phases"] if one["kind"] == "road_crossing"]
    assert [(one["status"], one["completions"]) for one in crossed] == [("done", 1)] * 2
    road = ok(operator.get(f"/api/sessions/{visit.session_id}/road"))
    assert [(run["ended"], run["part"]) for run in road["runs"]] == [("complete", 1)] * 2
    for run in road["runs"]:
        (there,) = run["crossings"]
        assert there["is_across"]
        assert there["steps_on_s"] < there["steps_off_s"]
        assert there["closest_m"] is not None
        record = operator.get(f"/api/sessions/{visit.session_id}/road/{run['id']}").content
        first = json.loads(record.splitlines()[1])
        (wearer,) = (one for one in first["actors"] if one["name"] == "participant")
        # The start square's middle is 0.8 m behind the near kerb, which is at -2.5 m.
        assert abs(wearer["y_m"] + 3.3) < 0.5
