"""CSV exports of OptiTrack Motive, of every format version from 1.21 to 1.25.

What the versions share: a first row of key,value pairs; rows that name each column's type, name,
kind and axis; a row that begins with "Frame"; the numbers. What differs: the rows are labelled in
their second cell from 1.23 on, bones name their parents from 1.25 on, a time code may be a third
column, and 1.21 has columns of quality that have no axis.
"""

from app.adapters.captures.motive.reader import read_motive

__all__ = ["read_motive"]
