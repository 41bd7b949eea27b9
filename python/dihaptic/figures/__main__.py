"""`python3 -m dihaptic.figures`: see drawing.main()."""

import sys

from .drawing import main

sys.exit(main(sys.argv[1:]))
