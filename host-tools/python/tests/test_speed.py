"""What Python adds to the time of the simulated leg and of the model, beside the same work in Rust alone."""

import json
import subprocess
import time
from pathlib import Path

import numpy as np
from tendon_leg import Rig, SimulatedLeg

PACKAGE = Path(__file__).parents[1]
REPETITIONS, MOST_REPETITIONS = 5, 30
TICKS = 16_000
AZIMUTHS, TILTS = 1000, 1001


def in_rust(ticks, azimuths, tilts):
    """What so many ticks and a map take in Rust alone, s; cargo builds what measures it."""
    rates = ["cargo", "run", "--release", "--locked", "--quiet", "--package", "leg-rates", "--"]
    ended = subprocess.run([*rates, *map(str, (ticks, azimuths, tilts))], cwd=PACKAGE, stdout=subprocess.PIPE, check=True)
    return json.loads(ended.stdout)


def shortest_s(works, holds):
    """Of some repetitions of each, in turn, and of more until they hold: nothing but other work on the machine makes one longer."""
    least_s = dict.fromkeys(works, float("inf"))
    for repetition in range(1, MOST_REPETITIONS + 1):
        for name, work in works.items():
            least_s[name] = min(least_s[name], work())
        if repetition >= REPETITIONS and holds(least_s):
            break
    return least_s


def timed(work):
    def run():
        begin_s = time.perf_counter()
        work()
        return time.perf_counter() - begin_s

    return run


def test_stepped_by_the_millisecond_a_leg_has_seven_tenths_of_the_rate_of_rust():
    leg = SimulatedLeg("table1")
    leg.arm()

    def step():
        for _ in range(TICKS // 8):
            leg.step(8)

    def holds(took_s):
        return took_s["rust"] >= 0.7 * took_s["python"]

    took_s = shortest_s({"rust": lambda: in_rust(TICKS, 3, 2)["ticks_s"], "python": timed(step)}, holds)
    rates = {name: TICKS / time_s for name, time_s in took_s.items()}
    print(f"{rates['rust']:.0f} ticks/s in Rust, {rates['python'] / rates['rust']:.0%} of that stepped by the millisecond")
    assert holds(took_s), took_s


def test_a_pose_of_a_million_costs_no_more_than_one_of_a_map_of_rust():
    rig = Rig("table1")
    number = np.arange(1_000_000)
    azimuth_deg, tilt_deg = 360.0 * ((number * 0.6180339887) % 1.0), 30.0 * np.sqrt((number + 0.5) / len(number))
    outputs = ["tensions_n", "level_range_n", "feasible", "bending_stiffness_nm_per_rad", "deviation_m"]
    evaluate = timed(lambda: rig.evaluate(azimuth_deg, tilt_deg, 1.0, outputs=outputs))
    # The vertical is one pose of the map.
    poses = {"rust": 1 + AZIMUTHS * (TILTS - 1), "python": len(number)}

    def holds(took_s):
        return took_s["python"] / poses["python"] <= 1.2 * took_s["rust"] / poses["rust"]

    took_s = shortest_s({"rust": lambda: in_rust(1, AZIMUTHS, TILTS)["map_s"], "python": evaluate}, holds)
    map_ns, pose_ns = (1e9 * took_s[name] / poses[name] for name in ("rust", "python"))
    print(f"{map_ns:.0f} ns a pose of a map in Rust, {pose_ns / map_ns:.2f} of that a pose in Python")
    assert holds(took_s), took_s
