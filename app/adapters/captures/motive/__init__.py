"""CSV exports of OptiTrack Motive, for the format versions 1.21 to 1.25.

All versions have: a first row of key,value pairs; rows with each column's type, name, kind and
axis; a row that begins with "Frame"; the numbers. They differ in this: from 1.23 on, the rows are
labelled in their second cell; from 1.25 on, bones name their parents; a time code may be a third
column; and 1.21 has quality columns without an axis.
"""

from app.adapters.captures.motive.reader import read_motive

__all__ = ["read_motive"]
