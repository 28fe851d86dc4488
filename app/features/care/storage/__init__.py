"""What takes how much room, and for how many more sessions there is some.

Looking takes seconds, so one `StorageDesk` looks for everybody and keeps what it saw.
"""

from app.features.care.storage.measuring import StorageDesk
from app.features.care.storage.recovery import StorageRecovery

__all__ = ["StorageDesk", "StorageRecovery"]
