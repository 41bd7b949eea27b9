"""Scenes, rigs and experiments as objects, saved like files written by hand."""

from __future__ import annotations

import contextlib
import copy
import keyword
import os
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, TypeVar, Union

from . import _native
from .errors import Error, NotThere, Problem, error

_YES_OR_NO = {"yes": True, "true": True, "no": False, "false": False}
_NUMBER = re.compile(r"[-+]?(?!0\d)(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
#: Placeholder at the position of a key that is looked for; no file contains it.
_NO_KEY = "__no_key__"


class Part:
    """A part of a file: its attributes are the keys of docs/reference.md, with their units.

    A key that is a Python keyword is accessed as `part["from"]`. `part.known()` lists the keys that are known there,
    if the part is in a Scene, Rig or Experiment, and so does completion.

    >>> import dihaptic as dh
    >>> block = dh.Part(name="block", shape="box", size_mm=[40, 40, 40], mass_g=100)
    >>> block.mass_g *= 2
    >>> block
    Part(name='block', shape='box', size_mm=[40, 40, 40], mass_g=200)
    """

    _keys: dict[str, Any]
    _raw: dict[str, Any]
    _owner: tuple[Part, str] | None

    def __init__(self, **keys: Any) -> None:
        object.__setattr__(self, "_keys", {})
        object.__setattr__(self, "_raw", {})
        object.__setattr__(self, "_owner", None)
        for key, value in keys.items():
            self[key] = value

    def __getitem__(self, key: str) -> Any:
        if key not in self._keys:
            raise NotThere(key, "is not given", list(self._keys), "known() lists the allowed keys.")
        value = self._keys[key]
        for i, item in enumerate(value if isinstance(value, list) else [value]):
            if isinstance(item, Part):
                at = f"{key}[{i}]" if isinstance(value, list) else key
                object.__setattr__(item, "_owner", (self, at))
        return value

    def __setitem__(self, key: str, value: Any) -> None:
        plain = _plain(value)
        if any(part is self for part in _within(plain)):
            raise error("would be within itself", "Give a copy: copy.copy(part).", key=key)
        self._keys[key] = plain

    def __delitem__(self, key: str) -> None:
        self._keys.pop(key, None)

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        try:
            return self[key]
        except NotThere as why:
            raise AttributeError(str(why)) from None

    def __setattr__(self, key: str, value: Any) -> None:
        self[key] = value

    def __delattr__(self, key: str) -> None:
        del self[key]

    def __contains__(self, key: object) -> bool:
        return key in self._keys

    def __iter__(self) -> Iterator[str]:
        return iter(self._keys)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Part) and type(self) is type(other) and self._keys == other._keys

    def __dir__(self) -> list[str]:
        return [*object.__dir__(self), *self._keys, *self.known()]

    def __copy__(self: P) -> P:
        return copy.deepcopy(self)  # a copy must not share its lists with the original

    def __repr__(self) -> str:
        names = {key: key.isidentifier() and not keyword.iskeyword(key) for key in self._keys}
        items = [f"{key}={self._keys[key]!r}" for key, is_name in names.items() if is_name]
        others = {key: self._keys[key] for key, is_name in names.items() if not is_name}
        return f"{type(self).__name__}({', '.join(items + [f'**{others!r}'] * bool(others))})"

    def known(self) -> dict[str, str]:
        """The keys that may be added here, with their meanings; empty for a part that belongs to no
        file.

        >>> import dihaptic as dh
        >>> scene = dh.Scene.load("scenes/block-on-table.yaml")
        >>> scene.bodies[1].known()["torsion_radius_mm"]
        'Radius of the soft contact points: each carries a moment up to friction x radius x normal force.'
        """
        root, _ = self._root_and_path()
        if not isinstance(root, File):
            return {}
        self._keys[_NO_KEY] = 0
        try:
            problems = root._read_anew()
        finally:
            del self._keys[_NO_KEY]
        return next((dict(choices) for *_, key, _, _, choices in problems if key == _NO_KEY), {})

    def _root_and_path(self) -> tuple[Part, str]:
        if self._owner is None:
            return self, ""
        root, path = self._owner[0]._root_and_path()
        return root, f"{path}.{self._owner[1]}".lstrip(".")

    @classmethod
    def _of(cls: type[P], raw: dict[str, Any]) -> P:
        part = cls()
        object.__setattr__(part, "_raw", raw)
        for key, value in raw.items():
            part._keys[key] = _value(value)
        return part

    def _to_raw(self) -> dict[str, Any]:
        """Unchanged values stay exactly as they were written."""
        return {
            key: self._raw[key] if key in self._raw and _value(self._raw[key]) == value else _to_raw(value)
            for key, value in self._keys.items()
        }


P = TypeVar("P", bound=Part)


class File(Part):
    """The base class of scenes, rigs and experiments, which are files."""

    _folder: Path
    _name: str
    #: A key that identifies the kind of file.
    _must_have = ""

    def __init__(self, **keys: Any) -> None:
        super().__init__(**keys)
        object.__setattr__(self, "_folder", Path.cwd())
        object.__setattr__(self, "_name", "")

    @classmethod
    def load(cls: type[F], file: str | Path) -> F:
        """Reads a file or, if none has this name, a file that comes with the program. Raises Error when it is not
        YAML; check() finds all other mistakes.

        >>> import dihaptic as dh
        >>> dh.Scene.load("scenes/block-on-table.yaml").bodies[1].mass_g
        100
        """
        if not Path(file).exists():
            file = _native.kept(str(file)) or file
        raw = _native.read_yaml(str(file))
        if not isinstance(raw, dict):
            raise error("has no keys", "Name a scene, a rig or an experiment.", file=str(file))
        if cls._must_have not in raw:
            what = cls.__name__.lower()
            raise error(f"is not a valid {what}: it has no {cls._must_have}", f"Name a {what}.", file=str(file))
        out = cls._of(raw)
        object.__setattr__(out, "_folder", Path(file).resolve().parent)
        object.__setattr__(out, "_name", Path(file).name)
        return out

    def save(self, file: str | Path) -> Path:
        """Writes the file and, next to it, a scene and a rig given as objects.

        Only comments are lost. The paths of other files are adapted if it is written to another folder. Raises
        OSError when it cannot be written, and Error when load() could not read it again.

        >>> import dihaptic as dh
        >>> scene = dh.Scene.load("scenes/block-on-table.yaml")
        >>> scene.bodies[1].mass_g = 150
        >>> dh.check(scene.save(f"{folder}/heavier.yaml"))
        []
        """
        path = Path(file)
        # all texts are made before any file is touched, and each file is replaced as a whole
        written = self._written(path)
        for name, text in written.items():
            _native.check_yaml(text, str(name))
            if name.is_symlink():
                raise error("is a link, and links are not written through", "Name another file.", file=str(name))
        with tempfile.TemporaryDirectory(prefix=f".{path.name}.", dir=path.parent) as making:
            for name, text in written.items():
                Path(making, name.name).write_text(text, encoding="utf-8")
            for name in written:
                os.replace(Path(making, name.name), name)
        return path

    def _written(self, path: Path) -> dict[Path, str]:
        """The texts of the file and of those of its parts."""
        names = {key: f"{path.stem}.{key}.yaml" for key in self._parts()}
        raw = _moved(self._to_raw(), self._folder, path.resolve().parent)
        out = {path: _native.write_yaml({**raw, **names})}
        for key, part in self._parts().items():
            out |= part._written(path.with_name(names[key]))
        return out

    def check(self) -> list[Problem]:
        """Finds the faults of this object, like `dihaptic check`, with the object's path in place of a line.

        >>> import dihaptic as dh
        >>> scene = dh.Scene.load("scenes/block-on-table.yaml")
        >>> scene.bodies[1].mass_g = -1
        >>> print(scene.check()[0].text())
        Scene.bodies[1]: error: mass_g: must be positive, but is -1. Correct the value, or its unit.
        """
        return problems_of(self)

    def __str__(self) -> str:
        return _native.write_yaml(self._to_raw())

    # Writing to the disk

    def _parts(self) -> dict[str, File]:
        return {key: value for key, value in self._keys.items() if isinstance(value, File)}

    def _is_on_disk(self) -> bool:
        file = self._folder / self._name
        return bool(self._name) and file.is_file() and not self._parts() and type(self).load(file) == self

    @contextlib.contextmanager
    def _on_disk(self) -> Iterator[Path]:
        """The file from which it was read, if it is unchanged; otherwise a temporary one."""
        if self._is_on_disk():
            yield self._folder / self._name
            return
        title = re.sub(r"[^a-z0-9]+", "-", str(self._keys.get("title", "")).lower()).strip("-")[:40]
        with tempfile.TemporaryDirectory(prefix="dihaptic-") as folder:
            file = Path(folder).resolve() / (self._name or f"{title or type(self).__name__.lower()}.yaml")
            self.save(file)
            try:
                yield file
            except Error as why:
                why._take([self._at_object(file, problem) for problem in why.problems])
                raise

    def _read_anew(self) -> list[Any]:
        with tempfile.TemporaryDirectory(prefix="dihaptic-") as folder:
            return _native.check_file(str(self.save(Path(folder).resolve() / "asked.yaml")), "")

    def _at_object(self, file: Path, problem: Problem) -> Problem:
        """The problem, with the path of the object in place of a line of the file."""
        for key, part in self._parts().items():
            if Path(problem.file).name == f"{file.stem}.{key}.yaml":
                inner = part._at_object(Path(problem.file), problem)
                return Problem(inner.severity, f"{type(self).__name__}.{inner.file}", 0, *_rest(inner))
        if Path(problem.file).name != file.name:
            return problem
        here = [path for path, line in _native.lines_of(str(file)) if line == problem.line]
        own = [path.removesuffix(f".{problem.key}") for path in here if path.endswith(f".{problem.key}")]
        path = (own or here or [""])[0]
        name = f"{type(self).__name__}.{path}" if path else type(self).__name__
        return Problem(problem.severity, name.rstrip("."), 0, *_rest(problem))


F = TypeVar("F", bound=File)


class Scene(File):
    """A scene: bodies, joints, fingers (docs/files/scene.md).

    >>> import dihaptic as dh
    >>> scene = dh.Scene(
    ...     title="A cube on a table",
    ...     bodies=[
    ...         dh.Part(name="table", shape="box", size_mm=[400, 300, 50], position_mm=[0, 0, -25], fixed=True),
    ...         dh.Part(name="cube", shape="box", size_mm=[30, 30, 30], mass_g=50, position_mm=[0, 0, 15]),
    ...     ],
    ... )
    >>> scene.check()
    []
    >>> world = dh.World(scene)
    """

    _must_have = "bodies"


class Rig(File):
    """A rig: its devices, their poses, its display (docs/files/rig.md).

    >>> import dihaptic as dh
    >>> dh.Rig.load("rigs/ideal-pair.yaml").check()
    []
    """

    _must_have = "devices"


class Experiment(File):
    """An experiment: a scene, a rig, and trials (docs/files/experiment.md).

    `scene` and `rig` are paths relative to the experiment's folder, or a Scene and a Rig.

    >>> import dihaptic as dh
    >>> lift = dh.Experiment.load("experiments/first-trials.yaml")
    >>> lift.scene = dh.Scene.load("scenes/block-on-table.yaml")
    >>> lift.scene.bodies[1].colour = "#aa3300"
    >>> session = dh.run(lift, out=folder, simulate=True, participant="sim-001", progress=False)
    >>> len(session.trials)
    5
    """

    _must_have = "scene"


Input = Union[str, Path, File]


@contextlib.contextmanager
def on_disk(given: Input) -> Iterator[str]:
    """Path of a file ("" for none), or of a temporary file that contains an object.

    A file that is missing in the working folder is looked for among those kept for all studies, and those that come
    with the program.
    """
    if isinstance(given, File):
        with given._on_disk() as file:
            yield str(file)
        return
    path = Path(given)
    inside = not path.is_absolute() and ".." not in path.parts and path.parts
    kept = _native.kept(str(given)) if inside and not path.exists() else ""
    yield kept if kept and Path(kept).is_file() else str(given)


def problems_of(given: Input, rig: Input = "") -> list[Problem]:
    """The findings of `dihaptic check` in a file or an object."""
    with on_disk(given) as file, on_disk(rig) as rig_file:
        found = [Problem(*row[:6]) for row in _native.check_file(file, rig_file)]
        return [given._at_object(Path(file), p) for p in found] if isinstance(given, File) else found


def _rest(problem: Problem) -> tuple[str, str, str]:
    return problem.key, problem.what, problem.remedy


def _value(raw: Any) -> Any:
    """The value that a text in a file represents."""
    if isinstance(raw, dict):
        return Part._of(raw)
    if isinstance(raw, list):
        return [_value(item) for item in raw]
    if raw in _YES_OR_NO:
        return _YES_OR_NO[raw]
    if isinstance(raw, str) and _NUMBER.fullmatch(raw):
        return int(raw) if raw.lstrip("+-").isdigit() else float(raw)
    return raw if raw is None else str(raw)


def _plain(value: Any) -> Any:
    """Numpy's numbers and arrays as Python's."""
    if isinstance(value, Part) or value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, dict):
        return Part(**value)
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    raise error(f"{value!r} cannot be written to a file", "Give a number, a text, a list, a Part or a dict.")


def _within(value: Any) -> Iterator[Part]:
    """All parts of a value."""
    if isinstance(value, Part):
        yield value
        for inner in value._keys.values():
            yield from _within(inner)
    elif isinstance(value, list):
        for item in value:
            yield from _within(item)


def _to_raw(value: Any) -> Any:
    if isinstance(value, File):
        return ""  # name of its file, once it is known
    if isinstance(value, Part):
        return value._to_raw()
    if isinstance(value, list):
        return [_to_raw(item) for item in value]
    return value


def _moved(raw: Any, old: Path, new: Path) -> Any:
    """A copy in which the paths of other files are relative to another folder."""
    if old == new:
        return raw
    if isinstance(raw, dict):
        return {key: _moved(value, old, new) for key, value in raw.items()}
    if isinstance(raw, list):
        return [_moved(value, old, new) for value in raw]
    if isinstance(raw, str) and "." in raw and len(raw) < 256 and "\n" not in raw and (old / raw).is_file():
        return os.path.relpath(old / raw, new)
    return raw
