"""Tests of the bodies that are stored when a server starts."""

import pytest
from sqlalchemy import select

from app.clock import Clock
from app.features.movement.humanoids import add_shipped_bodies
from app.features.movement.humanoids.shipped import SHIPPED_BODIES
from app.models import HumanoidRow
from app.resources import bodies_dir
from tests.features.lab import Lab, ok

PATH = "/api/humanoids"


def named(lab: Lab) -> dict[str | None, str]:
    """Return the hashes of all bodies by their names."""
    return {one["name"]: one["content_hash"] for one in ok(lab.operator.get(PATH))["humanoids"]}


def test_a_new_installation_has_three_bodies(fresh_lab: Lab) -> None:
    """A new installation has three bodies with all parts; another start changes nothing."""
    before = named(fresh_lab)
    assert sorted(map(str, before)) == sorted(SHIPPED_BODIES)
    view = ok(fresh_lab.operator.get(f"{PATH}/{before['female']}"))
    assert (view["origin"], view["by"], view["absent"]) == ("shipped", "system", [])
    assert (view["left_fingers"], view["right_fingers"], view["pieces"]) == (5, 5, 52)
    sent = fresh_lab.operator.get(f"{PATH}/{before['female']}/file")
    assert sent.content == (bodies_dir() / "female.glb").read_bytes()
    with fresh_lab.database.writing() as db:
        add_shipped_bodies(db, Clock().utc_now())
    assert named(fresh_lab) == before


@pytest.mark.one_engine
def test_a_name_never_comes_to_mean_another_body(fresh_lab: Lab) -> None:
    """A shipped body whose name another body has is stored without a name."""
    hashes = named(fresh_lab)
    with fresh_lab.database.writing() as db:
        rows = {row.name: row for row in db.scalars(select(HumanoidRow))}
        rows["neutral"].name = None
        db.flush()
        rows["female"].name = "neutral"  # the lab's own body, let us say
        db.delete(rows["male"])
        db.flush()
        rows["neutral"].name = "male"
    with fresh_lab.database.writing() as db:
        add_shipped_bodies(db, Clock().utc_now())
    after = named(fresh_lab)
    assert after[None] == hashes["male"]
    assert (after["neutral"], after["male"]) == (hashes["female"], hashes["neutral"])
