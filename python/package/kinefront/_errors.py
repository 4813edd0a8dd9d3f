"""The exceptions of Kinefront. Their words are those of the program ``kinefront``."""


class Error(Exception):
    """Base class of the exceptions of Kinefront."""


class InputError(Error, ValueError):
    """What was given is wrong; the message says what, where, and what would be right."""


class StudyError(InputError):
    """A study is invalid.

    ``faults`` lists the faults as pairs of the key and of what is wrong with it.
    """

    faults: list[tuple[str, str]] = []


class DesignError(InputError):
    """A design, a pose or a table of designs is invalid."""


class RunError(InputError):
    """A run folder cannot be read, or does not hold what was asked for."""


class FileError(Error, OSError):
    """A file of a run cannot be written."""


class SearchError(Error, RuntimeError):
    """A search failed."""
