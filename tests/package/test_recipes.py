"""Recipes of other package managers: vcpkg.json, conanfile.py and the Dockerfile. None of their tools is run."""

import ast
import json
import re
import unittest

from projects import SOURCE

PACKAGE = SOURCE / "engine/package"
# https://learn.microsoft.com/vcpkg/reference/vcpkg-json
FIELDS = {"$schema", "name", "version", "description", "license", "supports", "dependencies"}


def project_version():
    return re.search(r"^project\(Terrella VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text(), re.MULTILINE)[1]


def bootstrap_packages(name):
    return set(re.search(rf"^{name}=\((.*?)\)", (SOURCE / "bootstrap").read_text(), re.DOTALL | re.MULTILINE)[1].split())


def installed_by(line):
    """The packages of an apt-get install, without options and paths."""
    words = re.search(r"apt-get install (.*?)(?:&&|\n(?! ))", line + "\n", re.DOTALL)[1].replace("\\\n", " ").split()
    return {word for word in words if not word.startswith(("-", "/"))}


class Recipes(unittest.TestCase):
    def test_vcpkg(self):
        manifest = json.loads((PACKAGE / "vcpkg/vcpkg.json").read_text())
        self.assertEqual(set(manifest), FIELDS)
        self.assertEqual(manifest["version"], project_version())
        names = [one if isinstance(one, str) else one["name"] for one in manifest["dependencies"]]
        self.assertEqual(names, sorted(set(names)))
        for name in names:
            self.assertRegex(name, "^[a-z0-9]+(-[a-z0-9]+)*$")
        self.assertTrue({"curl", "glm", "proj", "sqlite3", "erfa"} <= set(names))

    def test_conan(self):
        tree = ast.parse((PACKAGE / "conanfile.py").read_text())
        recipe = next(node for node in tree.body if isinstance(node, ast.ClassDef))
        values = {node.targets[0].id: ast.literal_eval(node.value) for node in recipe.body if isinstance(node, ast.Assign)}
        self.assertEqual((values["name"], values["version"]), ("terrella", project_version()))
        for reference in values["requires"]:
            self.assertRegex(reference, r"^[a-z0-9_-]+/[0-9.]+$")
        methods = {node.name for node in recipe.body if isinstance(node, ast.FunctionDef)}
        self.assertLessEqual({"export_sources", "generate", "build", "package", "package_info"}, methods)

    def test_dockerfile(self):
        """The image is built from the packages that bootstrap builds with, and runs on those that it runs on."""
        stages = (PACKAGE / "Dockerfile").read_text().split("FROM ")[1:]
        self.assertEqual(len(stages), 2)
        build, run = (installed_by(next(part for part in stage.split("RUN ") if "apt-get install" in part)) for stage in stages)
        self.assertEqual(build, {name for name in bootstrap_packages("build_packages") if "python" not in name
                                 and name not in ("pybind11-dev", "help2man")})
        self.assertLessEqual(run, bootstrap_packages("run_packages"))
        ignored = (PACKAGE / "Dockerfile.dockerignore").read_text()
        self.assertIn("build", ignored)


if __name__ == "__main__":
    unittest.main()
