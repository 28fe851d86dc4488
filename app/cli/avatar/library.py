"""The avatars of a lab: in the database of this installation, or behind the URL of a server."""

import json
from dataclasses import dataclass
from typing import Any, Protocol

from sqlalchemy.orm import Session

from app.cli.avatar.remote import RemoteServer
from app.cli.avatars import lab_database, written
from app.clock import Clock
from app.features.movement.avatar import (
    NewAvatar,
    NewAvatarVersion,
    add_avatar_version,
    all_versions,
    create_avatar,
    typed,
    version_of,
)
from app.features.people.audit import COMMAND_LINE
from app.models import AvatarVersion
from app.protocol.avatar import AvatarFile, configuration_of, file_of
from app.science.avatar.configuration import Configuration

_COMMAND = "avatar"


@dataclass(frozen=True)
class Stored:
    """A saved version of an avatar."""

    key: str
    number: int
    configuration: Configuration


@dataclass(frozen=True)
class ToStore:
    """A configuration to store under a new key, or as the next version of an avatar.

    `title` is that of a new avatar, None for its key; `loaded`: it was read from a file unchanged;
    `based_on`: the version from which it was made, None for a new avatar.
    """

    configuration: Configuration
    key: str
    title: str | None
    note: str
    loaded: bool
    based_on: int | None

    @property
    def fields(self) -> dict[str, Any]:
        """What a new avatar and a new version have in common."""
        return {
            "origin": "loaded" if self.loaded else "by_hand",
            "note": self.note,
            "configuration": file_of(self.configuration),
        }


class Library(Protocol):
    """The avatars of a lab with their versions."""

    def listed(self) -> list[dict[str, Any]]:
        """Return the avatars with their versions, oldest first."""

    def version(self, key: str, number: int | None) -> Stored:
        """Return a saved version, the newest for None; raises NotFound."""

    def store(self, new: ToStore) -> dict[str, Any]:
        """Store a configuration; raises InvalidConfig with every problem, StaleVersion."""


def library_of(url: str | None, token: str | None) -> Library:
    """Return the library behind a URL, or without one that of this installation.

    Raises ValueError if the token that belongs to the URL is missing, or has none.
    """
    if url is None and token is None:
        return Installation()
    if url is None:
        raise ValueError("--token is that of a server: give its --url, too, or neither")
    if token is None:
        raise ValueError(
            f"--url {url} needs --token; make one on the server's machine with: reembody token"
        )
    return Server(RemoteServer(url, token))


class Installation:
    """The avatars in this installation's database; its server may run meanwhile."""

    def listed(self) -> list[dict[str, Any]]:
        """Return the avatars with their versions, oldest first."""
        with lab_database(_COMMAND) as database, database.reading() as db:
            return [
                {
                    "key": avatar.key,
                    "title": avatar.title,
                    "versions": [_version_json(row) for row in rows],
                }
                for avatar, rows in all_versions(db)
            ]

    def version(self, key: str, number: int | None) -> Stored:
        """Return a saved version, the newest for None; raises NotFound."""
        with lab_database(_COMMAND) as database, database.reading() as db:
            row = version_of(db, key, number)
            return Stored(row.key, row.number, typed(row))

    def store(self, new: ToStore) -> dict[str, Any]:
        """Store a configuration; raises InvalidConfig with every problem, StaleVersion."""
        with lab_database(_COMMAND) as database:
            row = written(database, lambda db: _appended(db, new))
            return {"key": row.key, **_version_json(row)}


class Server:
    """The avatars of a running server, asked over HTTP in the name of the token's account."""

    def __init__(self, server: RemoteServer) -> None:
        self._server = server

    def listed(self) -> list[dict[str, Any]]:
        """Return the avatars with their versions, oldest first."""
        views = [
            self._server.get(f"/api/avatars/{one['key']}")
            for one in self._server.get("/api/avatars")
        ]
        return [
            {
                "key": view["key"],
                "title": view["title"],
                "versions": [_as_listed(one) for one in reversed(view["versions"])],
            }
            for view in views
        ]

    def version(self, key: str, number: int | None) -> Stored:
        """Return a saved version, the newest for None; raises NotFound."""
        if number is None:
            found = self._server.get(f"/api/avatars/{key}")["newest"]
        else:
            found = self._server.get(f"/api/avatars/{key}/versions/{number}")
        content = AvatarFile.model_validate_json(json.dumps(found["configuration"]))
        return Stored(key, found["number"], configuration_of(content))

    def store(self, new: ToStore) -> dict[str, Any]:
        """Store a configuration; raises what the server refuses."""
        fields = {
            **new.fields,
            "configuration": new.fields["configuration"].model_dump(mode="json"),
        }
        if new.based_on is None:
            named = {"key": new.key, "title": new.title or new.key}
            view = self._server.post("/api/avatars", {**fields, **named})
        else:
            path = f"/api/avatars/{new.key}/versions"
            view = self._server.post(path, {**fields, "based_on": new.based_on})
        return {"key": view["key"], **_as_listed(view["newest"])}


def _appended(db: Session, new: ToStore) -> AvatarVersion:
    now = Clock().utc_now()
    if new.based_on is None:
        created = NewAvatar(key=new.key, title=new.title or new.key, **new.fields)
        return create_avatar(db, COMMAND_LINE, created, now)
    more = NewAvatarVersion(based_on=new.based_on, **new.fields)
    return add_avatar_version(db, COMMAND_LINE, new.key, more, now)


def _version_json(row: AvatarVersion) -> dict[str, Any]:
    return {
        "version": row.number,
        "content_hash": row.content_hash,
        "origin": row.origin,
        "note": row.note,
        "by": row.by,
        "at": row.at.isoformat(),
    }


def _as_listed(view: dict[str, Any]) -> dict[str, Any]:
    """Return a version of the HTTP interface with the keys of the command."""
    names = ("content_hash", "origin", "note", "by", "at")
    return {"version": view["number"], **{name: view[name] for name in names}}
