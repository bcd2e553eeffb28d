"""A gymnasium environment: hold the tip of a leg on a target that jumps, with a payload that is not told.

Needs `pip install gymnasium`. Run as a program it lets an agent that only asks for the target play one episode.
"""
from typing import Any

import gymnasium
import numpy as np
from tendon_leg import LegError, Rig, SimulatedLeg

STEP_S = 0.05
STEPS = 200
PAYLOAD_MAX_KG = 1.5


class LegReaching(gymnasium.Env[np.ndarray, np.ndarray]):
    """Observed: where the leg estimates its tip, where the target is, both as x and y of the leg's direction, and the tensions in
    hundreds of newtons. Done: where to lean, as x and y from −1 to 1 of the workspace's edge. Rewarded: minus the true
    distance from the target, degrees. An episode ends when a fault stops the leg.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(self, rig: str = "table1") -> None:
        self.rig = Rig(rig)
        self.edge_rad = np.radians(self.rig.tilt_max_deg)
        lowest, highest = np.repeat([-1.0, -1.0], [4, 3]), np.repeat([1.0, 10.0], [4, 3])
        self.observation_space = gymnasium.spaces.Box(lowest, highest, dtype=np.float64)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (2,), np.float64)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[np.ndarray, dict[str, Any]]:
        super().reset(seed=seed)
        self.leg = SimulatedLeg(self.rig, seed=int(self.np_random.integers(2**32)))
        self.leg.arm()
        self.leg.payload(self.np_random.uniform(0.0, PAYLOAD_MAX_KG))
        self.steps = 0
        self._jump()
        return self._observation(), {}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        x, y = action / max(1.0, float(np.hypot(*action)))  # within the workspace
        fault = None
        try:
            tilt_rad = np.hypot(x, y) * self.edge_rad
            self.leg.move(np.degrees(np.arctan2(y, x)), np.degrees(tilt_rad), wait=False)
            self.leg.run(STEP_S)
        except LegError as error:
            fault = str(error)
        self.steps += 1
        if self.steps % 50 == 0:
            self._jump()
        truth = self.leg.truth()
        true = self._direction(truth["azimuth_true_deg"], truth["tilt_true_deg"])
        off_deg = float(np.degrees(np.hypot(*(true - self.target))))
        stopped = fault is not None or self.leg.state not in ("active", "keeping station")
        return self._observation(), -off_deg, stopped, self.steps >= STEPS, {"fault": fault}

    def _jump(self) -> None:
        tilt_deg = 0.9 * self.rig.tilt_max_deg * np.sqrt(self.np_random.uniform())
        self.target = self._direction(self.np_random.uniform(0.0, 360.0), tilt_deg)

    @staticmethod
    def _direction(azimuth_deg: float, tilt_deg: float) -> np.ndarray:
        azimuth, tilt = np.radians([azimuth_deg, tilt_deg])
        return np.array([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth)])

    def _observation(self) -> np.ndarray:
        seen = self.leg.telemetry()
        tip = self._direction(seen["azimuth_deg"], seen["tilt_deg"])
        return np.concatenate([tip, self.target, np.asarray(seen["tensions_n"]) / 100.0])


if __name__ == "__main__":
    environment = LegReaching()
    observation, _ = environment.reset(seed=1)
    total, ended = 0.0, False
    while not ended:
        target = observation[2:4]
        tilt = np.arcsin(np.hypot(*target)) / environment.edge_rad
        action = tilt * target / max(np.hypot(*target), 1e-9)
        observation, reward, stopped, over, info = environment.step(action)
        total, ended = total + reward, stopped or over
    print(f"mean distance from the target: {-total / environment.steps:.2f}° in {environment.steps} steps, {info}")
