"""Languages that write numbers with a comma: made where the system has them not, in a folder of the test's own."""
import os
import pathlib
import shutil
import subprocess

COMMAS = ("de_DE", "fr_FR")


def with_language(name, folder):
    """The environment in which programs speak a language; None where it cannot be made."""
    path = pathlib.Path(folder, f"{name}.utf8")
    if not path.exists():
        if shutil.which("localedef") is None:
            return None
        subprocess.run(["localedef", "--no-archive", "-i", name, "-f", "UTF-8", str(path)], capture_output=True)
    if not (path / "LC_NUMERIC").exists():
        return None
    return dict(os.environ, LC_ALL=f"{name}.UTF-8", LOCPATH=str(folder))
