"""Store what each run of a headset said that it can do.

Revision: 0016
Revises: 0015
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op


revision: str = "0016"
down_revision: str | None = "0015"
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    with op.batch_alter_table("telemetry_streams") as batch_op:
        batch_op.add_column(
            sa.Column("abilities", sa.JSON(none_as_null=True), nullable=True)
        )


def downgrade() -> None:
    """Revert this revision."""
    with op.batch_alter_table("telemetry_streams") as batch_op:
        batch_op.drop_column("abilities")
