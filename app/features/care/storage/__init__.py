"""Report the use of disk space, and how many more sessions fit on the disk.

Measuring takes seconds, so one `StorageMeter` measures for all requests and caches the result.
"""

from app.features.care.storage.measuring import StorageMeter
from app.features.care.storage.recovery import StorageRecovery

__all__ = ["StorageMeter", "StorageRecovery"]
