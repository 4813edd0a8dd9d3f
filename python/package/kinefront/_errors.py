"""The exceptions of Kinefront. Their messages are those of the program ``kinefront``."""


class Error(Exception):
    """Base class of the exceptions of Kinefront."""


class InputError(Error, ValueError):
    """The input is invalid; the message states the error, its place and the valid values."""


class StudyError(InputError):
    """A study is invalid.

    ``faults`` lists the faults as pairs of the key and of what is wrong with it.
    """

    faults: list[tuple[str, str]] = []


class DesignError(InputError):
    """A design, a pose or a table of designs is invalid."""


class RunError(InputError):
    """A run folder cannot be read, or does not contain what was requested."""


class FileError(Error, OSError):
    """A file of a run cannot be written."""


class SearchError(Error, RuntimeError):
    """A search failed."""
