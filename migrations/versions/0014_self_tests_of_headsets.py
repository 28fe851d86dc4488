"""Store the self-tests of headsets.

Revision: 0014
Revises: 0013
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op

import app.models.types


revision: str = "0014"
down_revision: str | None = "0013"
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    op.create_table(
        "headset_tests",
        sa.Column("id", sa.String(length=32), nullable=False),
        sa.Column("started_at", app.models.types.UtcDateTime(timezone=True), nullable=False),
        sa.Column("received_at", app.models.types.UtcDateTime(timezone=True), nullable=False),
        sa.Column("status", sa.String(length=10), nullable=False),
        sa.Column("worn", sa.Boolean(), nullable=False),
        sa.Column("report", sa.JSON(), nullable=False),
        sa.Column("verdicts", sa.JSON(), nullable=False),
        sa.CheckConstraint(
            "status IN ('ok', 'warn', 'fail')", name=op.f("ck_headset_tests_status")
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_headset_tests")),
    )
    op.create_index(op.f("ix_headset_tests_started_at"), "headset_tests", ["started_at"])
    op.create_table(
        "headset_test_batches",
        sa.Column("trial_id", sa.String(length=32), nullable=False),
        sa.Column("stream", sa.String(length=20), nullable=False),
        sa.Column("seq_first", sa.BigInteger(), autoincrement=False, nullable=False),
        sa.Column("received_at", app.models.types.UtcDateTime(timezone=True), nullable=False),
        sa.Column("message", sa.LargeBinary(), nullable=False),
        sa.PrimaryKeyConstraint(
            "trial_id", "stream", "seq_first", name=op.f("pk_headset_test_batches")
        ),
    )


def downgrade() -> None:
    """Revert this revision."""
    op.drop_table("headset_test_batches")
    op.drop_index(op.f("ix_headset_tests_started_at"), table_name="headset_tests")
    op.drop_table("headset_tests")
