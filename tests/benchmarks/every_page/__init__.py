"""The parts of the benchmark `pages`: a filled lab, every route, and one look at one page."""
