"""What a running application is made of; built once in `create_app`, handed to every request."""

from dataclasses import dataclass, field

from app.clock import Clock
from app.database import Database
from app.features.analysis.drawing import Drawings
from app.features.live import Hub
from app.features.rate_limit import RateLimiter
from app.features.storage_health import StorageHealth
from app.lan.network import Network
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
    network: Network = field(default_factory=Network)
