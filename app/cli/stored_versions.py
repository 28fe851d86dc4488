"""Verify the stored versions of avatars, studies and instruments, for the command `verify`."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from sqlalchemy.orm import Session

from app.features.design.instruments import faulty_instruments
from app.features.design.studies import faulty_studies
from app.features.movement.avatar import faulty_avatars
from app.platform.config_problems import FaultKind, StoredFault

_KINDS: dict[str, Callable[[Session], tuple[int, list[StoredFault]]]] = {
    "avatars": faulty_avatars,
    "studies": faulty_studies,
    "instruments": faulty_instruments,
}
_SAID: dict[FaultKind, str] = {
    "damaged": "damaged in the database",
    "unreadable": "not readable by this release",
    "incomplete": "not usable, though unaltered",
}


@dataclass(frozen=True)
class StoredVersions:
    """All stored versions of one kind of content, and what is wrong with some of them."""

    kind: str
    count: int
    faults: tuple[StoredFault, ...]

    @property
    def holds(self) -> bool:
        """Whether all can be read as they were stored; incomplete ones are unaltered."""
        return all(one.kind == "incomplete" for one in self.faults)

    def text(self) -> str:
        """Return a paragraph that names every version with a fault, and what to do."""
        if not self.faults:
            return (
                f"The {self.kind} verify: all {self.count} versions are complete, and their content"
                " has its hash."
            )
        verdict = "verify" if self.holds else "do not verify"
        head = (
            f"The {self.kind} {verdict}: {len(self.faults)} of {self.count} versions have a fault."
        )
        return "\n".join([head, *self._named()])

    def _named(self) -> Iterator[str]:
        for kind, said in _SAID.items():
            found = [one for one in self.faults if one.kind == kind]
            if not found:
                continue
            yield f"  {said}: {', '.join(map(_name, found))}."
            for one in found:
                if kind != "damaged":
                    yield f"    {_name(one)}: {one.problem}"
            yield f"    {found[0].remedy}"

    def as_json(self) -> dict[str, Any]:
        """Return the findings for scripts."""
        by_kind: dict[str, Any] = {
            kind: [
                {"key": one.key, "version": one.version, "problem": one.problem}
                for one in self.faults
                if one.kind == kind
            ]
            for kind in _SAID
        }
        return {"ok": self.holds, "versions": self.count, **by_kind}


def verified_versions(db: Session) -> list[StoredVersions]:
    """Check every stored version of every kind."""
    found = {kind: faulty(db) for kind, faulty in _KINDS.items()}
    return [StoredVersions(kind, count, tuple(faults)) for kind, (count, faults) in found.items()]


def _name(fault: StoredFault) -> str:
    number = "of an unknown number" if fault.version is None else str(fault.version)
    return f"{fault.key} version {number}"
