"""``python -m visviva``: the same as the command ``visviva``."""

import sys

from visviva.cli import main

if __name__ == "__main__":
    sys.exit(main())
