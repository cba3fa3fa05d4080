"""Runs trimesh's own ray tests with lodray's class in place of trimesh's two.

run.py CHECKOUT takes a checkout of trimesh, with all its meshes; without one its source package is downloaded, which has but the tests: those that need a file are left out.
"""

import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
TESTS = ["test_ray.py", "test_ray_upstream.py"]


def source(folder: Path) -> Path:
    """The source package of the trimesh that is installed, unpacked."""
    import trimesh

    wanted = ["--no-deps", "--no-binary", "trimesh", f"trimesh=={trimesh.__version__}"]
    subprocess.run([sys.executable, "-m", "pip", "download", "-q", "-d", folder, *wanted], check=True)
    with tarfile.open(next(folder.glob("trimesh-*.tar.gz"))) as archive:
        archive.extractall(folder)
    root = next(path for path in folder.glob("trimesh-*") if path.is_dir())
    shutil.copy(HERE / "generic.py", root / "tests")
    return root


def run(root: Path) -> int:
    tests = [root / "tests" / name for name in TESTS if (root / "tests" / name).is_file()]
    env = os.environ | {"PYTHONPATH": os.pathsep.join([str(HERE), str(root)])}
    command = [sys.executable, "-m", "pytest", "-q", "-rs", "-p", "lodray_in_place", "-p", "no:cacheprovider", *tests]
    return subprocess.run(command, env=env, cwd=root, check=False).returncode


if len(sys.argv) > 1:
    sys.exit(run(Path(sys.argv[1]).resolve()))
with tempfile.TemporaryDirectory() as temporary:
    sys.exit(run(source(Path(temporary))))
