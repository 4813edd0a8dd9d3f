"""Design of planar parallel manipulators: the model, the search and the run folders of Kinefront.

>>> import kinefront
>>> study = kinefront.Study.paper()
>>> table = study.evaluate("3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056")
>>> round(float(table["mass_kg"][0]), 1)
445.6

Lengths are in metres, masses in kilograms, and angles of poses in radians; the unit of a column is in its name or in
``Table.units``.
"""

from ._errors import DesignError, Error, FileError, InputError, RunError, SearchError, StudyError
from ._kinefront import Design, Progress, Run, Study, Table, __version__

__all__ = [
    "Design",
    "DesignError",
    "Error",
    "FileError",
    "InputError",
    "Progress",
    "Run",
    "RunError",
    "SearchError",
    "Study",
    "StudyError",
    "Table",
    "__version__",
]
