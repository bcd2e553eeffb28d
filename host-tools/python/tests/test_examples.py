"""The examples that README.md does not run."""

import sys
from pathlib import Path

import numpy as np

EXAMPLES = Path(__file__).parents[1] / "examples"
sys.path.insert(0, str(EXAMPLES))


def test_the_gymnasium_environment_is_one():
    from gym_environment import LegReaching
    from gymnasium.utils.env_checker import check_env

    check_env(LegReaching(), skip_render_check=True)


def test_an_agent_that_asks_for_the_target_earns_more_than_one_that_does_not():
    from gym_environment import STEPS, LegReaching

    def earned(agent):
        environment = LegReaching()
        observation, _ = environment.reset(seed=1)
        total, ended = 0.0, False
        while not ended:
            observation, reward, stopped, over, _ = environment.step(agent(environment, observation))
            total, ended = total + reward, stopped or over
        assert environment.steps == STEPS
        return total

    def asks(environment, observation):
        target = observation[2:4]
        far = np.hypot(*target)
        return np.arcsin(far) / environment.edge_rad * target / max(far, 1e-9)

    assert earned(asks) > 0.6 * earned(lambda *_: np.zeros(2))
