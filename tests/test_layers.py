"""Imports go down: the layers of the library, and what `import gsp` may load."""

import ast
import importlib
import re
import subprocess
import sys
import tomllib
from functools import cache
from pathlib import Path

import networkx as nx
import pytest

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "gsp"

# A module imports from lower rows, or from its own package as long as there is no cycle.
LAYERS = (
    ("errors", "rounding", "version"),
    ("checks", "installed", "progress"),
    ("arguments", "figures"),
    ("files", "geometry"),
    ("model",),
    ("kernels",),
    ("calibration", "catalogue", "determinant", "statics", "variation"),
    ("indices",),
    ("families", "evaluation"),
    ("limits", "sweeps"),
    ("ranking",),
    ("bridges", "proof"),
    ("workspace",),
    ("planar",),
    ("kinematics",),
    ("exploration",),
    ("published", "plots"),
    ("app",),
    ("cli",),
)
LAYER = {part: number for number, row in enumerate(LAYERS) for part in row}

HEAVY = (
    "matplotlib", "numba", "pinocchio", "mujoco", "dask", "distributed", "sqlalchemy", "rich",
    "typer", "nicegui", "IPython", "networkx",
)  # fmt: skip


def module_name(path):
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_name(path): path for path in sorted(PACKAGE.rglob("*.py"))}


def runtime_nodes(tree):
    """All nodes but those under `if TYPE_CHECKING:`."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
            continue
        yield node
        yield from runtime_nodes(node)


@cache
def imported(path):
    """Modules of the library that a file imports, anywhere in it."""
    return tuple(_imported(path))


def _imported(path):
    for node in runtime_nodes(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports are absolute"
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        for name in names:
            if name.split(".")[0] == "gsp":
                yield name if name in MODULES else name.rpartition(".")[0]


def part(module):
    return module.split(".")[1]


INNER = {m: path for m, path in MODULES.items() if m not in ("gsp", "gsp.__main__")}


@pytest.mark.parametrize("module", INNER)
def test_imports_go_down(module):
    assert part(module) in LAYER, f"{module} is in no layer: list it in {__file__}"
    for target in imported(INNER[module]):
        assert target != "gsp", f"{module} imports the public face of the library"
        same = part(target) == part(module)
        assert same or LAYER[part(target)] < LAYER[part(module)], f"{module} imports {target}"


def test_no_cycles():
    graph = nx.DiGraph(
        (module, target)
        for module, path in INNER.items()
        for target in imported(path)
        if target != module
    )
    assert nx.is_directed_acyclic_graph(graph), nx.find_cycle(graph)


def defined_in(path):
    """Names that a package defines or imports from elsewhere."""
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ImportFrom):
            yield from (a.asname or a.name for a in node.names if node.module != module_name(path))
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name


def test_no_function_has_the_name_of_a_module_beside_it():
    """Else `import gsp.a.b` binds the module or the function, whichever comes last."""
    import gsp

    packages = {name: path for name, path in MODULES.items() if path.name == "__init__.py"}
    names = [f"{package}.{name}" for package, path in packages.items() for name in defined_in(path)]
    assert not {*names, *(f"gsp.{name}" for name in gsp.HOMES)} & set(MODULES)


def test_no_name_is_in_two_layers():
    assert len(LAYER) == sum(map(len, LAYERS))


def test_the_page_on_the_design_lists_the_layers():
    """No layer names a part that is not there, and the page on the design names the same ones."""
    assert set(LAYER) == {part(module) for module in INNER}
    page = (ROOT / "docs" / "design.md").read_text(encoding="utf-8")
    rows = [line.split("|") for line in page.splitlines() if re.match(r"\| \d+ \|", line)]
    assert [set(re.findall("`(.*?)`", row[2])) for row in rows] == list(map(set, LAYERS))


def loaded_by(code):
    script = f"{code}\nimport sys\nprint(*sorted({{m.split('.')[0] for m in sys.modules}}))"
    run = subprocess.run(
        [sys.executable, "-W", "error", "-c", script],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stderr == ""
    return set(run.stdout.split())


def test_the_page_on_the_design_names_the_long_modules_and_the_large_packages():
    """Each module above 300 lines, and each package with more than eight modules, and no other."""
    package = Path(__file__).parent.parent / "gsp"
    page = (package.parent / "docs" / "design.md").read_text(encoding="utf-8")
    _, _, rest = page.partition("Modules have 60–300 lines as a rule.")
    longer, _, rest = rest.partition("Most packages have three to eight modules")
    larger, _, _ = rest.partition("`indices` has")
    lines = {p: len(p.read_text(encoding="utf-8").splitlines()) for p in package.rglob("*.py")}
    long = {str(p.relative_to(package)) for p, n in lines.items() if n > 300}
    assert set(re.findall(r"`([\w/]+\.py)`", longer)) == long
    modules = [p.parent for p in lines if p.name != "__init__.py"]
    many = {str(f.relative_to(package)) for f in modules if modules.count(f) > 8}
    assert set(re.findall(r"`([\w/]+)`", larger)) == many


def functions(tree):
    """Functions of a module and methods of its classes, without those inside functions."""
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node
        elif isinstance(node, ast.ClassDef):
            yield from functions(node)


def code_lines(function):
    """Lines of a function from its first statement after the docstring."""
    texts = [isinstance(getattr(n, "value", None), ast.Constant) for n in function.body[:1]]
    body = function.body[1:] if texts[0] and len(function.body) > 1 else function.body
    return function.end_lineno - body[0].lineno + 1


def test_the_page_on_the_design_names_the_modules_with_long_functions():
    """Each module with a function of more than 60 lines of code, and no other."""
    page = (ROOT / "docs" / "design.md").read_text(encoding="utf-8")
    _, _, rest = page.partition("have more than 60, without signature and docstring. They are in:")
    named, _, _ = rest.partition("A compiled search or loop")
    long = set()
    for name, path in MODULES.items():
        if any(code_lines(f) > 60 for f in functions(trees()[name])):
            long.add(str(path.relative_to(PACKAGE)))
    assert set(re.findall(r"`([\w/]+\.py)`", named)) == long


def test_import_is_light():
    assert not loaded_by("import gsp") & set(HEAVY)


def test_public_names_load_on_first_use():
    import gsp

    assert all(
        getattr(gsp, name) is importlib.import_module(f"gsp.{name}") for name in gsp.PACKAGES
    )
    assert {*gsp.PACKAGES, *gsp.HOMES, "GspError", "__version__"} == set(gsp.__all__)
    assert set(gsp.__all__) <= set(dir(gsp))
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = gsp.nothing


def test_ranking_loads_nothing_for_the_screen():
    code = """
import gsp
d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
gsp.rank([d], gsp.PoseBox.around(d.home, [1] * 6).sample(3, rng=0), ["condition_number"])
"""
    assert not loaded_by(code) & {"matplotlib", "rich", "typer", "mujoco", "dask", "sqlalchemy"}


def test_nothing_else_is_importable():
    """The folders of knowledge hold no code, and the wheel carries one package."""
    for folder in ("catalogue", "indices"):
        assert list((ROOT / folder).rglob("*.py")) == []
    build = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]
    wheel = build["build"]["targets"]["wheel"]
    assert wheel["packages"] == ["gsp"]
    assert all(place.startswith("gsp/") for place in wheel["force-include"].values())


def test_public_names():
    import gsp

    for name in gsp.__all__:
        assert hasattr(gsp, name)
    wanted = {
        "Design", "Ellipsoid", "GspError", "Pose", "PoseBox", "catalogue", "indices", "evaluate",
        "rank", "read_design",
    }  # fmt: skip
    assert wanted <= set(gsp.__all__)


def assigned(tree):
    """Names that a module gives values, and the expressions."""
    for node in tree.body:
        if not isinstance(node, ast.Assign | ast.AnnAssign) or node.value is None:
            continue
        target = node.target if isinstance(node, ast.AnnAssign) else node.targets[0]
        many = isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple)
        pairs = zip(target.elts, node.value.elts, strict=True) if many else [(target, node.value)]
        for name, value in pairs:
            if isinstance(name, ast.Name) and name.id.isupper():
                yield name.id, value


NUMBER = (ast.Constant, ast.BinOp, ast.UnaryOp, ast.operator, ast.unaryop, ast.Attribute, ast.Name)
VECTOR = (ast.Tuple, ast.List, ast.Call, ast.Subscript, ast.Slice)


def is_numeric(value):
    """Numbers, arithmetic of numbers and names, and vectors of numbers, also by numpy."""
    parts = [p for p in ast.walk(value) if not isinstance(p, ast.expr_context)]
    literals = [p.value for p in parts if isinstance(p, ast.Constant)]
    calls = [ast.unparse(p.func) for p in parts if isinstance(p, ast.Call)]
    plain = all(isinstance(p, NUMBER) for p in parts)
    return (
        all(isinstance(p, (*NUMBER, *VECTOR)) for p in parts)
        and not any(isinstance(literal, str) for literal in literals)
        and all(call.startswith("np.") for call in calls)
        and (plain or bool(literals))
    )


@cache
def trees():
    return {name: ast.parse(path.read_text(encoding="utf-8")) for name, path in MODULES.items()}


def test_a_constant_of_one_name_has_one_value():
    """Numbers and vectors, but places in memory, AT_…: each compiled program has its own."""
    values = {}
    for tree in trees().values():
        for name, value in assigned(tree):
            if is_numeric(value) and not name.startswith("AT_"):
                values.setdefault(name, set()).add(ast.unparse(value))
    assert len(values) > 300
    assert {name: sorted(found) for name, found in values.items() if len(found) > 1} == {}


def test_a_list_of_texts_is_written_once():
    """But in the independent check of certificates, which shares no code with what it checks."""
    lists = {}
    for module, tree in trees().items():
        if module.startswith("gsp.proof.verification"):
            continue
        for name, value in assigned(tree):
            texts = [getattr(item, "value", None) for item in getattr(value, "elts", ())]
            if len(texts) > 2 and all(isinstance(text, str) for text in texts):
                lists.setdefault(tuple(texts), []).append(f"{module}.{name}")
    assert len(lists) > 30
    assert [names for names in lists.values() if len(names) > 1] == []
