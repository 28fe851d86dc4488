"""The parts of a running application, built once in `create_app` and passed to every request.

A part that every request may need has a name here. A feature that keeps something alive between
requests (a process, a queue, a thread) adds a `Part`, which the application starts and stops with
itself, and which the feature looks up by its class. So this module depends on no feature.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeVar

from app.clock import Clock
from app.database import Database
from app.lan import Network
from app.platform.admission import Admission
from app.platform.background import Background
from app.platform.hub import Hub
from app.platform.rate_limit import Limits
from app.platform.storage_health import StorageHealth
from app.settings import Settings


class Part:
    """A component that lives as long as the server."""

    def start(self) -> None:
        """Start the component; the database is already open and migrated."""
        return

    def stop(self) -> None:
        """Stop the component with all its threads and processes."""
        return


P = TypeVar("P", bound=Part)


@dataclass(frozen=True)
class AppContext:
    """The parts that services need, by name, and the features' own parts, by class."""

    settings: Settings
    database: Database
    clock: Clock
    hub: Hub
    storage: StorageHealth
    background: Background
    limits: Limits
    admission: Admission
    network: Network = field(default_factory=Network)
    _parts: dict[type[Part], Part] = field(default_factory=dict)

    def add(self, part: Part) -> None:
        """Add a feature's part, at most one of each class."""
        self._parts[type(part)] = part

    @property
    def parts(self) -> tuple[Part, ...]:
        """The features' parts, in the order in which they were added."""
        return tuple(self._parts.values())

    def part(self, kind: type[P]) -> P:
        """Return the part of this class; raise KeyError if the application has none."""
        part = self._parts[kind]
        assert isinstance(part, kind)  # noqa: S101 - narrows what `add` keeps under its class
        return part


PartMaker = Callable[[AppContext], Part]
"""Makes a feature's part from the context, which contains the parts made before it."""
