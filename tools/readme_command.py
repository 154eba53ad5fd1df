"""Print a command of the README, so that what is checked is what is written there.

Usage: ``python3 tools/readme_command.py test``
"""

import re
import sys
from pathlib import Path

README = Path(__file__).parent.parent / "README.md"


def command(name: str) -> str:
    """The shell line under ``<!-- command: name -->``."""
    found = re.search(rf"<!-- command: {re.escape(name)} -->\n```sh\n(.+?)\n```", README.read_text(encoding="utf-8"))
    if found is None:
        raise SystemExit(f"README.md has no command named {name!r}")
    return found[1]


if __name__ == "__main__":
    print(command(sys.argv[1]))
