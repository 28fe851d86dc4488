"""Writes docs/data-dictionary.md: `python -m app.features.analysis.codebook > FILE`."""

import sys

from app.features.analysis.codebook import data_dictionary

sys.stdout.write(data_dictionary())
