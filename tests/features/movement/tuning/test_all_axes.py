"""A test that the page's tuning of axes gives what the command gives, to the last bit."""

import json
from pathlib import Path
from typing import Any

import pytest

from app.protocol.avatar import load_avatar
from app.science.avatar.mjcf import default_configuration
from tests.cli.invoked import Invoked
from tests.features.lab import Json, Lab, error, ok
from tests.features.movement.tuning.tunings import PATH, settled

pytestmark = pytest.mark.one_engine

PAGE: Json = {
    "heuristic": "critical",
    "mirror": False,
    "attempts": 3,
    "accepted_overshoot_percent": 5,
    "longest_s": 10,
    "longest_wall_s": 20,
    "relay_torques_nm": {},
}
"""The options that the page of the editor sends, beside the axes."""
DRIVEN = tuple(
    name for name in default_configuration().axes if name not in default_configuration().locked_axes
)
OF_EACH_GROUP = (
    *("SpineX", "HeadY", "LeftUpperLegX", "RightFootX", "LeftToesX"),
    *("LeftUpperArmZ", "RightLowerArmY", "RightHandZ", "LeftIndexProximalZ"),
)


def exactly(figures: Any) -> str:
    """Return figures as text in which every bit of a number counts."""
    return json.dumps(figures, sort_keys=True)


@pytest.mark.parametrize(
    "axes",
    [
        pytest.param(OF_EACH_GROUP, id="some of each group"),
        pytest.param(None, id="all", marks=pytest.mark.long),
    ],
)
def test_the_page_and_the_command_give_the_same_gains(
    lab: Lab, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, axes: tuple[str, ...] | None
) -> None:
    """The page's order of `standard` and `reembody tune` agree on every axis, to the last bit.

    The figures of each experiment are compared, then the gains of the configuration that the page
    takes over with those of the file that the command writes.
    """
    chosen = axes or DRIVEN
    assert len(DRIVEN) == 89
    order = {"avatar": {"key": "standard"}, "options": PAGE | {"axes": axes}}
    started = ok(lab.operator.post(PATH, json=order))
    monkeypatch.setenv("REEMBODY_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.delenv("REEMBODY_DATABASE_URL", raising=False)
    (tmp_path / "data").mkdir()
    written = tmp_path / "tuned.json"
    named = [word for axis in axes or () for word in ("--axis", axis)]
    command = Invoked("tune").figures("--avatar", "standard", *named, "--out", written)
    page = settled(lab, started["id"])
    assert page["state"] == "ready", page["trouble"]
    assert exactly(page["report"]["axes"]) == exactly(command["axes"])
    assert sum(one["status"] in ("tuned", "retried", "flagged") for one in page["tuned"]) == len(
        chosen
    )
    path = f"{PATH}/{page['id']}/configuration"
    taken = ok(lab.operator.post(path, json={"accepted": chosen}))["configuration"]["axes"]
    gains = load_avatar(written.read_text()).configuration.axes
    assert {
        name: (one["kp_nm_per_rad"], one["kd_nm_s_per_rad"]) for name, one in taken.items()
    } == {name: (one.kp, one.kd) for name, one in gains.items()}
    # The gains are new ones: equality is no accident of nothing having been done.
    assert all(gains[name].kp != default_configuration().axes[name].kp for name in chosen)
    locked = sorted(set(gains) - set(DRIVEN))
    told = error(lab.operator.post(path, json={"accepted": locked}), 422, "invalid_input")
    assert told["value"] == locked[0]
