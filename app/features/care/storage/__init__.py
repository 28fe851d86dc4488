"""Report what uses disk space, and for how many more sessions there is enough.

Measuring takes seconds, so one `StorageMeter` measures for all requests and caches the result.
"""

from app.features.care.storage.measuring import StorageMeter
from app.features.care.storage.recovery import StorageRecovery

__all__ = ["StorageMeter", "StorageRecovery"]
