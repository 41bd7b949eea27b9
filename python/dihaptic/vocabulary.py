"""The quantities recorded in each tick: the names, units and meanings in docs/quantities.md."""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from ._facts import facts
from .errors import NotThere

#: Lists whose series are named by their items: a finger, a body or a joint.
NAMED_LISTS = ("fingers", "turns", "bodies", "joints")

_COMPONENTS = {"float64[3]": "xyz", "float64[4] (x, y, z, w)": "wxyz"}


@dataclass(frozen=True)
class Quantity:
    """A quantity of the record, as listed in docs/quantities.md.

    >>> import dihaptic as dh
    >>> dh.quantity("block.position").unit
    'm'
    """

    of: str  #: its list: "fingers", "bodies", "contacts"; "": once per tick
    name: str
    type: str  #: "float64", "float64[3]", "int32", ...
    unit: str  #: in SI; "1": a pure number
    frame: str  #: "W", the world, or "D", the device; "": it has no axes
    meaning: str

    @property
    def components(self) -> str:
        """ "xyz" of a vector, "wxyz" of a quaternion, "" of a number: the columns of its array."""
        return _COMPONENTS.get(self.type, "")

    def columns(self) -> list[str]:
        """Names of the quantity's columns in a table.

        >>> import dihaptic as dh
        >>> dh.quantity("block.position").columns()
        ['position_x', 'position_y', 'position_z']
        """
        return [f"{self.name}_{c}" for c in self.components] if self.components else [self.name]


_ALL = [Quantity(*row) for row in facts()["quantities"]]
_BY_LIST: dict[str, dict[str, Quantity]] = {}
for _quantity in _ALL:
    _BY_LIST.setdefault(_quantity.of, {})[_quantity.name] = _quantity


def of_list(name: str) -> list[Quantity]:
    """The quantities of a list, in order; "" stands for those that occur once per tick."""
    return list(_BY_LIST.get(name, {}).values())


def find(name: str, list_name: str = "") -> Quantity | None:
    """The quantity with that name in a list, or None."""
    return _BY_LIST.get(list_name, {}).get(name)


#: For each list whose items have names: these names, in order.
Items = dict[str, list[str]]


@dataclass(frozen=True)
class Place:
    """The location of a quantity: its list, its item, and its component."""

    of: str  #: the list; "": once per tick
    item: int
    quantity: Quantity
    component: int | None  #: None: all of them


def place_of(name: str, items: Items) -> Place | None:
    """The location for a name such as "grip_force", "thumb.force_sent" or "block.position.z", given the names of the
    items of each list; None if the name does not exist."""
    once = find(name)
    if once is not None:
        return Place("", 0, once, None)
    for list_name, names in items.items():
        for i, item in enumerate(names):
            term, _, component = name.removeprefix(item + ".").partition(".")
            q = find(term, list_name)
            if not name.startswith(item + ".") or q is None:
                continue
            if not component:
                return Place(list_name, i, q, None)
            if len(component) == 1 and component in q.components:
                return Place(list_name, i, q, q.components.index(component))
    return None


def lists() -> list[str]:
    """Names of all lists that are stored as one series each: contacts, targets, loads, ..."""
    return [name for name in _BY_LIST if name and name not in NAMED_LISTS]


def quantity(name: str) -> Quantity:
    """The quantity of a name such as "grip_force", "thumb.force_sent" or "contacts.gap".

    A name after a dot is looked for in all lists. Raises NotThere.

    >>> import dihaptic as dh
    >>> dh.quantity("grip_force").meaning
    'Pinch component of the normal forces, half their sum; NaN for one finger.'
    """
    item, dot, last = name.rpartition(".")
    if not dot:
        found = find(name)
    elif item in _BY_LIST:
        found = find(last, item)
    else:
        found = next((q for q in (find(last, of) for of in NAMED_LISTS) if q is not None), None)
    if found is None:
        raise NotThere(name, "is not a quantity", [q.name for q in _ALL], "quantities() lists them.")
    return found


def quantities() -> pd.DataFrame:
    """All quantities as a table: of, name, type, unit, frame, meaning.

    >>> import dihaptic as dh
    >>> dh.quantities().query("name == 'load_force'").unit.item()
    'N'
    """
    return pd.DataFrame([vars(q) for q in _ALL])
