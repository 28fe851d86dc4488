"""A study once more with an avatar that physics moves, for a rehearsal of it."""

import re
from typing import Any

from httpx2 import AsyncClient

from app.client import ServerRefusedError, call

SUFFIX = "-physics"
AVATAR = "standard"
_KEY = re.compile(r"^key: .*$", re.MULTILINE)
_MOVED = re.compile(r"^avatar: delayed_copy[ \t]*$", re.MULTILINE)


class NoVariantError(ValueError):
    """The study has no form with a physics avatar; says why."""


async def physics_variant(http: AsyncClient, study: str) -> str:
    """The key of the study itself if physics moves its avatar, else of its copy that has one.

    The copy is made where it is missing, and gets a version where the study has changed since. It
    differs in its key and in what moves the avatar: the newest version of the standard one.

    Raises:
        NoVariantError: the file cannot be changed at these places. ServerRefusedError.
    """
    view: dict[str, Any] = await call(http, "GET", f"/api/studies/{study}")
    text = view["yaml"] or ""
    if (view["protocol"] or {}).get("avatar") == "physics":
        return study
    if len(_MOVED.findall(text)) != 1 or len(_KEY.findall(text)) != 1:
        raise NoVariantError(
            f"the file of {study!r} does not say `avatar: delayed_copy` on a line of its own; make"
            " a version of it with a physics avatar (docs/avatar-configuration.md)"
        )
    newest = (await call(http, "GET", f"/api/avatars/{AVATAR}"))["newest"]["number"]
    key = study + SUFFIX
    chosen = f"avatar: physics\navatar_configuration: {{key: {AVATAR}, version: {newest}}}"
    changed = _MOVED.sub(chosen, _KEY.sub(f"key: {key}", text))
    try:
        known = await call(http, "GET", f"/api/studies/{key}")
    except ServerRefusedError as error:
        if error.code != "not_found":
            raise
        await call(http, "POST", "/api/studies", {"yaml": changed})
        return key
    if known["yaml"] != changed:
        await call(http, "POST", f"/api/studies/{key}/versions", {"yaml": changed})
    return key
