"""The avatar of a session as its headset takes it up."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from app.protocol.avatar import AvatarFile

Length = Annotated[float, Field(gt=0.0, le=3.0, allow_inf_nan=False)]


class AvatarWish(BaseModel):
    """Whose body it is: the participant's stature, and what else was measured of it.

    `segments_m`: lengths by the names of docs/avatar-configuration.md; the others follow from the
    stature.
    """

    model_config = ConfigDict(extra="forbid")

    stature_m: Annotated[float, Field(ge=0.5, le=2.6, allow_inf_nan=False)]
    segments_m: Annotated[dict[str, Length], Field(max_length=40)] = {}


class SessionAvatar(BaseModel):
    """A physics avatar in its study's scene, to be simulated as it stands.

    `mjcf` is the MuJoCo model with the boxes of all tasks, each named after its surface; the client
    shows those of the present phase. `model_hash` is the SHA-256 of its bytes and
    `configuration_hash` that of the configuration, both as they are on record. Added latency is set
    while it runs, up to `longest_delay_s`. `standing_hips_m`: how high its hips are when it stands;
    a model may have other legs than the participant, whose hips' height is scaled to it.
    """

    stature_m: float
    configuration_hash: str
    configuration: AvatarFile
    model_hash: str
    mjcf: str
    longest_delay_s: float
    standing_hips_m: float
