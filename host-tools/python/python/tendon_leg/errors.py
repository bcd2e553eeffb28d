"""What a leg or the model can answer instead of doing what it was asked."""


class LegError(Exception):
    """Everything that this package raises by itself, but for wrong arguments (`ValueError`, `TypeError`)."""

    def __reduce__(self) -> tuple[object, ...]:
        return _again, (type(self), self.args, self.__dict__)


def _again(kind: type[LegError], words: tuple[str, ...], fields: dict[str, object]) -> LegError:
    """An error that comes from another process, as it was."""
    error = kind.__new__(kind, *words)
    error.__dict__.update(fields)
    return error


class Refused(LegError):
    """The leg refuses a command, and does nothing. The words are the firmware's own."""

    #: Its numbers in `firmware/PROTOCOL.md`, outermost first: (6, 3) where the leg cannot lean that far.
    code: tuple[int, ...]
    #: Their names there, with points between them: "Command.OutOfReach".
    name: str
    #: What is wrong.
    reason: str
    #: What to do about it.
    remedy: str

    def __init__(self, code: tuple[int, ...], name: str, reason: str, remedy: str) -> None:
        super().__init__(f"{reason}; {remedy}")
        self.code = code
        self.name = name
        self.reason = reason
        self.remedy = remedy


class LegFault(LegError):
    """A fault keeps the leg from what it was asked. Where several are latched, it is that with the lowest code."""

    #: The fault's code, as in the fault table (`leg faults`).
    code: int
    #: Its name.
    name: str
    #: What raises it.
    cause: str
    #: What to do about it.
    remedy: str
    #: What the leg does now: a state's name, as in `tendon_leg.STATES`.
    state: str

    def __init__(self, code: int, name: str, cause: str, remedy: str, state: str) -> None:
        super().__init__(f"fault {code}, {name}: {cause}; {remedy}; the leg is {state}")
        self.code = code
        self.name = name
        self.cause = cause
        self.remedy = remedy
        self.state = state


class LegTimeout(LegError, TimeoutError):
    """The leg did not come to the end of what it was asked in time. It goes on with it."""


class FileRefused(LegError, ValueError):
    """A file is refused, at a place in it where there is one."""

    #: What is wrong.
    reason: str
    #: What to do about it.
    remedy: str
    #: The file, or the name that was given to the text.
    file: str | None
    #: The line, counted from 1.
    line: int | None
    #: The column, counted from 1.
    column: int | None

    def __init__(
        self, reason: str, remedy: str, file: str | None, line: int | None, column: int | None
    ) -> None:
        place = "" if line is None else f"{file}, line {line}, column {column}: "
        super().__init__(f"{place}{reason}" + (f"; {remedy}" if remedy else ""))
        self.reason = reason
        self.remedy = remedy
        self.file = file
        self.line = line
        self.column = column


class RigError(FileRefused):
    """A rig file is refused."""


class ScenarioError(FileRefused):
    """A scenario file is refused."""


class NoResult(LegError, ValueError):
    """The model has no result at a pose: nothing holds the leg there, or it would buckle."""
