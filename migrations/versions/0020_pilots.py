"""Add the pilots of studies: simulated cohorts and power runs.

Revision: 0020
Revises: 0019
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op

import app.models.types


revision: str = "0020"
down_revision: str | None = "0019"
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    op.create_table(
        "pilots",
        sa.Column("id", sa.String(length=32), nullable=False),
        sa.Column("study_id", sa.String(length=32), nullable=False),
        sa.Column("study_version_id", sa.String(length=32), nullable=False),
        sa.Column("kind", sa.String(length=20), nullable=False),
        sa.Column("options", sa.JSON(), nullable=False),
        sa.Column("assumptions", sa.Text(), nullable=True),
        sa.Column("state", sa.String(length=20), nullable=False),
        sa.Column("summary", sa.JSON(), nullable=True),
        sa.Column("record", sa.Text(), nullable=True),
        sa.Column("trouble", sa.Text(), nullable=True),
        sa.Column("by", sa.String(length=100), nullable=False),
        sa.Column("at", app.models.types.UtcDateTime(timezone=True), nullable=False),
        sa.Column("ended_at", app.models.types.UtcDateTime(timezone=True), nullable=True),
        sa.CheckConstraint(
            "state IN ('simulating', 'stopped', 'ready', 'failed')", name=op.f("ck_pilots_state")
        ),
        sa.CheckConstraint("kind IN ('cohort', 'power')", name=op.f("ck_pilots_kind")),
        sa.ForeignKeyConstraint(
            ["study_id"], ["studies.id"], name=op.f("fk_pilots_study_id_studies")
        ),
        sa.ForeignKeyConstraint(
            ["study_version_id"],
            ["study_versions.id"],
            name=op.f("fk_pilots_study_version_id_study_versions"),
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_pilots")),
    )
    with op.batch_alter_table("pilots") as batch_op:
        batch_op.create_index(batch_op.f("ix_pilots_at"), ["at"], unique=False)
        batch_op.create_index(batch_op.f("ix_pilots_study_id"), ["study_id"], unique=False)
        batch_op.create_index(
            batch_op.f("ix_pilots_study_version_id"), ["study_version_id"], unique=False
        )


def downgrade() -> None:
    """Revert this revision."""
    with op.batch_alter_table("pilots") as batch_op:
        batch_op.drop_index(batch_op.f("ix_pilots_study_version_id"))
        batch_op.drop_index(batch_op.f("ix_pilots_study_id"))
        batch_op.drop_index(batch_op.f("ix_pilots_at"))
    op.drop_table("pilots")
