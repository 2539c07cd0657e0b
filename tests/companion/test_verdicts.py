import numpy as np
import pandas as pd
import pytest

from safe.companion import verdicts


def claim(**values):
    values = {
        "family": "successes",
        "direction": 0,
        "difference": 0.1,
        "p_adjusted": 0.5,
        "p_equivalence": 0.5,
    } | values
    return pd.Series(values)


@pytest.mark.parametrize(
    ("values", "verdict"),
    [
        ({"p_adjusted": 0.04, "p_equivalence": 0.01}, verdicts.NOT_REPRODUCED),
        ({"p_equivalence": 0.01}, verdicts.REPRODUCED),
        ({}, verdicts.UNDECIDED),
        ({"p_adjusted": np.nan, "p_equivalence": np.nan}, verdicts.UNDECIDED),
        ({"direction": 1, "p_adjusted": 0.01}, verdicts.REPRODUCED),
        ({"direction": 1, "p_adjusted": 0.01, "difference": -0.1}, verdicts.NOT_REPRODUCED),
        ({"direction": 1, "p_equivalence": 0.01}, verdicts.NOT_REPRODUCED),
        ({"direction": 1, "p_adjusted": 0.01, "p_equivalence": 0.01}, verdicts.REPRODUCED),
        ({"direction": 1}, verdicts.UNDECIDED),
        ({"direction": -1, "p_adjusted": 0.01, "difference": -0.1}, verdicts.REPRODUCED),
        ({"direction": -1, "p_adjusted": 0.01}, verdicts.NOT_REPRODUCED),
        ({"family": verdicts.UNTESTABLE}, verdicts.UNTESTABLE),
    ],
)
def test_the_rules_that_lead_to_a_verdict(values, verdict):
    assert verdicts.verdict(claim(**values)) == verdict
