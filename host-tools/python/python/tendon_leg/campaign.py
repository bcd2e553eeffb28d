"""Many scenarios at once: on all cores of this machine, or on a cluster by an executor of another package."""

import functools
import hashlib
import json
import operator
import os
import re
import shlex
import tomllib
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Executor, ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

from . import _native
from ._native import READY_RIGS, READY_SCENARIOS, Rig, run_scenario
from .errors import LegError

#: What a case says of its run; its other keys are only copied to its row.
RUN_KEYS = ("scenario", "rig", "seed")

#: What a row says of its run, which no other key of a case can be called.
RESULT_KEYS = ("title", "passed", "stopped", "faults", "unexpected_faults", "refused", "ticks", "bits", "error", "repeat")


@functools.cache
def _build() -> str:
    """What the results of this build of the package are known by: those of another one are not its own."""
    return hashlib.sha256(Path(_native.__file__).read_bytes()).hexdigest()


@dataclass(frozen=True)
class Run:
    """One run, in words that any machine understands."""

    scenario: str
    rig_name: str | None
    rig_text: str | None
    seed: int | None

    @property
    def key(self) -> str:
        """Equal for equal runs of the same build, and for no others."""
        return hashlib.sha256(f"{_build()} {self!r}".encode()).hexdigest()[:16]


def campaign(
    cases: Iterable[Mapping[str, Any]],
    directory: str | PathLike[str],
    *,
    executor: Executor | None = None,
    progress: Callable[[dict[str, Any]], None] | None = None,
) -> list[dict[str, Any]]:
    """Runs every case, and gives a row for each, in their order: for `pandas.DataFrame`, for instance.

    cases: dictionaries with `scenario` (a file, a ready one's name, or a TOML text), and if wanted `rig` (a `Rig`, a file or a
        ready one's name) and `seed`. What else they have is copied to their rows.
    directory: where results are kept, a line each in `results.jsonl`. Called again with the same directory, cases that are
        there are not run again, unless another build of this package ran them: a campaign that was killed goes on where it was. Of each run that does not pass, `failures`
        keeps scenario and rig; `repeat` in its row is the command that runs it again.
    executor: where they run; one thread a core of this machine if left out. Dask's `Client.get_executor()`, for instance,
        runs them on a cluster, whose workers need this package.
    progress: called with each row as it ends.

    A row has `scenario` and `rig` by name (of a text its title), the case's own keys, `title`, `passed`, `stopped`, `faults`, `unexpected_faults`, `refused`, `ticks`, `bits`, a column for
    each measurement by its name, `error` (why there is no result, or None) and, where it did not pass, `repeat`.
    Raises ValueError before anything runs: for a case that is none, by its number, and for a directory that cannot be one.
    """
    if isinstance(cases, (str, Mapping)) or not isinstance(cases, Iterable):
        raise TypeError(f"cases is no list of dictionaries, but {cases!r}")
    if not isinstance(directory, (str, PathLike)):
        raise TypeError(f"directory is no path, but {directory!r}")
    if executor is not None and not callable(getattr(executor, "submit", None)):
        raise TypeError(f"executor submits nothing: it is {executor!r}")
    if progress is not None and not callable(progress):
        raise TypeError(f"progress cannot be called: it is {progress!r}")
    listed = list(cases)
    runs = [_run_of(number, case) for number, case in enumerate(listed)]
    directory = Path(directory)
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        raise ValueError(f"directory = {str(directory)!r} cannot be made: {getattr(error, 'strerror', error)}") from error
    results = directory / "results.jsonl"
    known = _read(results)
    rows: dict[int, dict[str, Any]] = {}

    def take(number: int, result: dict[str, Any]) -> None:
        rows[number] = {**_labels(listed[number], runs[number]), **result}
        if progress is not None:
            progress(rows[number])

    missing: dict[str, list[int]] = {}
    for number, run in enumerate(runs):
        if run.key in known:
            take(number, known[run.key])
        else:
            missing.setdefault(run.key, []).append(number)
    with results.open("a", encoding="utf-8") as file:
        for key, result in _results({key: runs[numbers[0]] for key, numbers in missing.items()}, executor):
            if not result["passed"]:
                result["repeat"] = _keep(directory / "failures" / key, runs[missing[key][0]])
            file.write(json.dumps({"key": key, "result": result}) + "\n")
            file.flush()
            for number in missing[key]:
                take(number, result)
    return [rows[number] for number in range(len(listed))]


def _results(runs: Mapping[str, Run], executor: Executor | None) -> Iterable[tuple[str, dict[str, Any]]]:
    """Each result as it comes. What has not begun when this ends is not begun any more."""
    own = ThreadPoolExecutor(os.cpu_count()) if executor is None else None
    pool = own or executor
    assert pool is not None
    futures = {pool.submit(_carry_out, run): key for key, run in runs.items()}
    try:
        for future in as_completed(futures):
            yield futures[future], future.result()
    finally:
        for future in futures:
            future.cancel()
        if own is not None:
            own.shutdown()


def _carry_out(run: Run) -> dict[str, Any]:
    """On whatever machine it is."""
    try:
        rig = Rig.parse(run.rig_text, run.rig_name or "rig") if run.rig_text is not None else run.rig_name
        found = run_scenario(run.scenario, rig=rig, seed=run.seed)
    except LegError as error:
        return {"passed": False, "error": str(error)}
    measured = {row["name"]: row["value"] for row in found.pop("measurements")}
    del found["tension_range_n"]
    return {**found, **measured, "error": None}


def _run_of(number: int, case: Mapping[str, Any]) -> Run:
    def refuse(what: str) -> ValueError:
        return ValueError(f"cases[{number}]: {what}")

    if not isinstance(case, Mapping) or "scenario" not in case:
        raise refuse("it has no `scenario`")
    for key in RESULT_KEYS:
        if key in case:
            raise refuse(f"its key {key!r} is that of a result; give it another name")
    scenario, rig, seed = (case.get(key) for key in RUN_KEYS)
    if seed is not None:
        # Integers of numpy are integers.
        if isinstance(seed, bool) or not hasattr(seed, "__index__") or not 0 <= operator.index(seed) < 2**64:
            raise refuse(f"its seed {seed!r} is no integer from 0 to 2⁶⁴ − 1")
        seed = operator.index(seed)
    try:
        text = _scenario_text(scenario)
        if rig is None or (isinstance(rig, str) and rig in READY_RIGS):
            return Run(text, rig, None, seed)
        rig = rig if isinstance(rig, Rig) else Rig(rig)
    except (LegError, OSError, TypeError) as error:
        raise refuse(str(error)) from error
    return Run(text, rig.name, rig.text, seed)


def _scenario_text(scenario: object) -> str:
    if isinstance(scenario, str) and "\n" in scenario:
        return scenario
    if isinstance(scenario, str) and scenario in READY_SCENARIOS:
        return READY_SCENARIOS[scenario]
    if isinstance(scenario, (str, PathLike)):
        return Path(scenario).read_text(encoding="utf-8")
    raise TypeError(f"scenario: {scenario!r} is no text, no name and no path")


def _labels(case: Mapping[str, Any], run: Run) -> dict[str, Any]:
    """The case's own keys, with names for what it runs: those that it was given, or else what stands in the scenario."""
    own = {key: value for key, value in case.items() if key not in RUN_KEYS or key == "seed"}
    scenario, file = case["scenario"], _toml(run.scenario)
    if isinstance(scenario, str) and "\n" in scenario:
        scenario = file.get("title", "")
    return {"scenario": str(scenario), "rig": run.rig_name or file.get("rig", "table1"), **own}


def _toml(text: str) -> dict[str, Any]:
    """What a file says; nothing where it is refused, as its run's row says then."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return {}


def _read(results: Path) -> dict[str, dict[str, Any]]:
    """What is known already. The last line of a campaign that was killed may be torn: it is taken off."""
    if not results.exists():
        return {}
    lines = results.read_bytes().splitlines(keepends=True)
    if lines and not lines[-1].endswith(b"\n"):
        lines.pop()
        results.write_bytes(b"".join(lines))
    known = {}
    for number, line in enumerate(lines, 1):
        try:
            entry = json.loads(line)
            known[entry["key"]] = entry["result"]
        except (ValueError, TypeError, KeyError) as error:
            raise ValueError(f"directory: line {number} of {results} is no result of a campaign; take it out") from error
    return known


def _keep(directory: Path, run: Run) -> str:
    """Keeps what repeats a run: the command."""
    directory.mkdir(parents=True, exist_ok=True)
    scenario = run.scenario
    if run.seed is not None:
        # Keys of the file itself come before its first table.
        table = re.search(r"^\[", scenario, re.MULTILINE)
        end = table.start() if table else len(scenario)
        keys = re.sub(r"^seed *=.*\n?", "", scenario[:end], flags=re.MULTILINE)
        scenario = f"seed = {run.seed}\n{keys}{scenario[end:]}"
    path = directory / "scenario.toml"
    path.write_text(scenario, encoding="utf-8")
    command = ["leg", "run", "--on", "sim", "--scenario", str(path)]
    if run.rig_text is not None:
        rig = directory / "rig.toml"
        rig.write_text(run.rig_text, encoding="utf-8")
        command += ["--rig", str(rig)]
    elif run.rig_name is not None:
        command += ["--rig", run.rig_name]
    return shlex.join(command)
