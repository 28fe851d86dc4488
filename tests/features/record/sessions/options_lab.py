"""Sessions of the study with practice, signed consent and a stop rule, over HTTP."""

from typing import Any

from httpx2 import Response

from tests.features.lab import Json, Lab, key, ok
from tests.protocol.options import KEY, with_options

FMS = "block1.fms"


def joined(lab: Lab, **fields: Any) -> Json:
    """Create a session of the study with options, storing the study first if it is missing."""
    if lab.operator.get(f"/api/studies/{KEY}").status_code == 404:
        ok(lab.operator.post("/api/studies", json={"yaml": with_options()}))
    view: Json = ok(lab.operator.post(f"/api/studies/{KEY}/sessions", json=fields))
    return view


def answer_fms(lab: Lab, session_id: str, value: int | None) -> Response:
    """Enter the participant's sickness rating as the operator; None leaves it out."""
    form = ok(lab.operator.get(f"/api/sessions/{session_id}/administration"))
    body = {
        "idempotency_key": key(),
        "administration": form["key"],
        "answers": {"sickness": value},
        "shown_order": form["item_order"],
        "seed": form["seed"],
        "language": "en",
    }
    return lab.operator.post(f"/api/sessions/{session_id}/submissions", json=body)
