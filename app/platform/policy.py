"""The roles that may call each route: one table, read by the dependencies and by the tests.

A route that is not listed is denied to everybody, so a new one is closed until it is added here.
Which *objects* of a route a caller may see (their studies, their sessions) is decided in `access`.

Roles of people: an *admin* runs the installation, an *experimenter* designs and runs studies, an
*operator* runs sessions and never learns the condition in a blinded study, an *analyst* reads
pseudonymous data and changes nothing. Devices are paired with one session: a *tablet* and a
*headset* have access to that session only.
"""

ADMIN = frozenset({"admin"})
DESIGNERS = frozenset({"admin", "experimenter"})
RUNNERS = frozenset({"admin", "experimenter", "operator"})
READERS = frozenset({"admin", "experimenter", "analyst"})
LAB = frozenset({"admin", "experimenter", "operator", "analyst"})
ANYONE = frozenset({"anyone"})
TABLET = frozenset({"tablet"})
HEADSET = frozenset({"headset"})

POLICY: dict[str, frozenset[str]] = {
    # Without a login.
    "GET /api/health": ANYONE,
    "GET /api/me": ANYONE,
    "POST /api/login": ANYONE,
    "POST /api/logout": ANYONE,
    "POST /api/devices/pair": ANYONE,
    "GET /api/tablet/paired": ANYONE,
    "POST /api/invitations/look": ANYONE,
    "POST /api/invitations/accept": ANYONE,
    # Accounts and the installation.
    "PUT /api/me/password": LAB,
    "GET /api/accounts": ADMIN,
    "PATCH /api/accounts/{account_id}": ADMIN,
    "DELETE /api/accounts/{account_id}/logins": ADMIN,
    "GET /api/invitations": ADMIN,
    "POST /api/invitations": ADMIN,
    "DELETE /api/invitations/{invitation_id}": ADMIN,
    "GET /api/audit": ADMIN,
    "GET /api/audit/check": ADMIN,
    "GET /api/network": RUNNERS,
    "GET /api/storage": DESIGNERS,
    # Studies: their protocols, orders and progress.
    "GET /api/studies": LAB,
    "POST /api/studies": DESIGNERS,
    "GET /api/studies/{key}": LAB,
    "GET /api/studies/{key}/sessions": LAB,
    "GET /api/studies/{key}/ledger": LAB,
    "POST /api/studies/{key}/sessions": RUNNERS,
    # A scripted participant, marked as simulated, for trying out a session.
    "POST /api/studies/{key}/tryout": DESIGNERS,
    "GET /api/tryout": DESIGNERS,
    "DELETE /api/tryout": DESIGNERS,
    "POST /api/studies/{key}/versions": DESIGNERS,
    "POST /api/studies/{key}/archive": DESIGNERS,
    "POST /api/studies/{key}/restore": DESIGNERS,
    "POST /api/studies/{key}/duplicate": DESIGNERS,
    "GET /api/studies/{key}/versions/{number}": READERS,
    "GET /api/studies/{key}/diff": READERS,
    "POST /api/studies/{key}/diff": READERS,
    "GET /api/study-schema": READERS,
    "GET /api/templates": READERS,
    "POST /api/studies/check": READERS,
    "POST /api/studies/edit": READERS,
    "POST /api/studies/timeline": READERS,
    "GET /api/studies/{key}/suggestions": LAB,
    "POST /api/studies/{key}/suggestions": RUNNERS,
    "POST /api/suggestions/{suggestion_id}/decision": DESIGNERS,
    # The latency of the equipment itself.
    "GET /api/calibrations": LAB,
    "POST /api/calibrations": DESIGNERS,
    "POST /api/calibrations/{calibration_id}/retire": DESIGNERS,
    # Instruments contain nothing confidential of a study.
    "GET /api/instruments": LAB,
    "GET /api/instruments/{key}": LAB,
    "POST /api/instruments": DESIGNERS,
    "POST /api/instruments/check": LAB,
    "POST /api/instruments/score": LAB,
    # Captures of movement belong to the lab, not to a study.
    "GET /api/captures": LAB,
    "POST /api/captures": DESIGNERS,
    "GET /api/captures/{capture_id}": LAB,
    "PATCH /api/captures/{capture_id}": DESIGNERS,
    "DELETE /api/captures/{capture_id}": DESIGNERS,
    "GET /api/captures/{capture_id}/file": LAB,
    "GET /api/captures/{capture_id}/motion": LAB,
    "GET /api/captures/{capture_id}/joint-map": LAB,
    "PUT /api/captures/{capture_id}/joint-map": DESIGNERS,
    "DELETE /api/captures/{capture_id}/joint-map": DESIGNERS,
    "GET /api/captures/{capture_id}/verification": LAB,
    "GET /api/captures/{capture_id}/retargeted": LAB,
    "GET /api/captures/{capture_id}/retargeted-motion": LAB,
    # Avatar configurations belong to the lab as well.
    "GET /api/avatars": LAB,
    "POST /api/avatars": DESIGNERS,
    "POST /api/avatars/check": DESIGNERS,
    "GET /api/avatars/{key}": LAB,
    "GET /api/avatars/{key}/model": LAB,
    "POST /api/avatars/{key}/versions": DESIGNERS,
    "GET /api/avatars/{key}/versions/{number}": LAB,
    "GET /api/avatars/{key}/versions/{number}/file": LAB,
    # Bodies: humanoid models that participants wear.
    "GET /api/humanoids": LAB,
    "POST /api/humanoids": DESIGNERS,
    "GET /api/humanoids/{content_hash}": LAB,
    "GET /api/humanoids/{content_hash}/binding": LAB,
    "PATCH /api/humanoids/{content_hash}": DESIGNERS,
    "POST /api/humanoids/{content_hash}/measure": DESIGNERS,
    "GET /api/humanoids/{content_hash}/use": LAB,
    "GET /api/humanoids/{content_hash}/file": LAB,
    # Walking: scenes, walks, and the models that are fitted to them.
    "GET /api/walking/scenes": LAB,
    "POST /api/walking/scenes": DESIGNERS,
    "GET /api/walking/scenes/{scene_key}": LAB,
    "DELETE /api/walking/scenes/{scene_key}": DESIGNERS,
    "GET /api/walking/scenes/{scene_key}/file": LAB,
    "GET /api/walking/populations": LAB,
    "GET /api/walking/walk-sets": LAB,
    "POST /api/walking/walk-sets": DESIGNERS,
    "POST /api/walking/walk-sets/tracks": DESIGNERS,
    "GET /api/walking/walk-sets/{set_id}": LAB,
    "DELETE /api/walking/walk-sets/{set_id}": DESIGNERS,
    "GET /api/walking/models": LAB,
    "POST /api/walking/models": DESIGNERS,
    "GET /api/walking/models/{model_id}": LAB,
    "DELETE /api/walking/models/{model_id}": DESIGNERS,
    "POST /api/walking/models/{model_id}/stop": DESIGNERS,
    "POST /api/walking/models/{model_id}/resume": DESIGNERS,
    "GET /api/walking/models/{model_id}/file": LAB,
    "POST /api/walking/models/{model_id}/prediction": LAB,
    "POST /api/walking/models/{model_id}/slice": LAB,
    "POST /api/walking/paths": LAB,
    # Results. Operators run sessions; comparing conditions is not part of their role.
    "GET /api/studies/{key}/codebook": READERS,
    "GET /api/studies/{key}/dashboard": READERS,
    "GET /api/studies/{key}/dashboard/{figure}/rows": READERS,
    "GET /api/studies/{key}/statistics": READERS,
    "GET /api/studies/{key}/export": READERS,
    "POST /api/studies/{key}/exports": READERS,
    "GET /api/exports": READERS,
    "GET /api/exports/{export_id}": READERS,
    "DELETE /api/exports/{export_id}": READERS,
    "GET /api/exports/{export_id}/file": READERS,
    "GET /api/studies/{key}/preregistration": READERS,
    "GET /api/studies/{key}/preregistration/report": READERS,
    # Answers that were collected elsewhere.
    "POST /api/studies/{key}/imports/look": DESIGNERS,
    "POST /api/studies/{key}/imports/check": DESIGNERS,
    "POST /api/studies/{key}/imports": DESIGNERS,
    "POST /api/studies/{key}/imports/erase": DESIGNERS,
    "POST /api/studies/{key}/imports/{import_id}/undo": DESIGNERS,
    "GET /api/studies/{key}/imports": READERS,
    "GET /api/studies/{key}/imports/{import_id}": READERS,
    "GET /api/studies/{key}/imports/{import_id}/table": READERS,
    # Participants' rights.
    "GET /api/studies/{key}/participants": DESIGNERS,
    "POST /api/studies/{key}/participants/{participant_id}/erasure": DESIGNERS,
    "GET /api/studies/{key}/participants/{participant_id}/access": DESIGNERS,
    "POST /api/sessions/{session_id}/submissions/{submission_id}/corrections": DESIGNERS,
    "GET /api/studies/{key}/copies": DESIGNERS,
    "POST /api/copies/{copy_id}/destroyed": DESIGNERS,
    # One session.
    "GET /api/sessions/{session_id}": LAB,
    "GET /api/sessions/{session_id}/live": LAB,
    "WEBSOCKET /api/sessions/{session_id}/pose": LAB,
    "GET /api/sessions/{session_id}/events": LAB,
    "GET /api/sessions/{session_id}/alarms": LAB,
    "GET /api/sessions/{session_id}/receipt": LAB,
    "GET /api/sessions/{session_id}/streams": LAB,
    "GET /api/sessions/{session_id}/answers": LAB,
    "GET /api/sessions/{session_id}/phases/{phase_id}/replay": LAB,
    "GET /api/sessions/{session_id}/phases/{phase_id}/movement": LAB,
    "GET /api/sessions/{session_id}/administration": RUNNERS,
    "GET /api/sessions/{session_id}/consent": RUNNERS,
    "GET /api/sessions/{session_id}/preflight": RUNNERS,
    "POST /api/sessions/{session_id}/preflight/overrides": RUNNERS,
    "GET /api/sessions/{session_id}/avatar-choices": RUNNERS,
    "POST /api/sessions/{session_id}/commands": RUNNERS,
    "POST /api/sessions/{session_id}/submissions": RUNNERS,
    "POST /api/sessions/{session_id}/pairings": RUNNERS,
    "POST /api/sessions/{session_id}/reveal": DESIGNERS,
    "DELETE /api/sessions/{session_id}/devices/{device_id}": RUNNERS,
    "POST /api/sessions/{session_id}/help/answered": RUNNERS,
    # A paired device, for its own session.
    "GET /api/tablet/state": TABLET,
    "POST /api/tablet/consent": TABLET,
    "GET /api/tablet/live": TABLET,
    "PUT /api/tablet/language": TABLET,
    "PUT /api/tablet/help": TABLET,
    "PUT /api/tablet/question": TABLET,
    "PUT /api/tablet/refusal": TABLET,
    "POST /api/tablet/acknowledge": TABLET,
    "POST /api/tablet/submissions": TABLET,
    "POST /api/vr/avatar": HEADSET,
    "GET /api/vr/bodies/{content_hash}/file": HEADSET,
    "GET /api/vr/bodies/{content_hash}/binding": HEADSET,
    "GET /api/vr/form": HEADSET,
    "POST /api/vr/submissions": HEADSET,
    "POST /api/vr/acknowledge": HEADSET,
    "PUT /api/vr/language": HEADSET,
    "WEBSOCKET /api/vr/stream": HEADSET,
}


def allowed(method: str, template: str) -> frozenset[str]:
    """Return the roles that may call a route, by its path template; empty if it is not listed."""
    return POLICY.get(f"{method.upper()} {template}", frozenset())
