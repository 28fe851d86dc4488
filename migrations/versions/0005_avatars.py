"""Add avatar configurations, and the one that each session used.

Revision: 0005
Revises: 0004
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op

import app.models.types


revision: str = '0005'
down_revision: str | None = '0004'
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    op.create_table('avatars',
    sa.Column('key', sa.String(length=80), nullable=False),
    sa.Column('title', sa.String(length=200), nullable=False),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.PrimaryKeyConstraint('key', name=op.f('pk_avatars'))
    )
    op.create_table('avatar_versions',
    sa.Column('key', sa.String(length=80), nullable=False),
    sa.Column('number', sa.Integer(), autoincrement=False, nullable=False),
    sa.Column('content_hash', sa.String(length=64), nullable=False),
    sa.Column('canonical_json', sa.Text(), nullable=False),
    sa.Column('origin', sa.String(length=20), nullable=False),
    sa.Column('note', sa.Text(), nullable=False),
    sa.Column('report', sa.JSON(), nullable=True),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.CheckConstraint("origin IN ('shipped', 'tuned', 'by_hand', 'loaded')", name=op.f('ck_avatar_versions_origin')),
    sa.ForeignKeyConstraint(['key'], ['avatars.key'], name=op.f('fk_avatar_versions_key_avatars')),
    sa.PrimaryKeyConstraint('key', 'number', name=op.f('pk_avatar_versions'))
    )
    with op.batch_alter_table('avatar_versions', schema=None) as batch_op:
        batch_op.create_index(batch_op.f('ix_avatar_versions_content_hash'), ['content_hash'], unique=False)

    with op.batch_alter_table('sessions', schema=None) as batch_op:
        batch_op.add_column(sa.Column('avatar_configuration_hash', sa.String(length=64), nullable=True))


def downgrade() -> None:
    """Revert this revision."""
    with op.batch_alter_table('sessions', schema=None) as batch_op:
        batch_op.drop_column('avatar_configuration_hash')

    with op.batch_alter_table('avatar_versions', schema=None) as batch_op:
        batch_op.drop_index(batch_op.f('ix_avatar_versions_content_hash'))

    op.drop_table('avatar_versions')
    op.drop_table('avatars')
