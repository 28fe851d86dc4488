"""Add captures.

Revision: 0004
Revises: 0003
"""

from collections.abc import Sequence

import sqlalchemy as sa
from alembic import op

import app.models.types


revision: str = '0004'
down_revision: str | None = '0003'
branch_labels: str | Sequence[str] | None = None
depends_on: str | Sequence[str] | None = None


def upgrade() -> None:
    """Apply this revision."""
    op.create_table('capture_contents',
    sa.Column('hash', sa.String(length=64), nullable=False),
    sa.Column('size', sa.BigInteger(), nullable=False),
    sa.PrimaryKeyConstraint('hash', name=op.f('pk_capture_contents'))
    )
    op.create_table('joint_maps',
    sa.Column('fingerprint', sa.String(length=64), nullable=False),
    sa.Column('version', sa.Integer(), autoincrement=False, nullable=False),
    sa.Column('chosen', sa.Boolean(), nullable=False),
    sa.Column('joint_map', sa.JSON(), nullable=False),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.PrimaryKeyConstraint('fingerprint', 'version', name=op.f('pk_joint_maps'))
    )
    op.create_table('capture_pieces',
    sa.Column('hash', sa.String(length=64), nullable=False),
    sa.Column('number', sa.Integer(), autoincrement=False, nullable=False),
    sa.Column('data', sa.LargeBinary(), nullable=False),
    sa.ForeignKeyConstraint(['hash'], ['capture_contents.hash'], name=op.f('fk_capture_pieces_hash_capture_contents')),
    sa.PrimaryKeyConstraint('hash', 'number', name=op.f('pk_capture_pieces'))
    )
    op.create_table('captures',
    sa.Column('id', sa.String(length=32), nullable=False),
    sa.Column('identity', sa.String(length=64), nullable=False),
    sa.Column('title', sa.String(length=200), nullable=False),
    sa.Column('file_name', sa.String(length=200), nullable=False),
    sa.Column('content_hash', sa.String(length=64), nullable=False),
    sa.Column('companion_name', sa.String(length=200), nullable=True),
    sa.Column('companion_hash', sa.String(length=64), nullable=True),
    sa.Column('format', sa.String(length=40), nullable=False),
    sa.Column('kind', sa.String(length=20), nullable=False),
    sa.Column('frames', sa.Integer(), nullable=False),
    sa.Column('rate_hz', sa.Double(), nullable=False),
    sa.Column('duration_s', sa.Double(), nullable=False),
    sa.Column('tracks', sa.Integer(), nullable=False),
    sa.Column('fingerprint', sa.String(length=64), nullable=True),
    sa.Column('reading', sa.JSON(), nullable=False),
    sa.Column('summary', sa.JSON(), nullable=False),
    sa.Column('by', sa.String(length=100), nullable=False),
    sa.Column('at', app.models.types.UtcDateTime(timezone=True), nullable=False),
    sa.CheckConstraint("kind IN ('skeleton', 'markers', 'bodies')", name=op.f('ck_captures_kind')),
    sa.ForeignKeyConstraint(['companion_hash'], ['capture_contents.hash'], name=op.f('fk_captures_companion_hash_capture_contents')),
    sa.ForeignKeyConstraint(['content_hash'], ['capture_contents.hash'], name=op.f('fk_captures_content_hash_capture_contents')),
    sa.PrimaryKeyConstraint('id', name=op.f('pk_captures')),
    sa.UniqueConstraint('identity', name=op.f('uq_captures_identity'))
    )
    with op.batch_alter_table('captures', schema=None) as batch_op:
        batch_op.create_index(batch_op.f('ix_captures_at'), ['at'], unique=False)
        batch_op.create_index(batch_op.f('ix_captures_companion_hash'), ['companion_hash'], unique=False)
        batch_op.create_index(batch_op.f('ix_captures_content_hash'), ['content_hash'], unique=False)
        batch_op.create_index(batch_op.f('ix_captures_fingerprint'), ['fingerprint'], unique=False)



def downgrade() -> None:
    """Revert this revision."""
    with op.batch_alter_table('captures', schema=None) as batch_op:
        batch_op.drop_index(batch_op.f('ix_captures_fingerprint'))
        batch_op.drop_index(batch_op.f('ix_captures_content_hash'))
        batch_op.drop_index(batch_op.f('ix_captures_companion_hash'))
        batch_op.drop_index(batch_op.f('ix_captures_at'))

    op.drop_table('captures')
    op.drop_table('capture_pieces')
    op.drop_table('joint_maps')
    op.drop_table('capture_contents')
