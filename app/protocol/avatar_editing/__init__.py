"""Edit avatar configurations: operations as JSON, their results, and differences.

`edited` applies operations to a configuration. The page, the command and scripts use it alike.
"""

from app.protocol.avatar_editing.applying import (
    Edited,
    Loss,
    OperationProblem,
    edited,
    fits_single_template,
)
from app.protocol.avatar_editing.difference import (
    SEPARATE_GROUPS,
    ValueChange,
    differences,
    sums_by_group,
)
from app.protocol.avatar_editing.operation import AvatarOperation, Versions
from app.protocol.avatar_editing.operations import Operation, operation_models
from app.protocol.avatar_editing.reading import read_operations

__all__ = [
    "SEPARATE_GROUPS",
    "AvatarOperation",
    "Edited",
    "Loss",
    "Operation",
    "OperationProblem",
    "ValueChange",
    "Versions",
    "differences",
    "edited",
    "fits_single_template",
    "operation_models",
    "read_operations",
    "sums_by_group",
]
