"""Add the share of samples in which limits clipped the target of an avatar's joint.

Revision: 0006
Revises: 0005
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op


revision: str = '0006'
down_revision: str | None = '0005'
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    with op.batch_alter_table('joint_errors', schema=None) as batch_op:
        batch_op.add_column(sa.Column('clipped_share', sa.Double(), nullable=True))


def downgrade() -> None:
    """Revert this revision."""
    with op.batch_alter_table('joint_errors', schema=None) as batch_op:
        batch_op.drop_column('clipped_share')
