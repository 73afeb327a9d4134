"""Claims about friction in hypoid gears, judged by figures of a pair."""

import numpy as np

from tribodyn.study.studies.hypoid_claims import HypoidFigures, hypoid_claims

#: What the built-in pair has, by torque and speed.
PAIR = HypoidFigures(
    coefficient=np.array(
        [[0.0097, 0.0086, 0.0082], [0.0129, 0.0110, 0.0105], [0.0126, 0.0103, 0.0098]]
    ),
    spread=np.array([[0.19, 0.17, 0.17], [0.045, 0.033, 0.033], [0.031, 0.005, 0.005]]),
    swing=np.radians([[26.5, 25.9, 25.9], [5.4, 5.1, 5.1], [1.7, 1.2, 1.2]]),
    film_ratio=np.array([[1.45, 3.06, 4.32], [1.2, 2.53, 3.59], [1.09, 2.3, 3.25]]),
    of_mean=np.full((5, 3), 0.01),
    of_typical=np.array([[-0.007], [-0.158], [-0.045], [-0.092], [-0.407]]) * np.ones(3),
)


def verdicts(figures):
    return [claim.holds for claim in hypoid_claims(figures)]


def test_each_claim_follows_its_figures():
    assert verdicts(PAIR) == [False, True, True, False, False, True, False, False]
    assert "16 %" in hypoid_claims(PAIR)[6].computed
    turned = PAIR._replace(
        spread=0.1 * PAIR.spread,
        swing=PAIR.swing + 2.0,
        coefficient=PAIR.coefficient[:, ::-1],
        film_ratio=0.1 * PAIR.film_ratio,
        of_mean=10.0 * PAIR.of_mean,
        of_typical=0.01 * PAIR.of_typical[[1, 0, 2, 3, 4]],
    )
    assert verdicts(turned) == [True, False, False, True, True, False, True, True]
