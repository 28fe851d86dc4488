"""Add the tunings of avatars.

Revision: 0015
Revises: 0014
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op

import app.models.types


revision: str = "0015"
down_revision: str | None = "0014"
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    op.create_table(
        "avatar_tunings",
        sa.Column("id", sa.String(length=32), nullable=False),
        sa.Column("key", sa.String(length=80), nullable=True),
        sa.Column("number", sa.Integer(), nullable=True),
        sa.Column("content_hash", sa.String(length=64), nullable=False),
        sa.Column("canonical_json", sa.Text(), nullable=False),
        sa.Column("stature_m", sa.Double(), nullable=False),
        sa.Column("options", sa.JSON(), nullable=False),
        sa.Column("state", sa.String(length=20), nullable=False),
        sa.Column("summary", sa.JSON(), nullable=True),
        sa.Column("trouble", sa.Text(), nullable=True),
        sa.Column("by", sa.String(length=100), nullable=False),
        sa.Column("at", app.models.types.UtcDateTime(timezone=True), nullable=False),
        sa.Column("ended_at", app.models.types.UtcDateTime(timezone=True), nullable=True),
        sa.CheckConstraint(
            "state IN ('tuning', 'stopped', 'ready', 'failed')",
            name=op.f("ck_avatar_tunings_state"),
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_avatar_tunings")),
    )
    with op.batch_alter_table("avatar_tunings") as batch_op:
        batch_op.create_index(batch_op.f("ix_avatar_tunings_at"), ["at"], unique=False)


def downgrade() -> None:
    """Revert this revision."""
    with op.batch_alter_table("avatar_tunings") as batch_op:
        batch_op.drop_index(batch_op.f("ix_avatar_tunings_at"))
    op.drop_table("avatar_tunings")
