"""Request and response models of the account and invitation endpoints."""

from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from app.features.people.accounts.passwords import MAX_LENGTH

Role = Literal["admin", "experimenter", "operator", "analyst"]
StudyKeys = Annotated[list[Annotated[str, Field(max_length=80)]], Field(max_length=500)]
SECRET: dict[str, Any] = {"writeOnly": True}
"""Marks a field that no response repeats, not even a validation error (`app.api.errors`)."""
Token = Annotated[str, Field(min_length=20, max_length=100, json_schema_extra=SECRET)]
Password = Annotated[str, Field(min_length=1, max_length=MAX_LENGTH, json_schema_extra=SECRET)]


class Credentials(BaseModel):
    """A user name and a password."""

    model_config = ConfigDict(extra="forbid")

    username: str = Field(min_length=1, max_length=80)
    password: Password


class AccountView(BaseModel):
    """The account that is signed in."""

    id: str
    username: str
    role: Role


class SignedInView(BaseModel):
    """The response to a successful login."""

    account: AccountView


class WhoView(BaseModel):
    """The account that is signed in; null (and not an error) if none is."""

    account: AccountView | None


class NewPassword(BaseModel):
    """A request to change one's own password; every other login ends."""

    model_config = ConfigDict(extra="forbid")

    current: Password
    new: Password


class PersonView(BaseModel):
    """An account as an admin sees it. `studies` is null if the account may see all studies."""

    id: str
    username: str
    role: Role
    studies: list[str] | None
    created_at: datetime
    disabled_at: datetime | None
    logins: int
    last_login_at: datetime | None


class PersonChange(BaseModel):
    """Changes to an account; omitted fields stay as they are. `studies` null means all studies."""

    model_config = ConfigDict(extra="forbid")

    role: Role | None = None
    studies: StudyKeys | None = None
    closed: bool | None = None


class NewInvitation(BaseModel):
    """A request for an invitation. `studies` null means all studies; `note` says who it is for."""

    model_config = ConfigDict(extra="forbid")

    role: Role
    note: str = Field(default="", max_length=80)
    studies: StudyKeys | None = None
    hours: float = Field(default=72.0, gt=0, le=24 * 30, allow_inf_nan=False)


class InvitationView(BaseModel):
    """An invitation without its link, which is returned only once, on creation."""

    id: str
    role: Role
    note: str
    studies: list[str] | None
    status: Literal["open", "used", "revoked", "expired"]
    created_by: str
    created_at: datetime
    expires_at: datetime
    used_by: str | None


class InvitedView(InvitationView):
    """A new invitation with its link; anyone who has the link can use it.

    `only_here`: no other computer can reach the server, so the link works only on this one.
    """

    url: str
    only_here: bool


class InvitationToken(BaseModel):
    """The token of an invitation: the part of its link after the #."""

    model_config = ConfigDict(extra="forbid")

    token: Token


class InvitationLook(BaseModel):
    """The content of an invitation, as shown before it is accepted."""

    role: Role
    note: str
    expires_at: datetime


class Acceptance(InvitationToken):
    """A request to accept an invitation, with the user name and password the person chose."""

    username: str = Field(min_length=1, max_length=80)
    password: Password
