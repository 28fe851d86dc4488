"""What a running application is made of; built once in `create_app`, handed to every request."""

from dataclasses import dataclass, field

from app.clock import Clock
from app.database import Database
from app.features.care.storage.measuring import StorageDesk
from app.features.movement.captures.workbench import Workbench
from app.features.movement.walking.bench import Bench
from app.features.movement.walking.desk import FittingDesk
from app.features.record.tryout.desk import TryoutDesk
from app.features.results.analysis.drawing import Drawings
from app.features.results.exports.desk import ExportDesk
from app.features.results.replay.desk import ReplayDesk
from app.lan.network import Network
from app.platform.hub import Hub
from app.platform.rate_limit import RateLimiter
from app.platform.storage_health import StorageHealth
from app.settings import Settings


@dataclass(frozen=True)
class AppContext:
    """The parts that services need, by name."""

    settings: Settings
    database: Database
    clock: Clock
    hub: Hub
    storage: StorageHealth
    login_limiter: RateLimiter
    pairing_limiter: RateLimiter
    drawings: Drawings
    replays: ReplayDesk
    exports: ExportDesk
    room: StorageDesk
    tryout: TryoutDesk
    fits: FittingDesk
    captures: Workbench = field(default_factory=Workbench)
    walking: Bench = field(default_factory=Bench)
    network: Network = field(default_factory=Network)
