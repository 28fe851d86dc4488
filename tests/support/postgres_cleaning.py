"""Restore a PostgreSQL database to its state before a test, and check the result.

Rows are removed, and the counters of their keys reset. Any other change that a test may have made
is recorded in the catalogues, and changes their marks: tables, columns, constraints, indices,
triggers, functions, schemas, settings, sequences, and the revision that is stored in the database.
"""

from pathlib import Path

import psycopg
from psycopg import sql

REVISION = "alembic_version"
WAITS_S = 10

OTHERS = """
SELECT pg_terminate_backend(pid, 10000) FROM pg_stat_activity
WHERE datname = current_database() AND pid <> pg_backend_pid()
"""
WITH_ROWS = """
SELECT relname FROM pg_class
WHERE relnamespace = 'public'::regnamespace AND relkind = 'r' AND relname <> %s
AND pg_relation_size(oid) > 0
"""
MARKS = """
SELECT md5(string_agg(mark, ';' ORDER BY mark)) FROM (
    SELECT concat_ws(' ', 'class', oid, relname, relkind, relowner, relnatts, relhasrules,
        relhastriggers, relrowsecurity, reloptions::text) AS mark
    FROM pg_class WHERE relnamespace = 'public'::regnamespace
    UNION ALL SELECT concat_ws(' ', 'column', attrelid, attnum, attname, atttypid, atttypmod,
        attnotnull, attisdropped, attstorage, attcompression)
    FROM pg_attribute WHERE attrelid >= 16384
    UNION ALL SELECT concat_ws(' ', 'default', oid, pg_get_expr(adbin, adrelid)) FROM pg_attrdef
    UNION ALL SELECT concat_ws(' ', 'constraint', oid, conname, convalidated)
    FROM pg_constraint WHERE oid >= 16384
    UNION ALL SELECT concat_ws(' ', 'index', indexrelid, indisvalid, indisunique)
    FROM pg_index WHERE indexrelid >= 16384
    UNION ALL SELECT concat_ws(' ', 'trigger', oid, tgname, tgenabled) FROM pg_trigger
    UNION ALL SELECT concat_ws(' ', 'function', oid, proname, md5(prosrc))
    FROM pg_proc WHERE oid >= 16384
    UNION ALL SELECT concat_ws(' ', 'schema', nspname) FROM pg_namespace
    WHERE nspname NOT LIKE 'pg_temp%' AND nspname NOT LIKE 'pg_toast_temp%'
    UNION ALL SELECT concat_ws(' ', 'type', oid, typname) FROM pg_type WHERE oid >= 16384
    UNION ALL SELECT concat_ws(' ', 'extension', extname) FROM pg_extension
    UNION ALL SELECT concat_ws(' ', 'setting', setconfig::text) FROM pg_db_role_setting
    WHERE setdatabase = (SELECT oid FROM pg_database WHERE datname = current_database())
    UNION ALL SELECT concat_ws(' ', 'large object', oid) FROM pg_largeobject_metadata
    UNION ALL SELECT concat_ws(' ', 'sequence', sequencename, last_value) FROM pg_sequences
    UNION ALL SELECT concat_ws(' ', 'revision', version_num) FROM alembic_version
) AS marks
"""


def emptied(folder: Path, database: str) -> str | None:
    """Empty the database of the cluster in `folder` and return its marks.

    Return None if it allows no connections. Other connections to it are terminated first.
    """
    try:
        with psycopg.connect(
            host=str(folder),
            user="postgres",
            dbname=database,
            autocommit=True,
            options=f"-c lock_timeout={WAITS_S}s",
        ) as connection:
            connection.execute(OTHERS)
            filled = [name for (name,) in connection.execute(WITH_ROWS, [REVISION])]
            if filled:
                names = sql.SQL(", ").join(map(sql.Identifier, filled))
                connection.execute(sql.SQL("TRUNCATE {} RESTART IDENTITY CASCADE").format(names))
            row = connection.execute(MARKS).fetchone()
    except psycopg.Error:
        return None
    return None if row is None else str(row[0])
