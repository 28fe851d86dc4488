"""Who may call what: one table, read by the dependencies that let people in and by the tests.

A route that is not listed is refused for everybody, so a new one is closed until it is put here.
Which *objects* of a route somebody may see (their studies, their sessions) is decided in `access`.

Roles of people: an *admin* runs the installation, an *experimenter* designs and runs studies, an
*operator* runs sessions and never learns the condition where a study is blinded, an *analyst*
reads pseudonymous data and changes nothing. Devices are paired with one session: a *tablet* and a
*headset* open that session only.
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
    # Before anybody is known.
    "GET /api/health": ANYONE,
    "GET /api/me": ANYONE,
    "POST /api/login": ANYONE,
    "POST /api/logout": ANYONE,
    "POST /api/devices/pair": ANYONE,
    "POST /api/invitations/look": ANYONE,
    "POST /api/invitations/accept": ANYONE,
    # The lab's people.
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
    # Studies: what they ask, in which order, and how far they are.
    "GET /api/studies": LAB,
    "POST /api/studies": DESIGNERS,
    "GET /api/studies/{key}": LAB,
    "GET /api/studies/{key}/sessions": LAB,
    "GET /api/studies/{key}/ledger": LAB,
    "POST /api/studies/{key}/sessions": RUNNERS,
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
    # How slow the equipment itself is.
    "GET /api/calibrations": LAB,
    "POST /api/calibrations": DESIGNERS,
    "POST /api/calibrations/{calibration_id}/retire": DESIGNERS,
    # Instruments hold no study's secrets.
    "GET /api/instruments": LAB,
    "GET /api/instruments/{key}": LAB,
    "POST /api/instruments": DESIGNERS,
    "POST /api/instruments/check": LAB,
    "POST /api/instruments/score": LAB,
    # What came out. An operator runs sessions; comparing conditions is not part of it.
    "GET /api/studies/{key}/codebook": READERS,
    "GET /api/studies/{key}/dashboard": READERS,
    "GET /api/studies/{key}/export": READERS,
    # What participants may ask for.
    "GET /api/studies/{key}/participants": DESIGNERS,
    "POST /api/studies/{key}/participants/{participant_id}/erasure": DESIGNERS,
    "GET /api/studies/{key}/participants/{participant_id}/access": DESIGNERS,
    "POST /api/sessions/{session_id}/submissions/{submission_id}/corrections": DESIGNERS,
    "GET /api/studies/{key}/copies": DESIGNERS,
    "POST /api/copies/{copy_id}/destroyed": DESIGNERS,
    # One session.
    "GET /api/sessions/{session_id}": LAB,
    "GET /api/sessions/{session_id}/live": LAB,
    "GET /api/sessions/{session_id}/events": LAB,
    "GET /api/sessions/{session_id}/alarms": LAB,
    "GET /api/sessions/{session_id}/receipt": LAB,
    "GET /api/sessions/{session_id}/streams": LAB,
    "GET /api/sessions/{session_id}/answers": LAB,
    "GET /api/sessions/{session_id}/administration": RUNNERS,
    "GET /api/sessions/{session_id}/consent": RUNNERS,
    "POST /api/sessions/{session_id}/commands": RUNNERS,
    "POST /api/sessions/{session_id}/submissions": RUNNERS,
    "POST /api/sessions/{session_id}/pairings": RUNNERS,
    "POST /api/sessions/{session_id}/reveal": DESIGNERS,
    "DELETE /api/sessions/{session_id}/devices/{device_id}": RUNNERS,
    # A paired device, for its own session.
    "GET /api/tablet/state": TABLET,
    "POST /api/tablet/consent": TABLET,
    "GET /api/tablet/live": TABLET,
    "PUT /api/tablet/language": TABLET,
    "POST /api/tablet/acknowledge": TABLET,
    "POST /api/tablet/submissions": TABLET,
    "WEBSOCKET /api/vr/stream": HEADSET,
}


def allowed(method: str, template: str) -> frozenset[str]:
    """Who may call a route, by its path template; nobody where it is not listed."""
    return POLICY.get(f"{method.upper()} {template}", frozenset())
