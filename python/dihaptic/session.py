"""Reads a recorded session: its tables, and its quantities, recorded tick by tick."""

from __future__ import annotations

import contextlib
import os
import warnings
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np
import pandas as pd

from . import vocabulary
from ._head import MOST_YAML, Head, most_of_recording, read_head, read_session_info, why_unreadable
from ._nwb import head_of_nwb, open_nwb, reading
from ._remedy import needs_program
from ._seals import faults, gone_tables
from .errors import Error, NotThere, Problem, error
from .tables import read_table, tables_in

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.axes import Axes

    Array = npt.NDArray[Any]


def load(folder: str | Path) -> Session:
    """Opens a session by its folder, or by a file in it. Data are read only on request.

    Raises Error when it is not a session. A session that is still running, or was killed, has no
    session.nwb yet: requesting a quantity raises Error, too.

    >>> import dihaptic as dh
    >>> session = dh.load(lift_session)
    >>> session.fingers, session.bodies
    (['thumb', 'index'], ['table', 'block'])
    """
    return Session(folder)


class Session:
    """A recorded session.

    Tables are pandas' (`trials`, `lifts`, `events`, ...), quantities are numpy arrays by their
    names in docs/quantities.md: `session["grip_force"]` for a quantity of the whole tick,
    `session["block.position"]` or `session["thumb.force_sent"]` of a body, joint or finger,
    `session["block.position.z"]` of one component, `session["contacts"]` of a list. All are in SI
    units; vectors in the world's axes have the columns x, y, z, quaternions w, x, y, z.

    >>> import dihaptic as dh
    >>> session = dh.load(lift_session)
    >>> session["block.position"].shape == (len(session.t), 3)
    True
    >>> round(float(session["load_force"].max()), 1)
    1.2
    """

    def __init__(self, folder: str | Path) -> None:
        path = Path(os.path.abspath(folder))  # stays valid when the program changes its working folder
        self.folder = path.parent if os.path.isfile(path) else path
        file = self.folder / "session.yaml"
        try:
            os.lstat(file)
        except (FileNotFoundError, NotADirectoryError):
            if os.path.lexists(self.folder / "rehearsal.yaml"):
                remedy = "Open it with dihaptic.Rehearsal(folder), or name the folder of one of its people."
                raise error("is a rehearsal, not a session", remedy, file=str(folder)) from None
            remedy = "Name a folder made by dihaptic."
            raise error("is not a session: it has no session.yaml", remedy, file=str(folder)) from None
        except (OSError, ValueError):
            pass  # the next check names the reason
        if why := why_unreadable(file, MOST_YAML):
            remedy = "Name a folder made by dihaptic, and correct its permissions if they are wrong."
            raise error(f"cannot be opened: {why}", remedy, file=str(file))

    def __reduce__(self) -> tuple[Any, ...]:
        return Session, (self.folder,)

    def __repr__(self) -> str:
        return f"<Session {self.folder.name}: {self._info.get('title', '')}, {self._info.get('state', '')}>"

    # Contents

    @cached_property
    def info(self) -> dict[str, Any]:
        """The content of session.yaml: participant, time, inputs, and end. Raises Error when the file is damaged, and
        warns of one that has lost keys, or was changed since the session ended.

        >>> import dihaptic as dh
        >>> dh.load(lift_session).info["state"]
        'complete'
        """
        info = self._info
        self._tell_changes("", stacklevel=4)  # one level of the stack is that of cached_property
        return info

    @cached_property
    def _info(self) -> dict[str, Any]:
        return read_session_info(self.folder)

    @property
    def fingers(self) -> list[str]:
        """Names of the scene's fingers, in order."""
        return self._items["fingers"]

    @property
    def bodies(self) -> list[str]:
        """Names of the scene's bodies, in order."""
        return self._items["bodies"]

    @property
    def joints(self) -> list[str]:
        """Names of the scene's joints, in order."""
        return self._items["joints"]

    @property
    def tick(self) -> float:
        """Time from one tick to the next [s]."""
        return self._head.tick

    @cached_property
    def _head(self) -> Head:
        log = self.folder / "raw.log"
        if os.path.exists(log):
            head = read_head(log)
            self._check_log(head)
            return head
        # raw.log, the largest file, may not have been copied
        with self._reading():
            return head_of_nwb(self._file) or read_head(log)

    def _check_log(self, head: Head) -> None:
        """Raises Error when raw.log belongs to another session. Sessions of earlier versions have no identity."""
        try:
            own = self._info.get("identity", "")
        except Error:  # each access to a table or a quantity warns of this
            return
        if own and head.identity and own != head.identity:
            raise error(
                "belongs to a different session from the session.yaml next to it",
                "Restore this session's own log, or the session.yaml that belongs to the log.",
                file=str(self.folder / "raw.log"),
            )

    # Tables

    @property
    def tables(self) -> list[str]:
        """Names of the tables in the session's folder, without their .csv. Warns of each that has been removed since the
        session ended.

        >>> import dihaptic as dh
        >>> "lifts" in dh.load(lift_session).tables
        True
        """
        for gone in self._gone_tables().values():
            warnings.warn(gone.text(), stacklevel=2)
        return tables_in(self.folder)

    def _gone_tables(self) -> dict[str, Problem]:
        try:
            return gone_tables(self.folder, self._info)
        except Error:  # each access to a table or a quantity warns of this
            return {}

    def table(self, name: str) -> pd.DataFrame:
        """A table by its name, with its units in `attrs`. Raises NotThere.

        Warns of a table that has been shortened, edited or replaced since the session ended.

        >>> import dihaptic as dh
        >>> dh.load(lift_session).table("lifts").lift.item()
        'complete'
        """
        tables = tables_in(self.folder)
        if name not in tables:
            if gone := self._gone_tables().get(name):
                raise NotThere(name, gone.what, [], gone.remedy)
            raise NotThere(name, "is not a table of this session", tables, "Session.tables lists them.")
        file = f"{name}.csv"
        self._tell_changes(file)
        return read_table(self.folder / file)

    def _tell_changes(self, file: str, stacklevel: int = 3) -> None:
        """Warns if session.yaml or a file has changed since the session ended, or if this cannot be known."""
        try:
            found = faults(self.folder, self._info, file)
        except Error as why:
            found = [f"whether {file or 'session.yaml'} has changed since the session ended is not known: {why}"]
        for what in found:
            warnings.warn(what, stacklevel=stacklevel)

    @cached_property
    def trials(self) -> pd.DataFrame:
        """A row for each attempt at a trial."""
        return self.table("trials")

    @cached_property
    def phases(self) -> pd.DataFrame:
        """A row for each phase of a trial."""
        return self.table("phases")

    @cached_property
    def events(self) -> pd.DataFrame:
        """A row for each moment: touches, lift-offs, messages, settings that changed."""
        return self.table("events")

    @cached_property
    def episodes(self) -> pd.DataFrame:
        """A row for each hold, slide and flight of the object."""
        return self.table("episodes")

    @cached_property
    def lifts(self) -> pd.DataFrame:
        """A row for each attempt with an object and two fingers."""
        return self.table("lifts")

    # Quantities

    @cached_property
    def t(self) -> Array:
        """Times of all ticks, since activation [s]: one for each row of a quantity of the whole tick."""
        with self._reading():
            times = self._times(self._series("sequence"))
            if times.ndim != 1 or not (times[1:] > times[:-1]).all():
                raise ValueError("its times do not increase")
            return times

    def __getitem__(self, name: str) -> Any:
        """A quantity as a numpy array, or a list such as "contacts" as a pandas table.

        It is read from the disk at each request, so keep the result. Raises NotThere.
        """
        if name in vocabulary.lists():
            with self._reading():
                return self._list(name)
        series, component = self._find(name)
        with self._reading():
            data = self._series(series)["data"]
            ticks, components = len(self._series("sequence")["data"]), self._place_of(name).quantity.components
            if data.shape != ((ticks, len(components)) if components else (ticks,)):
                raise ValueError(f"{series} has the shape {data.shape} in a session of {ticks} ticks")
            values: Array = data[...] if component is None else data[:, component]
        return values

    def exact(self, name: str) -> Array:
        """A quantity with all its bits, from raw.log: session.nwb stores non-integers in 32 bits, 7 digits. Reads the
        whole log, in about two seconds for a quarter of an hour, and requires the whole package. Raises NotThere, or
        Error if the log is shorter than session.nwb.

        >>> import dihaptic as dh
        >>> session = dh.load(lift_session)
        >>> bool((session.exact("grip_force").astype("f4") == session["grip_force"]).all())
        True
        """
        try:
            from . import _native
        except ImportError as missing:
            raise ImportError(needs_program("Session.exact", missing)) from None

        place = self._place_of(name)
        log = self.folder / "raw.log"
        if why := why_unreadable(log, most_of_recording(len(self.t))):
            raise error(f"cannot be read: {why}", "Copy it from the recording computer.", file=str(log))
        values = _native.log_values(str(log), place.of, place.item, place.quantity.name)
        out = np.array(values)
        if len(out) != len(self.t):
            raise error(
                f"raw.log has {len(out)} ticks, session.nwb {len(self.t)}",
                "Rebuild session.nwb: dihaptic.recover().",
                file=str(self.folder),
            )
        return out if place.component is None else out[:, place.component]

    def __contains__(self, name: object) -> bool:
        if not isinstance(name, str):
            return False
        try:
            if name not in vocabulary.lists():
                self._find(name)
        except NotThere:
            return False
        return True

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def keys(self) -> list[str]:
        """Names of all recorded quantities, lists included.

        >>> import dihaptic as dh
        >>> [name for name in dh.load(lift_session).keys() if name.startswith("block.")][:2]
        ['block.position', 'block.orientation']
        """
        once = [q.name for q in vocabulary.of_list("") if self._has(q.name)]
        of_items = [
            f"{item}.{q.name}"
            for list_name, items in self._items.items()
            for item in items
            for q in vocabulary.of_list(list_name)
            if self._has(f"{item}_{q.name}")
        ]
        return once + of_items + [name for name in vocabulary.lists() if self._has(_group_of(name))]

    @property
    def quantities(self) -> pd.DataFrame:
        """A table of all recorded quantities: name, unit, frame, columns, meaning.

        >>> import dihaptic as dh
        >>> dh.load(lift_session).quantities.loc["block.position", "unit"]
        'm'
        """
        rows = []
        for name in self.keys():
            if name in vocabulary.lists():
                rows.append((name, "", "", "table", ""))
                continue
            q = vocabulary.quantity(name)
            rows.append((name, q.unit, q.frame, q.components, q.meaning))
        return pd.DataFrame(rows, columns=["name", "unit", "frame", "columns", "meaning"]).set_index("name")

    def unit(self, name: str) -> str:
        """The unit of a quantity; "1": a pure number. Raises NotThere.

        >>> import dihaptic as dh
        >>> dh.load(lift_session).unit("thumb.force_sent")
        'N'
        """
        self._find(name)
        return self._place_of(name).quantity.unit

    def between(self, begin: float, end: float) -> slice:
        """The ticks from `begin` until just before `end` [s], as a slice for the session's arrays.

        Raises Error when either is not a number, such as the time of something that did not happen.

        >>> import dihaptic as dh
        >>> session = dh.load(lift_session)
        >>> len(session["grip_force"][session.between(1.0, 1.5)])
        500
        """
        if np.isnan(begin) or np.isnan(end):
            raise error(f"from {begin} to {end} s is not an interval", "Leave out what did not happen.", key="between")
        half = self.tick / 2
        return slice(*(int(i) for i in np.searchsorted(self.t, [begin - half, end - half])))

    # Pictures

    def plot(self, *names: str, **options: Any) -> Axes:
        """Draws quantities against time; see `dihaptic.charts.plot` for its options.

        >>> import dihaptic as dh
        >>> axes = dh.load(lift_session).plot("grip_force", "load_force", align="lift_off")
        >>> axes.get_xlabel()
        'time from lift-off [s]'
        """
        from .charts import plot

        return plot(self, *names, **options)

    # The file

    @cached_property
    def _file(self) -> h5py.File:
        opened = open_nwb(self.folder)
        self._tell_changes("session.nwb")
        return opened

    @contextlib.contextmanager
    def _reading(self) -> Iterator[None]:
        """Raises Error when what is read from session.nwb in this context is damaged. Closes the file then, since HDF5 would show
        the same content again as long as it is open, even if it has been restored from a backup."""
        try:
            with reading(self.folder):
                yield
        except Error:
            if "_file" in self.__dict__:
                self.__dict__.pop("_file").close()
            raise

    @property
    def _items(self) -> vocabulary.Items:
        return self._head.items

    def _has(self, series: str) -> bool:
        with self._reading():
            return f"acquisition/{series}" in self._file

    def _series(self, name: str) -> Any:
        return self._file[f"acquisition/{name}"]

    def _times(self, series: Any) -> Array:
        if "timestamps" in series:
            stamps: Array = series["timestamps"][...]
            return stamps
        # no tick is missing
        return np.arange(len(series["data"])) * self.tick

    def _place_of(self, name: str) -> vocabulary.Place:
        if name in vocabulary.lists():
            raise error("is a list, not a quantity", f'Its columns are session["{name}"].', key=name)
        # the fingers and bodies matter only for other names
        place = vocabulary.place_of(name, {} if vocabulary.find(name) else self._items)
        if place is None:
            for table in tables_in(self.folder):
                if table.replace("-", "_") == name.replace("-", "_"):
                    raise NotThere(name, "is a table of this session, not a quantity", [], f'Session.table("{table}") reads it.')
            raise NotThere(name, "is not recorded", self.keys(), "Session.quantities lists them.")
        return place

    def _find(self, name: str) -> tuple[str, int | None]:
        """The series for a name, and the column of its component, if it names one."""
        place = self._place_of(name)
        term = place.quantity.name
        series = f"{self._items[place.of][place.item]}_{term}" if place.of else term
        if not self._has(series):
            raise NotThere(name, "is not recorded", self.keys(), "Session.quantities lists them.")
        return series, place.component

    def _list(self, name: str) -> pd.DataFrame:
        columns = [c for q in vocabulary.of_list(name) for c in q.columns()]
        group = _group_of(name)
        if not self._has(group):
            return pd.DataFrame(columns=["time", *columns])
        series = self._series(group)
        if "colnames" in series.attrs:
            return pd.DataFrame({column: series[column][...] for column in series.attrs["colnames"]})
        # versions before 0.3 wrote a series
        rows = series["data"][...].reshape(len(series["data"]), -1)
        table = pd.DataFrame(rows, columns=columns[: rows.shape[1]])
        table.insert(0, "time", self._times(series))
        return table


def _group_of(list_name: str) -> str:
    """The table of a list in session.nwb."""
    return list_name if list_name == "contacts" else f"task_{list_name}"
