"""Exceptions of sincro: the text, the place and the help are those of the command line."""


class SincroError(Exception):
    """All exceptions of sincro are of this class."""

    def __str__(self):
        # KeyError shows its argument quoted; here it is a sentence
        return str(self.args[0]) if self.args else ""


class SceneError(SincroError, ValueError):
    """A scene, a setting or a robot file is refused, with all its problems at once.

    ``diagnostics`` has one dictionary a problem: ``severity``, ``file``, ``line``, ``column``, ``message``, ``help``.
    """

    diagnostics: list = []


class ArgumentError(SincroError, ValueError):
    """An argument does not fit: wrong shape or type, a number that is not finite."""


class UnknownNameError(SincroError, KeyError):
    """There is no signal, command, body or variant of that name; the message has the nearest one."""


class StoppedError(SincroError, RuntimeError):
    """The run under way cannot go on: ``tick``, ``time`` in s, ``help``."""

    tick: int = 0
    time: float = 0.0
    help: str = ""


class ControllerError(SincroError, RuntimeError):
    """A controller in Python failed. Its exception is the ``__cause__``.

    ``tick`` and ``time`` say when; after ``Model.run``, ``result`` has what was recorded.
    """

    tick: int = 0
    time: float = 0.0
    result = None


class ClosedError(SincroError, RuntimeError):
    """The model was closed."""


class InternalError(SincroError, RuntimeError):
    """An error of sincro itself: please report it."""
