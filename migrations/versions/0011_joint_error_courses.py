"""Add the time course of a phase's joint error.

Revision: 0011
Revises: 0010
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op


revision: str = '0011'
down_revision: str | None = '0010'
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    op.create_table('joint_error_courses',
    sa.Column('session_id', sa.String(length=32), nullable=False),
    sa.Column('phase_id', sa.Integer(), autoincrement=False, nullable=False),
    sa.Column('reference', sa.String(length=20), nullable=False),
    sa.Column('bin_s', sa.Double(), nullable=False),
    sa.Column('mean_rad', sa.JSON(), nullable=False),
    sa.Column('samples', sa.JSON(), nullable=False),
    sa.ForeignKeyConstraint(['session_id', 'phase_id'], ['phases.session_id', 'phases.phase_id'], name=op.f('fk_joint_error_courses_session_id_phase_id_phases')),
    sa.PrimaryKeyConstraint('session_id', 'phase_id', 'reference', name=op.f('pk_joint_error_courses'))
    )


def downgrade() -> None:
    """Revert this revision."""
    op.drop_table('joint_error_courses')
