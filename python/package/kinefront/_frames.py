"""Tables as data frames of other libraries, which are imported on demand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from ._kinefront import Table


def to_numpy(table: Table) -> np.ndarray:
    """Return the table as a structured array of shape (rows,), with a field for each column."""
    columns = {name: np.asarray(table[name]) for name in table.columns}
    kinds = [(name, values.dtype) for name, values in columns.items()]
    array = np.empty(len(table), dtype=kinds)
    for name, values in columns.items():
        array[name] = values
    return array


def to_pandas(table: Table) -> Any:
    """Return the table as a ``pandas.DataFrame``; the numbers are not copied."""
    import pandas

    return pandas.DataFrame({name: table[name] for name in table.columns}, copy=False)


def to_polars(table: Table) -> Any:
    """Return the table as a ``polars.DataFrame``, through the C data interface of Arrow."""
    import polars

    return polars.DataFrame(table)


def to_arrow(table: Table) -> Any:
    """Return the table as a ``pyarrow.Table``, through the C data interface of Arrow."""
    import pyarrow

    return pyarrow.table(table)
