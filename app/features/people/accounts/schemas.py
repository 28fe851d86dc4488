"""People of the lab over HTTP."""

from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from app.features.people.accounts.passwords import MAX_LENGTH

Role = Literal["admin", "experimenter", "operator", "analyst"]
StudyKeys = Annotated[list[Annotated[str, Field(max_length=80)]], Field(max_length=500)]
SECRET: dict[str, Any] = {"writeOnly": True}
"""Marks a field that no answer repeats, not even one about what is wrong (`app.api.errors`)."""
Token = Annotated[str, Field(min_length=20, max_length=100, json_schema_extra=SECRET)]
Password = Annotated[str, Field(min_length=1, max_length=MAX_LENGTH, json_schema_extra=SECRET)]


class Credentials(BaseModel):
    """A user name and a password."""

    model_config = ConfigDict(extra="forbid")

    username: str = Field(min_length=1, max_length=80)
    password: Password


class AccountView(BaseModel):
    """Who is signed in."""

    id: str
    username: str
    role: Role


class SignedInView(BaseModel):
    """The answer to a login."""

    account: AccountView


class WhoView(BaseModel):
    """Who is signed in; null where nobody is, which is no error."""

    account: AccountView | None


class NewPassword(BaseModel):
    """A change of one's own password; every other login ends."""

    model_config = ConfigDict(extra="forbid")

    current: Password
    new: Password


class PersonView(BaseModel):
    """An account as the admin sees it. `studies` is null where all are theirs."""

    id: str
    username: str
    role: Role
    studies: list[str] | None
    created_at: datetime
    disabled_at: datetime | None
    logins: int
    last_login_at: datetime | None


class PersonChange(BaseModel):
    """What to change of an account; what is left out stays. `studies` null gives all of them."""

    model_config = ConfigDict(extra="forbid")

    role: Role | None = None
    studies: StudyKeys | None = None
    closed: bool | None = None


class NewInvitation(BaseModel):
    """Whom to invite: `studies` null invites to all; `note` says who it is for."""

    model_config = ConfigDict(extra="forbid")

    role: Role
    note: str = Field(default="", max_length=80)
    studies: StudyKeys | None = None
    hours: float = Field(default=72.0, gt=0, le=24 * 30, allow_inf_nan=False)


class InvitationView(BaseModel):
    """An invitation; its link is told only once, when it is made."""

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
    """A fresh invitation with its link; whoever has the link can use it.

    `only_here`: no other computer can reach the server, so the link works on this one alone.
    """

    url: str
    only_here: bool


class InvitationToken(BaseModel):
    """The part of an invitation's link behind the #."""

    model_config = ConfigDict(extra="forbid")

    token: Token


class InvitationLook(BaseModel):
    """What an invitation is for, before it is accepted."""

    role: Role
    note: str
    expires_at: datetime


class Acceptance(InvitationToken):
    """An invitation accepted under a name and password of one's own choice."""

    username: str = Field(min_length=1, max_length=80)
    password: Password
