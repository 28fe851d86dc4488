"""A short study for pilots, and what waits until a pilot has ended."""

import re
import time

from tests.features.lab import Json, Lab, ok
from tests.protocol.helpers import CONFIGS

KEY, TEMPLATE = "two-latencies", "two-latencies-hand"
PATH = f"/api/studies/{KEY}/pilots"


def short_study() -> str:
    """Return a study of two boxes and two latencies, with phases of 3 s and a delayed copy.

    Its ledger is closed after twelve people.
    """
    text = (CONFIGS / "templates" / f"{TEMPLATE}.yaml").read_text(encoding="utf-8")
    text = re.sub(r"duration_s: 60", "duration_s: 3", text)
    text = re.sub(r" +- \{number: [34], center_m.*\n", "", text)
    text = text.replace("when_full: grow", "when_full: closed")
    return re.sub(r"avatar: physics\navatar_configuration: .*", "avatar: delayed_copy", text)


def ordered(lab: Lab, path: str = PATH, **request: object) -> Json:
    """Order a pilot and return it as the page shows it."""
    view: Json = ok(lab.operator.post(path, json=request))
    return view


def settled(lab: Lab, pilot_id: str, path: str = PATH) -> Json:
    """Wait until a pilot has ended, and return it."""
    for _ in range(1200):
        view: Json = ok(lab.operator.get(f"{path}/{pilot_id}"))
        if view["state"] != "simulating":
            return view
        time.sleep(0.05)
    raise AssertionError(f"still simulated: {view['progress']}")
