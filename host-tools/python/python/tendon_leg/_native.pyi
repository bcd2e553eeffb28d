"""What is written in Rust: its types and what it does."""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, final

from numpy import float64
from numpy.typing import ArrayLike, NDArray

#: Ticks of the control law in a second.
TICKS_PER_SECOND: int

#: The names of the states; the signal `state_index` counts them from 0.
STATES: tuple[str, ...]

#: The ready rigs: what each is.
READY_RIGS: dict[str, str]

#: The ready scenarios, which `run_scenario` takes by name: the TOML text of each.
READY_SCENARIOS: dict[str, str]

#: What can fail of a simulated leg: the names that `SimulatedLeg.fault` takes, and what each does.
DEFECTS: dict[str, str]

#: What `Rig.evaluate` gives: the names of `leg eval`, in SI units.
OUTPUTS: tuple[str, ...]

#: What can be read of a simulated leg and recorded: each name, which ends with its unit, and its meaning.
SIGNALS: dict[str, str]

@final
class Leg:
    """A leg on a serial port, commanded as by `leg home`, `leg move` and so on; or the same emulated in this process.

    Each call returns at its end, with telemetry. After `move`, `stiffness` and `follow` the leg keeps station; after `home`
    and `hold` it is in hold, as is one that was driven after `stop`, Ctrl-C and an error. One that homes or follows commands, and hears no
    more of this program, is held by itself.
    Raises LegFault, Refused, LegTimeout, or LegError where the connection fails.
    """

    @staticmethod
    def open(port: str | None = None) -> Leg:
        """The leg on a serial port, such as `/dev/ttyACM0`; on the port of the board's ST-LINK if left out.

        What `leg emulate` prints is a port, too: with `--on chip` the board's own image on an emulated chip, with `--tcp`
        `tcp://HOST:PORT`.
        """

    @staticmethod
    def can(interface: str, leg: int = 1) -> Leg:
        """The leg with an address, 1 to 6, on a CAN FD bus: its interface, such as `can0`. Linux only."""

    @staticmethod
    def emulated(
        rig: str | PathLike[str] | Rig | None = None, *, slack: bool = False, can: int | None = None
    ) -> Leg:
        """A leg in this process, whose time goes on only in calls: homed, or slack and not homed. For programs to be tried on.

        can: its address, 1 to 6, on an emulated CAN FD bus, on which the same frames go as with `Leg.can`; no bus if left out.
        """

    def home(self) -> dict[str, Any]:
        """Finds the zero. The leg must hang free, without a payload."""

    def move(
        self,
        azimuth_deg: float,
        tilt_deg: float,
        *,
        pretension_n: float | None = None,
        stiffness_nm_per_rad: float | None = None,
        towards_deg: float | None = None,
    ) -> dict[str, Any]:
        """Leans the leg, degrees, with a pretension or a bending stiffness if one is given. A leg with a zero is armed first."""

    def stiffness(self, nm_per_rad: float, towards_deg: float | None = None) -> dict[str, Any]:
        """Changes the bending stiffness where the leg is: of the softest tilt, or against a push towards an azimuth."""

    def follow(
        self,
        points: ArrayLike,
        *,
        pretension_n: ArrayLike | None = None,
        stiffness_nm_per_rad: ArrayLike | None = None,
        lead_s: float = 0.2,
    ) -> dict[str, Any]:
        """Streams a path: rows of time in s, azimuth and tilt in degrees. It is checked as a whole before the leg moves.

        pretension_n, stiffness_nm_per_rad: what the tendons are tensioned for on the way to each row, or to all; one of them. What is
        out of reach is held at its bound; the last one stays, and raises LegFault where it is out of reach at the end.
        lead_s: how long a point may be on its way to the leg, s.
        """

    def hold(self) -> dict[str, Any]:
        """Brings the leg to the state held, on its screws."""

    def stop(self) -> None:
        """Stops the leg, and returns once its motors stand: it is in hold then. One that jogs is disarmed, one that is disarmed or off stays so,
        one that ramps down goes on.

        From another thread it ends the call that uses the leg, which raises LegError.
        """

    def disarm(self) -> None:
        """Leads the leg straight down, pays its tendons out and switches the drivers off."""

    def clear(self) -> None:
        """Clears the faults whose cause is gone. The leg is in hold then, keeps station as before, or is disarmed; one that was held
        without a zero pays its tendons out first.
        """

    def telemetry(self) -> dict[str, Any]:
        """What the leg reports, by the names of `SimulatedLeg.telemetry`."""

    def sensors(self) -> dict[str, Any]:
        """What the sensors read now, as codes and in SI units: `axes` has one dictionary for each tendon."""

    def scope(self) -> dict[str, Any]:
        """What the board's recorder holds, each tick of the last 0.2 s by the default settings: up to a fault that stops the leg and
        a quarter beyond, or else up to now. Only what the settings' `recorded` chooses is there, each signal as an array;
        `since_fault_s` and `fault_names`, those that stopped the leg, only after a fault, until that is cleared."""

    def wait(self, seconds: float) -> None:
        """Lets a time pass; an emulated leg's passes in no other way but in calls."""

    def disturb(self, action: dict[str, Any]) -> None:
        """Does something to an emulated leg: `{"payload": {"kg": 2}}` and all else that `leg emulate --help` lists."""

    def settings(self) -> Rig:
        """The settings in use, as a rig that gives the same bits again."""

    def settings_differences(self, rig: str | PathLike[str] | Rig) -> list[dict[str, Any]]:
        """Every setting that a rig has differently: `name`, its value of the `rig` and of the `leg`."""

    def set_settings(self, rig: str | PathLike[str] | Rig, *, save: bool = False) -> None:
        """Replaces the settings by a rig's, and reads them back. The leg must be disarmed, and homed afterwards.

        save: whether the board keeps them over a reset.
        """

    def calibrate_cell(
        self,
        cell: int,
        weights_kg: Sequence[float],
        hang: Callable[[float], object],
        *,
        set: bool = False,
        save: bool = False,
    ) -> dict[str, float]:
        """Finds `n_per_code`, `zero_code` and `residual_n` of a load cell, 1 to 3, by known weights, drivers off.

        weights_kg: at least two different ones; 0 is the empty hook.
        hang: is called with each weight, and returns when it hangs on the cell in the place of the tendon.
        set: whether the leg is set to the result; it must be homed afterwards. save: whether it keeps it over a reset.

        Raises LegError, and sets nothing, where no straight line explains the weights.
        """

    def calibrate_motors(
        self, turn: Callable[[int], object], rig: str | PathLike[str] | Rig | None = None
    ) -> list[dict[str, Any]]:
        """Checks direction and counts of each encoder, drivers off: a dictionary for each motor.

        turn: is called with each motor, 1 to 3, and returns when it has been turned once, so that it reels its tendon in.
        rig: says how many counts a turn has; the paper's if left out.

        Each has `motor`, `counts`, `expected_counts`, whether it `passed`, and in words the `verdict`; `counts_sign` is what the rig
        file has to say, 0 where nothing was counted.
        """

    def jog(self, motor: int, travel_mm: float, *, volts: float | None = None) -> dict[str, Any]:
        """Turns one motor, 1 to 3, slowly, to see whether its wires are right. The leg must be disarmed, not homed.

        travel_mm: how far its tendon is pulled in, at most 10 mm; below zero it is paid out.
        volts: the voltage at the motor; one that turns it at 2 mm/s if left out.

        `findings` lists what does not fit, as swapped wires: each with `what` and `remedy`. The rest is what was seen. The motor is off in the end.
        """

    def close(self) -> None:
        """Closes the connection. The end of a `with` does, too."""

    def __enter__(self) -> Leg:
        """The leg itself."""

    def __exit__(self, *_exception: object) -> None:
        """Closes the connection."""

@final
class Rig:
    """A rig file, read and checked: a leg with its tendons, support, motors, sensors, gains and limits.

    To edit one, change what `to_dict` gives and read it again: `Rig.from_dict`.

    rig: a rig file or the name of a ready rig (`READY_RIGS`); the paper's rig if left out.

    Raises RigError with file, line, column and remedy where the file is refused.
    """

    def __new__(cls, rig: str | PathLike[str] | None = None) -> Rig:
        ...

    @staticmethod
    def parse(text: str, name: str = "rig") -> Rig:
        """The rig of a TOML text; `name` stands in messages."""

    @staticmethod
    def from_dict(values: dict[str, Any], name: str = "rig") -> Rig:
        """The rig of a dictionary with the keys of a rig file. The lines of a RigError are those of the TOML made of it."""

    def to_dict(self) -> dict[str, Any]:
        """The keys of its file. What the file leaves out is left out."""

    @property
    def name(self) -> str:
        """Its name in messages; of a ready rig that by which `READY_RIGS` has it."""

    @property
    def text(self) -> str:
        """Its TOML text."""

    @property
    def notes(self) -> list[str]:
        """What the file should say otherwise, though it is understood."""

    @property
    def support(self) -> str:
        """Its central support."""

    @property
    def pretension_n(self) -> float:
        """Its pretension, N per tendon at the vertical pose."""

    @property
    def tilt_max_deg(self) -> float:
        """How far the leg leans at most, degrees."""

    @property
    def tension_bounds_n(self) -> tuple[float, float]:
        """Lowest and highest tension allowed, N."""

    def evaluate(
        self,
        azimuth_deg: ArrayLike,
        tilt_deg: ArrayLike,
        payload_kg: ArrayLike | None = None,
        *,
        level_n: ArrayLike | None = None,
        f_min_n: ArrayLike | None = None,
        f_max_n: ArrayLike | None = None,
        demand_nm_per_rad: ArrayLike | None = None,
        demand_towards_deg: ArrayLike | None = None,
        stiffness_n_per_m: float | None = None,
        stiffness_at: str | None = None,
        leg_mass_kg: float | None = None,
        l_upper_m: float | None = None,
        support: str | None = None,
        outputs: list[str] | None = None,
        raises: bool = True,
    ) -> dict[str, Any]:
        """The whole model in f64 at one pose or at many: what `leg eval` answers, to the last bit, on all cores.

        azimuth_deg, tilt_deg: where the leg leans; a tilt is within 60°, a negative one is the opposite azimuth.
        payload_kg: mass at the tip; 0 if left out. Whatever else is left out is the rig's:
        level_n: pretension, N per tendon at the vertical pose.
        f_min_n, f_max_n: lowest and highest tension allowed.
        demand_nm_per_rad, demand_towards_deg: a bending stiffness to find the pretension for: of the softest tilt, or against
            a push at an azimuth. `commanded_level_n` is the pretension that gives it, or the nearest within the bounds, each tendon's stiffness
            at its own tension.
        stiffness_n_per_m: a constant stiffness of every tendon. stiffness_at: "pretension" or "tension".
        leg_mass_kg, l_upper_m, support: as in `leg eval`.
        outputs: those that are wanted, of `OUTPUTS`; all but `deviation_nonlinear_m`, which is much slower, if left out. Few
            are faster than many; those that a map has (`tensions_n`, `level_range_n`, `feasible`, `bending_stiffness_nm_per_rad`,
            `deviation_m`) are fastest alone.
        raises: whether a pose without a result raises ValueError, or NoResult where no argument is to blame. Otherwise its
            outputs are not a number (`feasible` false), and `errors` in the result says why, by the pose's number.

        Arrays go together by numpy's rules. Of an array of shape s an output has the shape s, or s and its own 2, 3 or 3 × 3
        (rows first). SI units, frame {A}: x and y horizontal, z upwards from the joint's centre.
        """

    def workspace_map(
        self,
        payload_kg: float = 0.0,
        *,
        azimuths: int = 360,
        tilts: int = 31,
        nonlinear: bool = False,
    ) -> dict[str, NDArray[float64]]:
        """The quantities of `leg map` over the workspace: `azimuth_deg`, `tilt_deg`, and arrays with a row for each tilt.

        What is not known at a pose is not a number; `feasible` and `pretension_keeps_bounds` are 0 or 1. `nonlinear` adds
        `deviation_nonlinear_mm`, which takes far longer than all the rest.
        """

    def tendon_curve(
        self, tensions_n: ArrayLike, *, tendon: int = 1
    ) -> dict[str, NDArray[float64]]:
        """`elongation_m` and `stiffness_n_per_m` of a tendon under tensions, N; not a number beyond what its curve knows."""

    def __eq__(self, other: object) -> bool:
        """Whether both describe the same leg, in whatever words."""

    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[Any, ...]:
        """Its text and its name, read again where it comes to."""

@final
class SimulatedLeg:
    """A leg without a board: the firmware's own code and the simulated mechanism, as `leg run --on sim` has them.

    Time passes only in calls: in `step` and `run`, and in commands, which wait for their end unless `wait=False`. The
    same calls on a leg with the same seed give the same bits. Other Python threads run meanwhile, so that many legs can be
    stepped in as many threads; one leg belongs to one thread at a time.

    It begins at rest, disarmed, its zero known and its load cells tared.

    rig: a `Rig`, a rig file or the name of a ready rig (`READY_RIGS`); the paper's rig if left out.
    seed: of the sensors' noise.
    slack: hangs straight down with 3 mm of slack in each tendon and does not know its zero: `home` it first.
    azimuth_deg, tilt_deg: where it leans, within 60° of tilt.
    payload_kg: mass at its tip.
    pretension_n: that its tendons have, N per tendon at the vertical pose; the rig's if left out.

    Raises RigError for a rig file that is refused, at its place.
    """

    def __new__(
        cls,
        rig: str | PathLike[str] | Rig | None = None,
        *,
        seed: int = 0,
        slack: bool = False,
        azimuth_deg: float = 0.0,
        tilt_deg: float = 0.0,
        payload_kg: float = 0.0,
        pretension_n: float | None = None,
    ) -> SimulatedLeg:
        ...

    @property
    def time_s(self) -> float:
        """Time of the leg since its start, s."""

    @property
    def ticks(self) -> int:
        """The same in ticks."""

    @property
    def state(self) -> str:
        """What the leg may do: one of `STATES`."""

    @property
    def following(self) -> bool:
        """Whether a path is followed, the way to its start included."""

    @property
    def faults(self) -> list[dict[str, Any]]:
        """Faults that are latched or limit now: `code`, `name`, `cause`, `remedy`, `reaction` of each."""

    def step(self, ticks: int = 8) -> None:
        """Lets some ticks pass, 125 µs each: 1 ms if left out. A fault shows in `faults` and `state`, and raises nothing."""

    def run(self, seconds: float) -> None:
        """Lets a time pass, to the nearest tick, s."""

    def wait(self, timeout_s: float = 60.0) -> None:
        """Lets time pass until the leg has rested for 0.3 s where it shall be, at the end of what it follows.

        Raises LegFault if a fault ends or limits that, LegTimeout after `timeout_s` of the leg's time.
        """

    def arm(self, *, wait: bool = True) -> None:
        """Lets the leg follow commands from now on, its tendons taut.

        Raises Refused with the firmware's words, LegFault if a fault is latched. So do all commands.
        """

    def home(self, *, wait: bool = True) -> None:
        """Finds the zero of a slack leg; it is armed then and hangs straight down."""

    def move(self, azimuth_deg: float, tilt_deg: float, *, wait: bool = True) -> None:
        """Leans the leg: towards an azimuth, degrees, by a tilt, degrees. A negative tilt is the opposite azimuth."""

    def follow(
        self,
        points: ArrayLike,
        *,
        pretension_n: ArrayLike | None = None,
        stiffness_nm_per_rad: ArrayLike | None = None,
        wait: bool = True,
    ) -> None:
        """Streams a path to the leg as set-points: rows of time in s, azimuth and tilt in degrees, in the order of their times.

        The leg is led to a run-up first, and comes to rest at the end. With `wait=False` later ticks send the points.
        Refused, before the leg moves, where a point is beyond a limit of the motion; the message has its time.

        pretension_n, stiffness_nm_per_rad: what the tendons are tensioned for on the way to each row, or to all; one of them. What is
        out of reach is held at its bound, and is told by `faults`.
        """

    def stiffness(
        self, nm_per_rad: float, towards_deg: float | None = None, *, wait: bool = True
    ) -> None:
        """Demands a bending stiffness, N·m/rad: of the softest tilt, or against a push towards an azimuth, degrees.

        LegFault (`stiffness out of reach`) where the tension bounds stop the pretension short of it.
        """

    def pretension(self, newtons: float, *, wait: bool = True) -> None:
        """Sets the pretension, N per tendon at the vertical pose."""

    def compensation(self, load: str) -> None:
        """Chooses the load that the tendons hold: `"off"`, `"estimated"` (from the tensions) or `"frozen"` (as it is now)."""

    def hold(self, *, wait: bool = True) -> None:
        """Comes to rest on the way and stays active, following commands. It does not come to the state held, as by `Leg.hold`:
        `stop` does that.
        """

    def stop(self) -> None:
        """Stays where it is, at once, until `clear`."""

    def disarm(self, *, wait: bool = True) -> None:
        """Leads the leg straight down, pays its tendons out and switches the drivers off."""

    def clear(self) -> None:
        """Clears the faults whose cause is gone, and ends a stop."""

    def keep_station(self) -> None:
        """Leaves a leg that rests: it compensates its load slowly where it is, and needs no host."""

    def payload(self, kg: float, over_s: float = 0.0) -> None:
        """Changes the mass at the tip, at once or over a time, kg, s."""

    def push(self, azimuth_deg: float, force_n: float, for_s: float) -> None:
        """Pushes at the tip, across the leg, for a time: degrees, N, s. The force rises within 20 ms."""

    def fault(self, fault: str, tendon: int | None = None) -> None:
        """Lets a defect begin: a name of `DEFECTS`, and which tendon (1 to 3) has it unless the whole leg does."""

    def repair(self, fault: str, tendon: int | None = None) -> None:
        """Ends a defect."""

    def emergency_stop(self, pressed: bool) -> None:
        """Presses or releases the emergency stop."""

    def silence(self, silent: bool) -> None:
        """Lets the host send no more signs of life, or again.

        Without them a leg that homes or follows commands is held by itself, one that jogs is switched off; one that keeps
        station goes on and moves by itself.
        """

    def truth(self) -> dict[str, Any]:
        """How the leg really is: every signal of the mechanism, by name, and `time_s`."""

    def telemetry(self) -> dict[str, Any]:
        """What the firmware reports: its signals by name, and `state`, `faults`, `homed` and `time_s`."""

    def read(self, name: str) -> float | NDArray[float64]:
        """One signal of `SIGNALS` now: a number, or an array of three or two."""

    def record(self, signals: list[str], *, every_ticks: int = 16) -> None:
        """Records signals from the next tick on, in whatever calls the ticks pass: 500 rows a second if left out.

        What was recorded before is forgotten.
        """

    def recording(self) -> dict[str, NDArray[float64]]:
        """What was recorded until now: `time_s`, and each signal as an array with a row for each time."""

    def __copy__(self) -> SimulatedLeg:
        """A clone."""

    def __deepcopy__(self, _memo: dict[int, Any]) -> SimulatedLeg:
        """A clone."""

    def clone(self) -> SimulatedLeg:
        """The same leg in the same state, to try something else with: both go on alike, bit for bit, where they are treated alike."""

def run_scenario(
    scenario: str | PathLike[str],
    *,
    rig: str | PathLike[str] | Rig | None = None,
    seed: int | None = None,
) -> dict[str, Any]:
    """Runs a scenario as `leg run --on sim` does, the control law in f64 beside it.

    scenario: a scenario file, the name of a ready one (`READY_SCENARIOS`), or a TOML text.
    rig: a `Rig`, a rig file or the name of a ready rig; the scenario's if left out.
    seed: of the sensors' noise; the scenario's if left out.

    Gives `title`, `passed`, `measurements` (`name`, `value`, `unit`, `between`, `time_s`, `passed` of each), `faults` and
    `unexpected_faults` by name, `refused` (the commands that the leg refused, when and why), `stopped` (why it ended before its last
    step, or None), `tension_range_n`, `ticks`, and `bits`: a hash of all that the firmware decided, which is equal where every bit of it is.

    Raises ScenarioError and RigError for a file that is refused, at its place.
    """
