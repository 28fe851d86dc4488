"""Record which completed sessions do not count, and why.

Revision: 0012
Revises: 0011
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op


revision: str = '0012'
down_revision: str | None = '0011'
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None

OUTCOME = "outcome IN ('open', 'completed', 'withdrawn', 'aborted', 'invalid')"
OLD_OUTCOME = "outcome IN ('open', 'completed', 'withdrawn', 'aborted')"


def _outcomes(condition: str) -> None:
    """Replace the constraint on the outcomes of a slot attempt."""
    name = op.f('ck_slot_attempts_outcome')
    with op.batch_alter_table('slot_attempts') as batch_op:
        batch_op.drop_constraint(name, type_='check')
        batch_op.create_check_constraint(name, condition)


def upgrade() -> None:
    """Apply this revision."""
    op.add_column('sessions', sa.Column('shortfalls', sa.JSON(), nullable=True))
    _outcomes(OUTCOME)


def downgrade() -> None:
    """Revert this revision."""
    op.execute("UPDATE slot_attempts SET outcome = 'aborted' WHERE outcome = 'invalid'")
    _outcomes(OLD_OUTCOME)
    op.drop_column('sessions', 'shortfalls')
