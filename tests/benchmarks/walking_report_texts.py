"""The words of the replication report."""

INTRODUCTION = """
# Replication: a probabilistic steering parameter model

Made by `python -m tests.benchmarks.walking_evaluation --write`; do not edit.

Agethen, Gaisbauer and Rukzio (2018), "A Probabilistic Steering Parameter Model for Deterministic
Motion Planning Algorithms". Their 1848 captured walks are not public. What follows repeats their
experiments on synthetic walkers, which are not made by the planner (`populations.py` of
`app/science/walking` says how), and at the end on the few real walks that are public. Figures are
therefore not to be compared second by second: what can be compared is which model is better, by how
much, and how large the errors of interpolation are.

For each population {people} people walk the sixteen paths of the laboratory once (straight .5 to
4 m, round a pole by 45 to 180 degrees over 3 and 4 m). In the situation *laboratory*, a quarter of
the people at a time is left out and predicted from the others. In *workplace 1* and *2*, {others}
other people walk every path of the paper's two scenes {times} times, in which nobody of the
database was. Nobody is ever on both sides, densified entries included, and the reading of maps is
chosen on training people alone.
"""

REAL_PEOPLE = """
Fitted on {walks} walks of {people} people: foot paths of the first two people of Carlisle and Kuo's
short walks, and a captured walk of the CMU database. Compared with the other eight people of the
short walks' table ("sd" is between the means of all ten), and with CMU walks left out.

Some choices were made after a look at the files and at a first comparison, and are not blind. Foot
paths are integrated by a sensor and drift, so they are scaled to the distance that was walked; one
that misses it by more than half (1.1 m that come to .43 m) is left out; and so is CMU 05_06, which
turns by 326 degrees on its way. That fewer than 8 people do not choose a reading, but take the
time-aware one, is a rule from then too. With paths as they are, peak speed is off by up to
{worst:.2f} sd.

The table's authors have their own definition of where a walk begins and ends, so durations are told
and not judged. The CMU walks are cut by their recordings at both ends.
"""

READING_OF_RESULTS = """
## How to read this

- **CRPS** is |dt| for a model that gives one number, and rewards a distribution for being both
  narrow and right. It is in seconds, smaller is better.
- **IQR ratio** is the interquartile range of what was predicted for a course over that of its
  walks, median over courses. 1 is right; more is too much variety.
- **Inside 50 / 90 %** is the share of walks within the central intervals that should hold as many.
  Less means too sure. With ten or fewer people walking a course, one unusual person moves it a lot.
- **Power** is computed from the effect seen, as the paper does; it says no more than p.
- Walks of one person are alike, so the p-values, which treat walks as independent, are too small.
  They stand here since the paper prints them; shares of cells are what is judged.
- Speeds of computation are measured by `./run bench walking`, not here, but for the sweep over k.
"""
