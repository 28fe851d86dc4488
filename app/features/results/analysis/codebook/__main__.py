"""Print the data dictionary: `python -m app.features.results.analysis.codebook > FILE`."""

import sys

from app.features.results.analysis.codebook import data_dictionary

sys.stdout.write(data_dictionary())
