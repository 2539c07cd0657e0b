"""The rules that lead from a claim and the runs to a verdict: one rule for all claims of a kind.

A number or a likeness ("328 of 500 runs", "as often as novelty search") is compared with ours:

- not reproduced, if a difference is detected;
- otherwise reproduced, if an effect as large as `statistics.MARGIN` is ruled out;
- otherwise no difference detectable at this size.

That something *always* happens is a number, too: all runs. A single run in which it does not is a detected
difference.

A direction ("more often than") is tested against no difference at all:

- reproduced, if a difference in this direction is detected;
- not reproduced, if one in the other direction is, or if an effect as large as the margin is ruled out;
- otherwise no difference detectable at this size.

A claim that no run of these experiments can decide is not testable here.

A difference is detected if p, corrected by Holm's method for all claims of the same family, is below 0.05. An effect is
ruled out claim by claim, at the same level.
"""

from __future__ import annotations

import pandas as pd

from safe.results.statistics import ALPHA

REPRODUCED, NOT_REPRODUCED = "reproduced", "not reproduced"
UNDECIDED, UNTESTABLE = "no difference detectable at this size", "not testable here"
VERDICTS = (REPRODUCED, UNDECIDED, NOT_REPRODUCED, UNTESTABLE)


def verdict(claim: pd.Series) -> str:
    """The verdict on a claim, a row of the ledger: family, direction, difference, p_adjusted, p_equivalence.

    Examples
    --------
    >>> likeness = {"family": "successes", "direction": 0, "difference": 0.01, "p_adjusted": 1, "p_equivalence": 0.002}
    >>> verdict(pd.Series(likeness))
    'reproduced'
    """
    if claim.family == UNTESTABLE:
        return UNTESTABLE
    detected, ruled_out = claim.p_adjusted < ALPHA, claim.p_equivalence < ALPHA
    if claim.direction == 0:
        return NOT_REPRODUCED if detected else REPRODUCED if ruled_out else UNDECIDED
    if detected:
        return REPRODUCED if claim.difference * claim.direction > 0 else NOT_REPRODUCED
    return NOT_REPRODUCED if ruled_out else UNDECIDED
