# SPDX-License-Identifier: BSD-3-Clause
"""The type stubs say what the package has: every module, class, attribute and parameter, and every
keyword that a definition of the library takes. With mypy, programs are checked by them."""
import ast
import importlib
import inspect
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import se3d
from se3d._library import ffi

FOLDER = pathlib.Path(se3d.__file__).parent
ROOT = pathlib.Path(__file__).resolve().parents[2]
MODULES = sorted(path.stem for path in FOLDER.glob("*.py") if path.stem != "__init__")
# What type checkers alone need.
HELPERS = {"Array", "ArrayProperty", "FunctionLike", "Word", "ElementType"}
DEFINITIONS = re.compile(r'"(se3d_(?:\w+_def|contact_settings|model_options))"')


def own(module):
    """Public functions, classes and constants that a module defines."""
    tree = ast.parse((FOLDER / f"{module}.py").read_text())
    names = {node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    names |= {target.id for node in tree.body if isinstance(node, ast.Assign)
              for target in node.targets if isinstance(target, ast.Name)}
    return {name for name in names if not name.startswith("_")}


def members(body):
    """The names of a class of a stub: their definitions, those of setters left out."""
    found = {}
    for node in body:
        if isinstance(node, ast.AnnAssign):
            found[node.target.id] = node
        elif isinstance(node, ast.FunctionDef) and node.name not in found:
            found[node.name] = node
    return found


def parameters(node):
    """Of a function of a stub: (names in their order, names by keyword only, those with a default)."""
    given = node.args
    places = [one.arg for one in given.posonlyargs + given.args]
    words = [one.arg for one in given.kwonlyargs]
    optional = set(places[len(places) - len(given.defaults):])
    optional |= {name for name, value in zip(words, given.kw_defaults) if value is not None}
    return places, words, optional


def keywords(function, known):
    """The keywords of **values: the members of the definition that the function fills."""
    kind = DEFINITIONS.search(inspect.getsource(function))[1]
    found = []
    for name, field in ffi.typeof(kind).fields:
        of = field.type
        is_text = of.kind == "pointer" and of.item.cname == "char"
        if of.kind in ("pointer", "function") and not is_text:
            continue
        if name not in ("struct_size", "reserved", "count", *known) and not name.endswith("_count"):
            found.append(name)
    return found


class Stubs(unittest.TestCase):
    def compare_function(self, where, function, node):
        places, words, optional = parameters(node)
        signature = inspect.signature(function).parameters.values()
        expected = [one.name for one in signature if one.kind == one.POSITIONAL_OR_KEYWORD]
        self.assertEqual(places, expected, where)
        fixed = [one.name for one in signature if one.kind == one.KEYWORD_ONLY]
        defaults = {one.name for one in signature if one.default is not one.empty}
        if any(one.kind == one.VAR_KEYWORD for one in signature):
            more = keywords(function, expected + fixed)
            self.assertGreater(len(more), 0, where)
            self.assertEqual(words, fixed + more, where)
            self.assertEqual(optional, defaults | set(more), where)
        else:
            self.assertEqual((words, optional), (fixed, defaults), where)

    def compare_class(self, where, cls, node):
        stub = members(node.body)
        named = set(getattr(cls, "_fields", ()))
        source = inspect.getsource(cls) if not named else ""
        stored = {name for name in re.findall(r"self\.(\w+)(?:, self\.\w+)* =[^=]", source)}
        stored |= {name for line in re.findall(r"^\s+(self\.\w+(?:, self\.\w+)+) =", source, re.M)
                   for name in re.findall(r"self\.(\w+)", line)}
        stored |= set(vars(cls).get("__slots__", ()))
        shown = {name for name in vars(cls) if not name.startswith("_")} | stored | named
        shown = {name for name in shown if not name.startswith("_")}
        inherited = {name for base in cls.__mro__[1:-1] for name in dir(base)}
        if not named:
            missing = {name for name in shown - set(stub) if name not in inherited}
            self.assertEqual(missing, set(), where)
        for name, entry in stub.items():
            place = f"{where}.{name}"
            if isinstance(entry, ast.AnnAssign):
                self.assertTrue(name in shown, f"{place} is not there")
                continue
            value = inspect.getattr_static(cls, name)
            is_property = any(isinstance(one, ast.Name) and one.id == "property"
                              for one in entry.decorator_list)
            self.assertEqual(isinstance(value, property), is_property, place)
            if is_property:
                setters = [one for one in node.body if isinstance(one, ast.FunctionDef) and
                           one.name == name and one is not entry]
                self.assertEqual(bool(setters), value.fset is not None, place)
            else:
                self.compare_function(place, getattr(value, "__func__", value), entry)

    def test_modules_are_described_whole(self):
        for module in MODULES:
            there = importlib.import_module(f"se3d.{module}")
            tree = ast.parse((FOLDER / f"{module}.pyi").read_text())
            described = {node.name: node for node in tree.body
                         if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
            constants = {target.id for node in tree.body if isinstance(node, (ast.Assign, ast.AnnAssign))
                         for target in (node.targets if isinstance(node, ast.Assign) else [node.target])}
            self.assertEqual((set(described) | constants) - HELPERS, own(module), module)
            for name, node in described.items():
                if name in HELPERS:
                    continue
                what = getattr(there, name)
                if isinstance(node, ast.ClassDef):
                    self.compare_class(f"{module}.{name}", what, node)
                elif not name.startswith("se3d_python_"):  # these are functions of C
                    self.compare_function(f"{module}.{name}", what, node)

    def test_named_tuples_have_their_fields(self):
        count = 0
        for module in MODULES:
            there = importlib.import_module(f"se3d.{module}")
            for node in ast.parse((FOLDER / f"{module}.pyi").read_text()).body:
                fields = getattr(getattr(there, getattr(node, "name", ""), None), "_fields", None)
                if fields:
                    self.assertEqual(tuple(members(node.body)), fields, node.name)
                    count += 1
        self.assertGreaterEqual(count, 9)

    def test_arrays_that_can_be_set_have_setters(self):
        count = 0
        for module in MODULES:
            there = importlib.import_module(f"se3d.{module}")
            for node in ast.parse((FOLDER / f"{module}.pyi").read_text()).body:
                for entry in getattr(node, "body", ()):
                    if isinstance(entry, ast.AnnAssign) and getattr(entry.annotation, "id", "") == "ArrayProperty":
                        value = inspect.getattr_static(getattr(there, node.name), entry.target.id)
                        self.assertIsNotNone(value.fset, f"{node.name}.{entry.target.id}")
                        count += 1
        self.assertGreaterEqual(count, 7)

    @unittest.skipUnless(shutil.which("mypy"), "no mypy (Debian: mypy)")
    def test_programs_are_checked_by_them(self):
        right = """
with se3d.System(gravity=(0, 0, -1)) as system:
    bar = system.body(name="bar", mass=1, inertia=(1, 1, 1), position=(0, 0, 1))
    bar.position = [0, 0, 2]
    pin = system.joint("revolute", system.ground, bar, at=(0, 0, 0), axis=(0, 1, 0))
    system.driver(pin, function=lambda t: (t, 1, 0))
    status: int = se3d.Solver(system, method="radau", tolerance=1e-6).run(1)
    angle: float = pin.angle
    force: float = float(pin.reaction[0][2])
"""
        wrong = ["system.body(mas=1)", "system.joint('revolute', system.ground, 3)", "pin.angel", "bar.position = None",
                 "se3d.Solver(system, tolerance='fine')", "system.energy.heat", "pin.angle = 2.0",
                 "se3d.Model('x.yaml').parameter(3)", "se3d.Batch(system)", "system.tsda(bar, bar, k=(1, 2))"]
        program = "import se3d\n" + right + "".join(f"    {line}\n" for line in wrong)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "program.py"
            path.write_text(program)
            page = re.findall(r"```python\n(.*?)```", (ROOT / "docs/python.md").read_text(), re.S)
            (pathlib.Path(folder) / "page.py").write_text("\n".join(page))
            files = [path, path.with_name("page.py"), *sorted((ROOT / "examples/python").glob("*.py")),
                     *sorted(FOLDER.glob("*.pyi"))]
            done = subprocess.run(
                ["mypy", "--strict-equality", "--disallow-untyped-defs", "--disallow-any-generics", "--no-error-summary",
                 "--cache-dir", os.devnull, "--python-executable", sys.executable, *map(str, files)],
                capture_output=True, text=True, cwd=folder, env=dict(os.environ, MYPYPATH=str(FOLDER.parent)))
            lines = re.findall(r"^(\S+?):(\d+): error: ", done.stdout, re.M)
            first = program.count("\n", 0, program.index(wrong[0])) + 1
            self.assertEqual([(pathlib.Path(name).name, int(line)) for name, line in lines
                              if not name.startswith(str(ROOT / "examples"))],
                             [("program.py", first + k) for k in range(len(wrong))], done.stdout + done.stderr)
            examples = [line for line in done.stdout.splitlines() if line.startswith(str(ROOT / "examples")) and
                        "[no-untyped-def]" not in line]
            self.assertEqual(examples, [], done.stdout)


if __name__ == "__main__":
    unittest.main()
