# SPDX-License-Identifier: BSD-3-Clause
"""The recipes of Conan, vcpkg and conda by what their managers ask of them: recipes.py RECIPES SOURCE."""
import importlib.util
import json
import pathlib
import re
import sys
import types

WORK, SOURCE = (pathlib.Path(word) for word in sys.argv[1:3])
calls = []


class Keep:
    """Takes what is said to a generator, a build or a component."""

    def __init__(self, *_):
        self.cache_variables, self.properties = {}, {}
        self.libs, self.requires, self.system_libs = [], [], []

    def set_property(self, name, value):
        self.properties[name] = value

    def generate(self):
        calls.append(dict(self.cache_variables))

    def configure(self):
        calls.append("configure")

    def build(self):
        calls.append("build")

    def install(self):
        calls.append("install")


class Components(dict):
    """A component is there as soon as it is named."""

    def __missing__(self, name):
        self[name] = Keep()
        return self[name]


class ConanFile:
    """What Conan gives a recipe."""

    def __init__(self, system):
        self.needs, self.tools = [], []
        self.settings = types.SimpleNamespace(os=system)
        self.options = types.SimpleNamespace(**self.default_options)
        self.cpp_info = Keep()
        self.cpp_info.components = Components()
        host = {name: types.SimpleNamespace(package_folder=f"/{name}") for name in ("amd", "yaml")}
        self.dependencies = types.SimpleNamespace(host=host)

    def requires(self, what):
        self.needs.append(what)

    def tool_requires(self, what):
        self.tools.append(what)


def load_conanfile():
    parts = {"conan": {"ConanFile": ConanFile}, "conan.tools": {},
             "conan.tools.cmake": {"CMake": Keep, "CMakeToolchain": Keep, "cmake_layout": lambda recipe: None},
             "conan.tools.files": {"get": lambda recipe, url, **more: calls.append((url, more))}}
    for name, content in parts.items():
        sys.modules[name] = types.ModuleType(name)
        vars(sys.modules[name]).update(content)
    spec = importlib.util.spec_from_file_location("conanfile", WORK / "conan/conanfile.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.Se3d


def check_conan():
    cls = load_conanfile()
    for system in ("Linux", "Windows"):
        calls.clear()
        recipe = cls(system)
        assert re.fullmatch(r"\d+\.\d+\.\d+", recipe.version)
        assert set(cls.default_options) == set(cls.options)
        assert all(value in cls.options[name] for name, value in cls.default_options.items())
        for step in ("requirements", "build_requirements", "layout", "source", "generate", "build", "package",
                     "package_info"):
            getattr(recipe, step)()
        (url, more), settings, *steps = calls
        assert url.startswith("https://") and re.fullmatch(r"[0-9a-f]{64}", more["sha256"]) and more["strip_root"]
        assert settings["SE3D_BUILD_TESTS"] is False and settings["CMAKE_PREFIX_PATH"] == "/amd;/yaml"
        assert steps == ["configure", "build", "install"], steps
        needs = recipe.needs + recipe.tools
        assert all(re.fullmatch(r"[a-z-]+/(\d[\w.]*|\[[^\]]+\])", need) for need in needs), needs
        given = {need.split("/")[0] for need in recipe.needs}
        components = recipe.cpp_info.components
        for component in components.values():
            for need in component.requires:
                assert need.split("::")[0] in given | set(components), need
            assert component.properties["cmake_target_name"].startswith("se3d::")
        assert (components["core"].system_libs == ["m"]) == (system == "Linux")


def check_vcpkg():
    """The fields that the documentation of vcpkg.json names."""
    manifest = json.loads((WORK / "vcpkg/se3d/vcpkg.json").read_text())
    known = {"name", "version", "version-semver", "version-date", "version-string", "port-version", "maintainers",
             "summary", "description", "homepage", "documentation", "license", "supports", "dependencies", "features",
             "default-features", "overrides", "builtin-baseline", "vcpkg-configuration"}
    assert set(manifest) <= known, set(manifest) - known
    assert re.fullmatch(r"\d+\.\d+\.\d+", manifest["version"])
    hosts = set()
    for need in [{"name": manifest["name"]}, *manifest["dependencies"]]:
        entry = {"name": need} if isinstance(need, str) else need
        assert set(entry) <= {"name", "default-features", "features", "host", "platform", "version>="}, entry
        assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", entry["name"]), entry
        hosts |= {entry["name"]} if entry.get("host") else set()
    assert hosts == {"vcpkg-cmake", "vcpkg-cmake-config"}


def check_conda():
    """The sections that conda-build knows, and what each is."""
    try:
        import yaml
    except ImportError:
        print("no yaml for Python: the recipe of conda was not read")
        return
    text = (WORK / "conda/meta.yaml").read_text()
    assert re.findall(r"\{\{ (.*?) \}\}", text) == ['compiler("c")']
    recipe = yaml.safe_load(re.sub(r"\{\{.*?\}\}", "compiler", text))
    assert set(recipe) <= {"package", "source", "build", "requirements", "test", "about", "outputs", "app", "extra"}
    assert recipe["package"]["name"] == "se3d" and isinstance(recipe["package"]["version"], str)
    assert re.fullmatch(r"[0-9a-f]{64}", recipe["source"]["sha256"])
    assert set(recipe["requirements"]) <= {"build", "host", "run", "run_constrained"}
    assert "cmake >=3.25" in recipe["requirements"]["build"]
    assert [line.split()[1] for line in recipe["build"]["script"]] == ["-S", "--build", "--install"]
    assert all(isinstance(line, str) for line in recipe["test"]["commands"])
    assert (SOURCE / recipe["about"]["license_file"]).is_file()


check_conan()
check_vcpkg()
check_conda()
