"""Add humanoid models.

Revision: 0007
Revises: 0006
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op

import app.models.types


revision: str = '0007'
down_revision: str | None = '0006'
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    op.create_table('humanoids',
    sa.Column('hash', sa.String(length=64), nullable=False),
    sa.Column('file_name', sa.String(length=200), nullable=False),
    sa.Column('figure', sa.Text(), nullable=False),
    sa.Column('bones_by', sa.String(length=20), nullable=False),
    sa.Column('stature_m', sa.Double(), nullable=False),
    sa.Column('parts', sa.Integer(), nullable=False),
    sa.Column('pieces', sa.Integer(), nullable=False),
    sa.Column('left_fingers', sa.Integer(), nullable=False),
    sa.Column('right_fingers', sa.Integer(), nullable=False),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.CheckConstraint("bones_by IN ('vrm', 'names')", name=op.f('ck_humanoids_bones_by')),
    sa.ForeignKeyConstraint(['hash'], ['capture_contents.hash'], name=op.f('fk_humanoids_hash_capture_contents')),
    sa.PrimaryKeyConstraint('hash', name=op.f('pk_humanoids'))
    )


def downgrade() -> None:
    """Revert this revision."""
    op.drop_table('humanoids')
