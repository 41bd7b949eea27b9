"""JSON Schemas of files, and `dihaptic check`: what a schema refuses, the program refuses too, and of what is typed wrongly
a schema refuses what a schema can know. Files with mistakes are made from those that are shipped.

Usage: schemas_test.py PROGRAM, from the project's folder.
"""
import collections
import copy
import json
import pathlib
import random
import re
import shutil
import sys
import tempfile
import unittest
from functools import partial

sys.path.append("test")
import needs  # noqa: E402
import soak  # noqa: E402

needs.module("jsonschema", "python3-jsonschema")
import jsonschema  # noqa: E402
import yaml  # noqa: E402

from broken_experiments_test import GOOD, SCENE
from program import dihaptic

sys.path.append("docs/manual/make")
from pages import MANUAL, blocks

FOLDERS = {"scene": "scenes", "rig": "rigs", "experiment": "experiments", "population": "populations", "study": "studies"}


class Yaml12(yaml.SafeLoader):
    """YAML 1.2, as editors read it: yes and no are words."""
    yaml_implicit_resolvers = {}

    def number(self, node):
        return float(node.value) if re.search("[.eE]", node.value) else int(node.value)


for kind, pattern in [("bool", "true|True|TRUE|false|False|FALSE"), ("null", "~|null|Null|NULL|"),
                      ("number", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")]:
    Yaml12.add_implicit_resolver(f"tag:yaml.org,2002:{kind}", re.compile(f"({pattern})$"), None)
Yaml12.add_constructor("tag:yaml.org,2002:number", Yaml12.number)


class Schema:
    def __init__(self, kind):
        self.whole = json.loads(dihaptic("schema", kind).stdout)
        self.validator = jsonschema.Draft7Validator(self.whole)

    def problems(self, value):
        return [f"{'.'.join(map(str, error.absolute_path))}: {error.message[:200]}" for error in self.validator.iter_errors(value)]

    def fits(self, value, schema):
        return self.validator.evolve(schema=schema).is_valid(value)

    def refined(self, value, schema):
        """The schema of this value, with the keys of its kind; the alternative that it is."""
        if "$ref" in schema:
            schema = self.whole["definitions"][schema["$ref"].split("/")[-1]]
        for one in schema.get("anyOf", []):
            if "type" in one and isinstance(value, list) or "$ref" in one and isinstance(value, dict):
                return self.refined(value, one)
        out = {**schema, "properties": dict(schema.get("properties", {})), "groups": [[key] for key in schema.get("required", [])]}
        for part in schema.get("allOf", []):
            if "anyOf" in part:
                out["groups"].append([one["required"][0] for one in part["anyOf"]])
                continue
            kind = part.get("then" if self.fits(value, part["if"]) else "else")
            if kind:
                inner = self.refined(value, kind)
                out["properties"].update({key: of for key, of in inner["properties"].items() if of is not True})
                out["groups"] += inner["groups"]
        return out

    def walk(self, value, schema=None, path=()):
        """Each value below this one, with its path and its schema."""
        schema = self.refined(value, self.whole if schema is None else schema)
        yield path, value, schema
        if isinstance(value, dict):
            for key, inner in value.items():
                if key in schema["properties"]:
                    yield from self.walk(inner, schema["properties"][key], path + (key,))
        elif isinstance(value, list) and "items" in schema:
            for i, inner in enumerate(value):
                yield from self.walk(inner, schema["items"], path + (i,))


def at(value, path):
    for step in path:
        value = value[step]
    return value


def changed(root, path, change):
    """A copy in which `change(parent, key)` was done."""
    out = {"": copy.deepcopy(root)}
    change(at(out, ("",) + path[:-1]) if path else out, path[-1] if path else "")
    return out[""]


def replaced(root, path, value):
    return changed(root, path, lambda parent, key: parent.__setitem__(key, value))


def renamed(root, path, new, convert=lambda value: value):
    def rename(parent, key):
        entries = [(new, convert(value)) if name == key else (name, value) for name, value in parent.items()]
        parent.clear()
        parent.update(entries)
    return changed(root, path, rename)


def stem(key):
    return re.sub(r"_[A-Za-z0-9]+$", "", key)


def mistakes(schema, root):
    """(kind of mistake, what makes the file with it), of kinds that a schema can know."""
    for path, value, of in schema.walk(root):
        kinds = of.get("type", [])
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if isinstance(value, dict) and of["properties"]:
            yield "unknown key", partial(changed, root, path, lambda parent, key: parent[key].update(not_a_key=1))
            yield "not a mapping", partial(replaced, root, path, "word")
            for names in of["groups"]:
                for name in names:
                    if name in value:
                        yield "missing key", partial(changed, root, path, lambda parent, key, name=name: parent[key].pop(name))
            for key in value:
                if len([name for name in of["properties"] if stem(name) == stem(key)]) > 1 and key != stem(key):
                    yield "wrong unit", partial(renamed, root, path + (key,), stem(key) + "_furlongs")
        if isinstance(value, list):
            yield "not a list", partial(replaced, root, path, {"x": 1})
        if not isinstance(value, (list, dict)):
            yield "not a value", partial(replaced, root, path, {"x": 1})
        if "enum" in of:
            yield "unknown word", partial(replaced, root, path, "sideways")
        if is_number and "pattern" in of:
            yield "not a number", partial(replaced, root, path, "heavy")
        if is_number and "maximum" in of:
            yield "too large", partial(replaced, root, path, 2 * abs(of["maximum"]) + 1)
        if is_number and "minimum" in of:
            yield "too small", partial(replaced, root, path, of["minimum"] - abs(of["minimum"]) - 1)
        if is_number and "integer" in kinds:
            yield "not whole", partial(replaced, root, path, value + 0.5)


OTHER_UNIT = {"mm": ("cm", 0.1), "deg": ("rad", 0.017453292519943295), "g": ("kg", 0.001), "s": ("ms", 1000), "N": ("mN", 1000)}
ANY = [0, -1, 1.5, 1e9, "", "word", "5", "1e3", "+.5", "yes", "true", True, False, None, [], {}, [1, 2, 3], [[1]], {"a": 1}]


def other_ways(schema, root):
    """(what is done, what makes the file that says the same in another way)."""
    def are_numbers(value):
        return value and all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in value)
    for path, value, of in schema.walk(root):
        if "pattern" in of and are_numbers([value]):
            yield "quotes", partial(replaced, root, path, str(value))
            yield "fraction", partial(replaced, root, path, float(value))
        for key, inner in value.items() if isinstance(value, dict) else []:
            unit, factor = OTHER_UNIT.get(key[len(stem(key)) + 1:], ("", 1))
            other = f"{stem(key)}_{unit}"
            if other in of["properties"] and are_numbers([inner]):
                yield "unit", partial(renamed, root, path + (key,), other, lambda old, factor=factor: old * factor)
            if other in of["properties"] and isinstance(inner, list) and are_numbers(inner):
                yield "unit of a list", partial(renamed, root, path + (key,), other, lambda old, factor=factor: [number * factor for number in old])


def nonsense(schema, root, chance):
    """A file in which one value is another one, or gone, or a key is there that another mapping has."""
    places = list(schema.walk(root))
    path, value, of = chance.choice(places[1:])
    kind = chance.randrange(4)
    if kind == 0:
        return changed(root, path, lambda parent, key: parent.pop(key))
    if kind == 1 and isinstance(value, dict) and of["properties"]:
        key = chance.choice(list(of["properties"]))
        return changed(root, path, lambda parent, own: parent[own].__setitem__(key, chance.choice(ANY)))
    if kind == 2:
        return replaced(root, path, copy.deepcopy(chance.choice(places)[1]))
    return replaced(root, path, chance.choice(ANY))


class Schemas(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.schemas = {kind: Schema(kind) for kind in FOLDERS}
        cls.files = {kind: {path: yaml.load(path.read_text(), Yaml12) for path in sorted(pathlib.Path(folder).glob("*.yaml"))}
                     for kind, folder in FOLDERS.items()}
        # the files that a file names are copied along with it
        cls.folder = tempfile.TemporaryDirectory()
        for name in [*FOLDERS.values(), "meshes", "textures", "movements"]:
            shutil.copytree(name, pathlib.Path(cls.folder.name, name))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def usable(self, kind, roots):
        """What `dihaptic check` says of each: whether it is usable, and why it is not. JSON is YAML."""
        paths = []
        for i, root in enumerate(roots):
            paths.append(pathlib.Path(self.folder.name, FOLDERS[kind], f"made-{i}.yaml"))
            paths[-1].write_text(json.dumps(root))
        said = dihaptic("check", *map(str, paths)).stdout
        for path in paths:
            path.unlink()
        return [f"{path}: not usable" not in said and f"{path}: " in said for path in paths]

    def test_are_draft_7_and_describe_each_key(self):
        for kind, schema in self.schemas.items():
            jsonschema.Draft7Validator.check_schema(schema.whole)
            self.assertEqual(schema.whole["$schema"], "http://json-schema.org/draft-07/schema#")
            for name, definition in [(kind, schema.whole), *schema.whole["definitions"].items()]:
                for key, of in definition.get("properties", {}).items():
                    self.assertRegex(of["description"], r"^\S.*\.$", f"{name}.{key}")

    def test_shipped_files_are_valid(self):
        for kind, files in self.files.items():
            self.assertGreater(len(files), 1)
            for path, root in files.items():
                self.assertEqual(self.schemas[kind].problems(root), [], path)

    def test_refuse_nothing_that_the_program_accepts(self):
        texts = {str(path): path.read_text(errors="replace") for folder in ("src", "app", "test", "packaging")
                 for path in pathlib.Path(folder).rglob("*.yaml")}
        texts["broken_experiments_test.GOOD"] = GOOD
        for page in MANUAL.rglob("*.md"):
            for block in blocks(page.read_text()):
                if block.kind == "yaml":
                    texts[f"{page}:{block.name}"] = texts.get(f"{page}:{block.name}", "") + block.text
        beside = pathlib.Path(self.folder.name, "elsewhere")
        beside.mkdir()
        (beside / "scene.yaml").write_text(SCENE)
        accepted = collections.Counter()
        for i, (name, text) in enumerate(texts.items()):
            path = beside / f"{i}.yaml"
            path.write_text(text)
            said = re.search(r"^\S+\.yaml: (?:valid )?(scene|rig|experiment|population)\b", dihaptic("check", str(path)).stdout, re.M)
            if said:
                accepted[said[1]] += 1
                self.assertEqual(self.schemas[said[1]].problems(yaml.load(text, Yaml12)), [], name)
        self.assertGreaterEqual(accepted.total(), 20, accepted)

    def test_mistakes_are_refused_by_schema_and_program(self):
        made = collections.Counter()
        chance = random.Random(7)
        for kind, files in self.files.items():
            schema = self.schemas[kind]
            every = collections.defaultdict(list)
            for path, root in files.items():
                for what, make in mistakes(schema, root):
                    every[what].append((path, make))
            some = [(what, path, make()) for what, all_of in every.items()
                    for path, make in chance.sample(all_of, min(soak.of(5, 200), len(all_of)))]
            for (what, path, mistaken), usable in zip(some, self.usable(kind, [root for _, _, root in some])):
                with self.subTest(what=what, file=str(path)):
                    self.assertNotEqual(schema.problems(mistaken), [], mistaken)
                    self.assertFalse(usable, mistaken)
                made[what] += 1
        self.assertGreaterEqual(min(made.values()), soak.of(5, 20), made)
        self.assertEqual(len(made), 11, made)

    def test_what_is_said_in_another_way_is_accepted_by_both(self):
        made = collections.Counter()
        chance = random.Random(8)
        for kind in ("scene", "rig", "experiment"):
            schema = self.schemas[kind]
            every = [(path, *one) for path, root in self.files[kind].items() for one in other_ways(schema, root)]
            some = [(path, what, make()) for path, what, make in chance.sample(every, min(soak.of(40, 1000), len(every)))]
            for (path, what, other), usable in zip(some, self.usable(kind, [root for _, _, root in some])):
                with self.subTest(what=what, file=str(path)):
                    self.assertEqual(schema.problems(other), [])
                    self.assertTrue(usable, other)
                made[what] += 1
        self.assertGreaterEqual(min(made.values()), soak.of(6, 30), made)

    def test_nonsense_that_a_schema_refuses_is_refused_by_the_program(self):
        chance = random.Random(9)
        refused = 0
        for kind, files in self.files.items():
            schema = self.schemas[kind]
            roots = [nonsense(schema, chance.choice(list(files.values())), chance) for _ in range(soak.of(30, 2000))]
            for root, usable in zip(roots, self.usable(kind, roots)):
                problems = schema.problems(root)
                refused += problems != []
                self.assertFalse(problems and usable, f"{problems}\n{json.dumps(root)[:3000]}")
        self.assertGreater(refused, soak.of(60, 4000))


if __name__ == "__main__":
    unittest.main(verbosity=1)
