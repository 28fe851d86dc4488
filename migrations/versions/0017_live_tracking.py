"""Add the doors for tracking software, and which tracker is on which limb.

Revision: 0017
Revises: 0016
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op

import app.models.types


revision: str = "0017"
down_revision: str | None = "0016"
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    op.create_table(
        "live_doors",
        sa.Column("door", sa.String(length=20), nullable=False),
        sa.Column("is_open", sa.Boolean(), nullable=False),
        sa.Column("interface", sa.String(length=45), nullable=False),
        sa.Column("port", sa.Integer(), nullable=False),
        sa.Column("server", sa.String(length=45), nullable=True),
        sa.Column("multicast", sa.Boolean(), nullable=False),
        sa.Column("by", sa.String(length=100), nullable=False),
        sa.Column("at", app.models.types.UtcDateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("door", name=op.f("pk_live_doors")),
    )
    op.create_table(
        "live_limbs",
        sa.Column("door", sa.String(length=20), nullable=False),
        sa.Column("source", sa.String(length=64), nullable=False),
        sa.Column("tracker", sa.String(length=64), nullable=False),
        sa.Column("limb", sa.String(length=40), nullable=False),
        sa.Column("by", sa.String(length=100), nullable=False),
        sa.Column("at", app.models.types.UtcDateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("door", "source", "tracker", name=op.f("pk_live_limbs")),
    )


def downgrade() -> None:
    """Revert this revision."""
    op.drop_table("live_limbs")
    op.drop_table("live_doors")
