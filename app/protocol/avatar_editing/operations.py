"""Define every operation that edits an avatar configuration, as JSON names it.

The console's page, the command `reembody avatar edit` and Python scripts all send these operations
to `edited` (`applying`), so that the same edit has the same content hash wherever it is made. An
operation has its own model, whose key `operation` names it, and is listed in `Operation`; its
method `applied` makes the edit with the functions of app.science.avatar.configuration.

`targets` name body groups, parts or axes, as in `left_arm`, `LeftHand`, `LeftHandZ`; a whole body
is `all`. Angles are in degrees from the T-pose.

Source: Karas (2020), chapters 2, 4 and 6: the functions of its editor.
"""

from typing import Annotated, Any, get_args

from pydantic import Field

from app.protocol.avatar_editing.axis_operations import (
    ConvertTemplate,
    EditJoint,
    Mirror,
    SetAxes,
    SetGains,
    SetJoints,
    SetLimits,
    SetMotion,
)
from app.protocol.avatar_editing.body_operations import (
    Load,
    Lock,
    RemoveParts,
    SetBody,
    SetColliders,
    SetCompliance,
    SetDelays,
    SetLayers,
    SetMasses,
    SetModel,
    Unlock,
)
from app.protocol.avatar_editing.operation import AvatarOperation

Operation = Annotated[
    SetGains
    | SetLimits
    | SetMotion
    | SetAxes
    | EditJoint
    | SetJoints
    | ConvertTemplate
    | Mirror
    | SetMasses
    | SetBody
    | SetModel
    | SetColliders
    | SetLayers
    | SetDelays
    | SetCompliance
    | Lock
    | Unlock
    | RemoveParts
    | Load,
    Field(discriminator="operation"),
]
"""Every operation. To add one, define its model above and list it here."""


def operation_models() -> dict[str, type[AvatarOperation]]:
    """Return the model of every operation by its name, in the order of `Operation`."""
    union: Any = get_args(Operation)[0]
    return {get_args(one.model_fields["operation"].annotation)[0]: one for one in get_args(union)}
