"""`python -m crumble dem-run ...` is `dem-run ...`."""

import sys

from crumble._programs import PROGRAMS, start

if len(sys.argv) < 2 or sys.argv[1] not in PROGRAMS:
    sys.exit(f"usage: python -m crumble {{{','.join(PROGRAMS)}}} ARGUMENTS")
start(sys.argv[1], sys.argv[2:])
