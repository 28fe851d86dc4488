"""Store a configuration without taking back what somebody else has saved meanwhile.

A file does not say from which version it was made. So an avatar with several versions gets another
one only if that is known: from the source of an edit, or by --based-on.
"""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from app.cli.avatar.library import Library, Stored, ToStore
from app.cli.avatar.sources import Source
from app.errors import NotFound, StaleVersion
from app.protocol.avatar import loaded
from app.protocol.avatar_editing import ValueChange, differences, sums_by_group
from app.science.avatar.configuration import Configuration


@dataclass(frozen=True)
class Saved:
    """A stored version, the number of the newest one before it, and what differs between them.

    `before` is None for a new avatar, and the version itself if it had this content already.
    """

    row: dict[str, Any]
    before: int | None
    changes: tuple[ValueChange, ...]

    @property
    def as_json(self) -> dict[str, Any]:
        """Return the version for scripts."""
        changed = [change_json(one) for one in self.changes]
        return {**self.row, "before": self.before, "changed": changed}


@dataclass(frozen=True)
class ToSave:
    """A configuration to save under a key; `number`: the version it was made from, if known."""

    configuration: Configuration
    key: str
    title: str | None
    note: str
    number: int | None
    loaded: bool

    def stored(self, library: Library) -> Saved:
        """Store it under the new key, or as the next version of the avatar.

        Raises ValueError if the avatar has several versions and `number` is None, StaleVersion if
        it is not the newest one, and what the library refuses. Then nothing was stored.
        """
        newest = _newest(library, self.key)
        if newest is None:
            if self.number is not None:
                raise NotFound(
                    f"there is no avatar {self.key!r} that has a version {self.number}",
                    value=self.key,
                    remedy="Leave --based-on out to save a new avatar. Nothing was stored.",
                )
            return Saved(library.store(self._for_version(None)), None, ())
        changes = tuple(differences(newest.configuration, self.configuration))
        if loaded(newest.configuration).content_hash != loaded(self.configuration).content_hash:
            self._require_descent(library, newest, changes)
        return Saved(library.store(self._for_version(newest.number)), newest.number, changes)

    def _require_descent(
        self, library: Library, newest: Stored, changes: Sequence[ValueChange]
    ) -> None:
        """Raise an error unless the configuration was made from the newest version."""
        if self.number == newest.number or (self.number is None and newest.number == 1):
            return
        differ = "\n".join(changes_by_group(changes))
        anyway = f"--based-on {newest.number}"
        if self.number is None:
            raise ValueError(
                f"{self.key} has {newest.number} versions, and it is not known from which one this"
                f" was made. From version {newest.number}, the newest, it differs in:\n{differ}\n"
                f"If that is all you changed, give {anyway}; else give the version that you began"
                " from, to see what has been saved since. Nothing was stored."
            )
        if self.number > newest.number:
            raise NotFound(
                f"the avatar {self.key!r} has no version {self.number}",
                value=self.number,
                valid=f"1 to {newest.number}",
                remedy="Nothing was stored.",
            )
        begun_from = library.version(self.key, self.number).configuration
        meanwhile = changes_by_group(differences(begun_from, newest.configuration))
        mine, theirs = f"{self.key}@{self.number}", f"{self.key}@{newest.number}"
        told = (
            f"this was made from {mine}; {theirs} has been saved since. Between them differ:",
            *(meanwhile or ["  no values"]),
            f"Stored now, it would differ from {theirs} in:",
            differ,
        )
        raise StaleVersion(
            "\n".join(told),
            value=self.number,
            remedy=f"Nothing was stored. Make your changes to {theirs}, or give {anyway} to store"
            " it as it is",
        )

    def _for_version(self, number: int | None) -> ToStore:
        return ToStore(
            self.configuration, self.key, self.title, self.note, self.loaded, based_on=number
        )


def based_on(given: int | None, source: Source, key: str) -> int | None:
    """Return from which version of the avatar `key` a source was made: as given, or itself."""
    if given is None and source.saved is not None and source.saved[0] == key:
        return source.saved[1]
    return given


def changes_by_group(changes: Sequence[ValueChange]) -> list[str]:
    """Format changed values: those of the whole body one by one, the others summed by group."""
    return list(_by_group(changes))


def change_json(change: ValueChange) -> dict[str, Any]:
    """Return a changed value for scripts, with the same keys as over HTTP."""
    return {**asdict(change), "groups": list(change.groups)}


def _newest(library: Library, key: str) -> Stored | None:
    try:
        return library.version(key, None)
    except NotFound:
        return None


def _by_group(changes: Sequence[ValueChange]) -> Iterator[str]:
    for one in changes:
        if one.part is None and not one.is_compliance:
            unit = f" {one.unit}" if one.unit else ""
            yield f"  {one.path}: {_shown(one.old)} -> {_shown(one.new)}{unit}"
    for group, (parts, values) in sums_by_group(changes).items():
        number = f"{values} value{'' if values == 1 else 's'}"
        yield f"  {group}: {number} of {', '.join(parts) or 'the whole group'}"


def _shown(value: Any) -> str:
    if value is None:
        return "none"
    return f"{value:g}" if isinstance(value, float) else str(value)
