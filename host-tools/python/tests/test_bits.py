"""The wheel gives the bits that the Rust tests hold every ready scenario to."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from tendon_leg import READY_SCENARIOS, run_scenario

TABLE = Path(__file__).parents[3] / "tests" / "golden" / "scenario_bits.txt"


def test_every_ready_scenario_has_the_bits_of_the_table():
    lines = (line.split() for line in TABLE.read_text().splitlines())
    expected = {name: (int(ticks), bits) for name, ticks, _, bits in lines}
    with ThreadPoolExecutor(2) as pool:
        runs = dict(zip(READY_SCENARIOS, pool.map(run_scenario, READY_SCENARIOS), strict=True))
    assert {name: (run["ticks"], run["bits"]) for name, run in runs.items()} == expected
    assert [name for name, run in runs.items() if not run["passed"]] == []
